#ifndef ELASTIMATE_ESTIMATORS_MATERIAL_FIT_NEAREST_SYMMETRY_H_
#define ELASTIMATE_ESTIMATORS_MATERIAL_FIT_NEAREST_SYMMETRY_H_

#include <Eigen/Core>
#include <optional>

#include "elastimate/core/scene/scene.h"
#include "elastimate/estimators/interface/free_parameters.h"

namespace elastimate {

/// Returns the scene with materials without symmetry, in its own frame, in
/// place of those whose axis is to be found: their moduli are the same, and no
/// axis has to be guessed to fit them.
Scene WithoutFreeAxes(const Scene& scene);

/// Variables of a scene next to the minimum of its fit, from those of the scene
/// without free axes and their covariance C: the parameters of which
///
///   (theta(p) - theta)^T C^-1 (theta(p) - theta)
///
/// is least for each material whose axis is to be found
/// (FreeAxisLaw::NearestParameters), and those of the others.  The axis is that
/// of the best of a half sphere, as a descent from a guess may not find it.
/// Empty where no stiffness is positive definite.
std::optional<Eigen::VectorXd> NearestVariables(
    const FreeParameters& free, const FreeParameters& without_axes,
    const Eigen::VectorXd& variables, const Eigen::MatrixXd& covariance);

/// W of W^T W = C^-1, where what is less certain than the rest of a covariance
/// by rounding counts as known to that.
Eigen::MatrixXd WeightsOf(const Eigen::MatrixXd& covariance);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_MATERIAL_FIT_NEAREST_SYMMETRY_H_
