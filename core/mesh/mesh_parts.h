#ifndef ELASTIMATE_CORE_MESH_MESH_PARTS_H_
#define ELASTIMATE_CORE_MESH_MESH_PARTS_H_

#include <Eigen/Core>
#include <vector>

#include "elastimate/core/mesh/mesh.h"

namespace elastimate {

/// A mesh whose parts share no nodes: each part has a copy of each of its
/// nodes, so that one pass over the elements gives what each part contributes.
struct MeshParts {
  /// Elements as in the whole mesh; without regions.
  Mesh mesh;
  std::vector<int> node;  ///< In the whole mesh, of each copy, ascending.
  std::vector<int> part;  ///< The part that each copy belongs to.

  /// The rows of the copies, of `whole` (num_dofs x n of the whole mesh).
  Eigen::MatrixXd Gather(const Eigen::MatrixXd& whole) const;
};

/// `part_of_element` has num_elements values, from 0 on.
/// O(num_elements log num_parts).
[[nodiscard]] MeshParts SplitMesh(const Mesh& mesh,
                                  const std::vector<int>& part_of_element);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_MESH_MESH_PARTS_H_
