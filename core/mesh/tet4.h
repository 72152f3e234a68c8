#ifndef ELASTIMATE_CORE_MESH_TET4_H_
#define ELASTIMATE_CORE_MESH_TET4_H_

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>

#include "elastimate/core/mesh/mesh.h"
#include "elastimate/core/mesh/shape_functions.h"

namespace elastimate {

/// Vertex positions of a tetrahedron, 3 x 4.
using TetrahedronNodes = Eigen::Matrix<double, 3, 4>;

inline TetrahedronNodes GatherTetrahedron(const Mesh& mesh,
                                          Eigen::Index element) {
  return GatherMapNodes<ElementKind::kTet4>(mesh, element);
}

/// The linear tetrahedron: constant shape function gradients and the volume.
struct TetrahedronGradients {
  Eigen::Matrix<double, 3, 4> gradient;  ///< grad N_i, 3 x 4 [1 / length].
  double volume;                         ///< V = |det J| / 6 [length^3].

  explicit TetrahedronGradients(const TetrahedronNodes& x) {
    const Eigen::Vector3d e1 = x.col(1) - x.col(0);
    const Eigen::Vector3d e2 = x.col(2) - x.col(0);
    const Eigen::Vector3d e3 = x.col(3) - x.col(0);
    const Eigen::Vector3d c1 = e2.cross(e3);
    const double determinant = e1.dot(c1);
    gradient.col(1) = c1 / determinant;
    gradient.col(2) = e3.cross(e1) / determinant;
    gradient.col(3) = e1.cross(e2) / determinant;
    gradient.col(0) = -(gradient.col(1) + gradient.col(2) + gradient.col(3));
    volume = std::abs(determinant) / 6;
  }
};

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_MESH_TET4_H_
