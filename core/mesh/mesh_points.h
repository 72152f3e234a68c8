#ifndef ELASTIMATE_CORE_MESH_MESH_POINTS_H_
#define ELASTIMATE_CORE_MESH_MESH_POINTS_H_

#include <Eigen/Core>
#include <random>

#include "elastimate/core/mesh/mesh.h"

namespace elastimate {

/// Points of a body, n in all, given by the elements in which they lie.  Points
/// of a mesh of linear elements are the same points of its mesh of quadratic
/// ones.
struct MeshPoints {
  Eigen::VectorXi elements;  ///< n.
  /// Reference coordinates xi as those of ShapeFunctionsAt, dimension x n.
  Eigen::MatrixXd local;

  Eigen::Index Size() const { return elements.size(); }
};

/// Throws std::invalid_argument with one sentence that names the point unless
/// every element exists and every coordinate lies in its reference element, to
/// within 1e-6.  O(n).
void ValidatePoints(const Mesh& mesh, const MeshPoints& points);

/// Returns N_i at each point, num_nodes_of_element x n: the weights of the
/// nodes of its element in a value there.  Precondition: ValidatePoints.  O(n).
[[nodiscard]] Eigen::MatrixXd ShapeFunctionsOf(const Mesh& mesh,
                                               const MeshPoints& points);

/// Returns the values at the points, rows x n, of a field that is given at the
/// nodes, rows x num_nodes.  The field mesh.nodes gives the positions.
/// Precondition: ValidatePoints.  O(rows n).
[[nodiscard]] Eigen::MatrixXd Interpolate(const Mesh& mesh,
                                          const MeshPoints& points,
                                          const Eigen::MatrixXd& field);

/// Draws `count` points evenly over the volume of the mesh.  Precondition: a
/// valid mesh.  O(num_elements + count), more where elements are sheared.
[[nodiscard]] MeshPoints DrawPoints(const Mesh& mesh, Eigen::Index count,
                                    std::mt19937_64& generator);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_MESH_MESH_POINTS_H_
