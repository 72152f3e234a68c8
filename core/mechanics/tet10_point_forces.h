#ifndef ELASTIMATE_CORE_MECHANICS_TET10_POINT_FORCES_H_
#define ELASTIMATE_CORE_MECHANICS_TET10_POINT_FORCES_H_

#include <Eigen/Core>
#include <cstdint>

#include "elastimate/core/large_strain/large_strain_law.h"
#include "elastimate/core/mesh/mesh.h"

namespace elastimate {

/// Some quadratic tetrahedra, whose gradients and forces are computed several
/// at once by vector instructions.
///
/// The gradient of the displacement is linear over an element.  With its values
/// G_v at the vertices v, the barycentric coordinates L_v(q) of the four points
/// q of the integration, and the gradients g_v of L_v, it is
///
///   H_q = sum_v L_v(q) G_v,
///   G_v = 3 u_v g_v^T + sum_{w != v} (4 u_vw - u_w) g_w^T,
///
/// where u_vw is the displacement of the middle of an edge.  The forces of
/// stresses P_q are, likewise,
///
///   S_v = V / 4 sum_q L_v(q) P_q,
///   f_v = (4 S_v - sum_w S_w) g_v,   f_vw = 4 (S_v g_w + S_w g_v).
class Tet10Points {
 public:
  static constexpr int kElements = PointMatrices::kPoints / 4;

  /// Takes `count` elements, at most kElements, of a mesh of quadratic
  /// tetrahedra.
  Tet10Points(const Mesh& mesh, const Eigen::Index* elements, int count);

  /// Some of these points repeat those of the last element.
  static constexpr int NumPoints() { return PointMatrices::kPoints; }

  /// Sets `gradients` to H at point q of element e in the place
  /// kElements q + e.
  void SetGradients(const double* displacement, PointMatrices& gradients) const;

  /// Adds the forces of these stresses to those of the nodes, num_dofs.
  void AddForces(const PointMatrices& stresses, double* forces) const;

 private:
  int count_;
  /// The first degree of freedom of each node of each element.
  alignas(64) std::int64_t row_[10][kElements];
  /// g_1, g_2 and g_3 as columns, entry (i, j) in row i + 3 j, then V / 4.
  alignas(64) double shape_[10][kElements];
};

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_MECHANICS_TET10_POINT_FORCES_H_
