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
  /// The factor by which volumes grow or shrink, below which 95 % of the volume
  /// stays; infinite if that is turned inside out.  In the plane, by which
  /// areas shrink, because the thickness may make up for areas that grow.
  double volume_change = 1;
};

/// Measures displacements after it has smoothed them by polynomials in the
/// position, of degree 4 or, where few points were observed, of a lower degree
/// (affine ones, the lowest, need eight points in space and six in the plane):
///
///   F = 1 + grad u = R U,   s the eigenvalues of U,   angle of R.
///
/// Values that their neighbours contradict are left out before: a gross error
/// of a point counts as no deformation, and a local deformation, of several
/// neighbours, counts.
///
/// Let n be the direction in which the places extend least. Slopes along n are
/// unknown if the places lie in a plane and the body is thin along n. They may
/// also be no larger than three standard deviations of what noise makes of
/// them, as between the faces of a thin strip. In both cases n is taken to stay
/// a unit normal of the deformed plane across it.
///
/// The result is the largest of all load cases, and zero where too few points
/// were observed for a gradient.  Where not all nodes were observed, the
/// observed points stand for the volume.  Precondition: a valid scene with a
/// measurement in each load case.  A large scene is sampled at some thousand
/// points, so that the cost is O(num_elements) at most, and little.
[[nodiscard]] DeformationSize MeasureDeformation(const Scene& scene);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_SCENE_DEFORMATION_SIZE_H_
