#ifndef ELASTIMATE_ESTIMATORS_INTERFACE_KINEMATIC_ERROR_H_
#define ELASTIMATE_ESTIMATORS_INTERFACE_KINEMATIC_ERROR_H_

#include "elastimate/core/scene/scene.h"
#include "elastimate/estimators/interface/estimate.h"

namespace elastimate {

/// One standard deviation of what small-strain elasticity leaves out, for a
/// strain e and a rotation theta [rad]:
///
///   of ln E  .8 e + .54 theta^2,    of nu  .35 e + .8 theta^2.
///
/// The first terms are the spread of the bias over neo-Hookean and St
/// Venant-Kirchhoff materials in tension and compression, of which it is not
/// known which one a specimen is; the second ones are the bias in bending.
struct KinematicError {
  double log_modulus;
  double ratio;
};
KinematicError KinematicErrorOf(const DeformationSize& size);
/// Tells whether a deformation has 1 % of strain or 3 degrees of rotation.
[[nodiscard]] bool IsMentioned(const DeformationSize& size);
/// Tells whether a specimen may have a deformation: strains beyond 100 % are
/// those of rubber, which nearly keeps its volume, or of displacements in
/// another unit of length than the coordinates.
[[nodiscard]] bool IsPossible(const DeformationSize& size);

/// Measures the deformation and, from 1 % of strain or 3 degrees of rotation
/// on, adds what linear kinematics leave out to the covariances, the error
/// budget (ErrorBudget::kinematics) and the findings of an estimate, or turns
/// it into one that is not usable, where that is more than Limits allow for
/// biases (finding `large_deformation`).  Displacements that linear elasticity
/// computed (Origin::kComputed) have no such error, so that a notice only asks
/// whether they did.  Laws of large strains leave nothing out; if their
/// estimate is not usable, a warning tells of deformations that no specimen has
/// (IsPossible).  An estimate that has been through this stays as it is,
/// and so does the joint one of a series, whose frames have.
void JudgeKinematics(const Scene& scene, Estimate& estimate);

/// Warns, where laws of large strains were fitted, of the element that measured
/// displacements of nodes turn inside out most (finding `inverted_elements`).
/// Elements that have a node of which a component was not measured are not
/// looked at.  A pass for each load case.
void JudgeInversion(const Scene& scene, Estimate& estimate);

/// Warns, where laws of large strains were fitted, of the rigid face that
/// turned most of those with free components, from 3 degrees on (finding
/// `rigid_face_turned`).
void JudgeRigidFaces(const Scene& scene, Estimate& estimate);

/// Adds the standard deviation of the thickness to those of moduli, and warns
/// of it, once.
void JudgeThickness(const Scene& scene, Estimate& estimate);

/// Warns of a Poisson's ratio that is negative by more than two standard
/// errors, which displacements of one wrong sign bring about.
void JudgeSignOfPoissonRatio(Estimate& estimate);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_INTERFACE_KINEMATIC_ERROR_H_
