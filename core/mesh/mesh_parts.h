#ifndef ELASTIMATE_CORE_MESH_MESH_PARTS_H_
#define ELASTIMATE_CORE_MESH_MESH_PARTS_H_

#include <Eigen/Core>
#include <vector>

#include "elastimate/core/mesh/mesh.h"

namespace elastimate {

/// A mesh whose parts share no nodes: each part has a copy of each of its
/// nodes, so that one pass over the elements gives what each part contributes.
struct MeshParts {
  /// The elements are those of the whole mesh, without regions.
  Mesh mesh;
  std::vector<int> node;  ///< Each copy's node in the whole mesh, ascending.
  std::vector<int> part;  ///< Each copy's part, from 0 on.

  /// Returns the rows of `whole` (num_dofs x n of the whole mesh) for the
  /// copies.
  Eigen::MatrixXd Gather(const Eigen::MatrixXd& whole) const;
};

/// Splits a mesh by `part_of_element`, num_elements values from 0 on.
/// O(num_elements log num_parts).
[[nodiscard]] MeshParts SplitMesh(const Mesh& mesh,
                                  const std::vector<int>& part_of_element);

/// Splits a mesh into its elements, in their order.
[[nodiscard]] MeshParts SplitIntoElements(const Mesh& mesh);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_MESH_MESH_PARTS_H_
