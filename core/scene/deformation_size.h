#ifndef ELASTIMATE_CORE_SCENE_DEFORMATION_SIZE_H_
#define ELASTIMATE_CORE_SCENE_DEFORMATION_SIZE_H_

#include "elastimate/core/scene/scene.h"

namespace elastimate {

/// How large a measured deformation is, of which linear kinematics keep the
/// first order only.
struct DeformationSize {
  /// Root mean square over the volume of the largest principal strain in
  /// magnitude, |s - 1| of the principal stretches s.
  double strain = 0;
  /// The rotation that 95 % of the volume stays below [rad]: relative to the
  /// supports, or to the mean rotation where a rigid motion is free.
  double rotation = 0;
};

/// Measures displacements that are smoothed by polynomials of degree 4 in the
/// position, of less where few points were observed:
///
///   F = 1 + grad u = R U,   s the eigenvalues of U,   angle of R.
///
/// The largest of all load cases.  Zero where too few points were observed for
/// a gradient.  Where not all nodes were observed, the observed points stand
/// for the volume.  Precondition: a valid scene with a measurement in each load
/// case.  Some thousand points of large scenes are taken, so that it costs
/// O(num_elements) at most, and little.
[[nodiscard]] DeformationSize MeasureDeformation(const Scene& scene);

/// Takes a finite rotation out of the displacements of each load case, where a
/// rigid motion is free: u becomes R^T (x + u - b) + a - x, where R and the
/// means a and b of observed positions before and after minimise the sum of
/// |x + u - b - R (x - a)|^2.  What is left is small enough for the linear
/// rigid motions that fits eliminate.  A rotation below 0.01 rad stays where it
/// is less than the root mean square of what it leaves of u, over that of x -
/// a: it may be the turn of the specimen itself.  A load case in which some
/// components of a point were observed and others were not stays as it is, and
/// so does a scene whose displacements linear elasticity computed.
/// Precondition: a valid scene.  O(num_nodes + num_points).
void RemoveFreeRotation(Scene& scene);

/// Removes it from one load case of the scene, or from another of its kind.
void RemoveFreeRotation(const Scene& scene, LoadCase& load_case);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_SCENE_DEFORMATION_SIZE_H_
