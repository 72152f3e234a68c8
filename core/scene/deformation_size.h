#ifndef ELASTIMATE_CORE_SCENE_DEFORMATION_SIZE_H_
#define ELASTIMATE_CORE_SCENE_DEFORMATION_SIZE_H_

#include "elastimate/core/scene/scene.h"

namespace elastimate {

/// The size of a measured deformation, of which linear kinematics keep only the
/// first order.
struct DeformationSize {
  /// The root mean square over the volume of the largest |s - 1| of the
  /// principal stretches s.
  double strain = 0;
  /// The rotation [rad] below which 95 % of the volume stays.  It is relative
  /// to the supports, or to the mean rotation where a rigid motion is free.
  double rotation = 0;
};

/// Measures displacements after it has smoothed them by polynomials in the
/// position, of degree 4 or, where few points were observed, of a lower degree:
///
///   F = 1 + grad u = R U,   s the eigenvalues of U,   angle of R.
///
/// The result is the largest of all load cases, and zero where too few points
/// were observed for a gradient.  Where not all nodes were observed, the
/// observed points stand for the volume.  Precondition: a valid scene with a
/// measurement in each load case.  A large scene is sampled at some thousand
/// points, so that the cost is O(num_elements) at most, and little.
[[nodiscard]] DeformationSize MeasureDeformation(const Scene& scene);

/// Takes a finite rotation out of the displacements of each load case, where a
/// rigid motion is free: u becomes R^T (x + u - b) + a - x, where R and the
/// means a and b of observed positions before and after minimise the sum of |x
/// + u - b - R (x - a)|^2.  What is left is small enough for the linear rigid
/// motions that fits eliminate.
///
/// A rotation below 0.01 rad may be the turn of the specimen itself, and stays
/// where it is less than the root mean square of the remaining u over that of x
/// - a.  A load case in which some components of a point were observed and
/// others were not stays as it is, and so does a scene whose displacements
/// linear elasticity computed.
/// Precondition: a valid scene.  O(num_nodes + num_points).
void RemoveFreeRotation(Scene& scene);

/// Does this for one load case of the scene, or for another one of the same
/// specimen.
void RemoveFreeRotation(const Scene& scene, LoadCase& load_case);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_SCENE_DEFORMATION_SIZE_H_
