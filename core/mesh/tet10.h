#ifndef ELASTIMATE_CORE_MESH_TET10_H_
#define ELASTIMATE_CORE_MESH_TET10_H_

#include <Eigen/Core>
#include <array>

#include "elastimate/core/mesh/tet4.h"

namespace elastimate {

// The quadratic tetrahedron with straight edges, nodes in the order of VTK: the
// four vertices, then the middle of each edge.  In barycentric coordinates
// lambda, whose gradients g are constant,
//
//   N_a  = lambda_a (2 lambda_a - 1),   grad N_a  = (4 lambda_a - 1) g_a,
//   N_ab = 4 lambda_a lambda_b,         grad N_ab = 4 (lambda_a g_b
//                                                     + lambda_b g_a).

/// The local vertices on either side of local node 4 + i.
constexpr int kTetrahedronEdges[6][2] = {{0, 1}, {1, 2}, {2, 0},
                                         {0, 3}, {1, 3}, {2, 3}};

/// The local node in the middle of the edge between two local vertices.
constexpr int kMidEdgeNodes[4][4] = {
    {0, 4, 6, 7}, {4, 1, 5, 8}, {6, 5, 2, 9}, {7, 8, 9, 3}};

/// The displacement gradient at the vertices; it is linear in between.
struct QuadraticDisplacementGradient {
  std::array<Eigen::Matrix3d, 4> at_vertex;
  Eigen::Matrix3d mean;

  /// `u` = displacements of the nodes, `g` = gradients of lambda, 3 x 4.
  ///
  /// With h_ab = u_ab - (u_a + u_b) / 2 it is
  /// sum_b u_b g_b^T + 4 sum_b h_ab g_b^T at vertex a.
  QuadraticDisplacementGradient(const Eigen::Matrix<double, 3, 10>& u,
                                const Eigen::Matrix<double, 3, 4>& g) {
    Eigen::Matrix<double, 3, 6> h;
    for (int i = 0; i < 6; ++i) {
      h.col(i) = u.col(4 + i) - 0.5 * (u.col(kTetrahedronEdges[i][0]) +
                                       u.col(kTetrahedronEdges[i][1]));
    }
    // Differences, so that equal displacements have no gradient.
    Eigen::Matrix3d linear = (u.col(1) - u.col(0)) * g.col(1).transpose();
    linear += (u.col(2) - u.col(0)) * g.col(2).transpose();
    linear += (u.col(3) - u.col(0)) * g.col(3).transpose();
    mean = linear;
    for (int a = 0; a < 4; ++a) {
      Eigen::Matrix3d bent = Eigen::Matrix3d::Zero();
      for (int b = 0; b < 4; ++b) {
        if (b != a) {
          bent += h.col(kMidEdgeNodes[a][b] - 4) * g.col(b).transpose();
        }
      }
      at_vertex[a] = linear + 4 * bent;
      mean += bent;
    }
  }
};

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_MESH_TET10_H_
