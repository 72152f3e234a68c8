#ifndef ELASTIMATE_ESTIMATORS_MATERIAL_FIT_MATERIAL_FIT_H_
#define ELASTIMATE_ESTIMATORS_MATERIAL_FIT_MATERIAL_FIT_H_

#include <Eigen/Core>
#include <memory>
#include <optional>

#include "elastimate/core/scene/scene.h"
#include "elastimate/estimators/interface/estimate.h"
#include "elastimate/estimators/interface/estimator.h"
#include "elastimate/estimators/material_fit/space_fit.h"

namespace elastimate {

/// The parameters p of any materials by a maximum likelihood fit of the
/// observed displacements, by Ceres within bounds,
///
///   min ||u(theta(p)) - q||^2,   du / d theta_k = -K^-1 f_k(u),
///
/// from typical values at the scale of the data, and from virtual-fields where
/// it takes the scene; the better minimum is kept.  Outliers are left out and
/// the others fitted again, until they are those of the fit without them
/// (OutlierSearch); covariance as by DescribeMinimum.  Of parameters on bounds,
/// the covariance is that without bounds.  Where nu of one isotropic
/// material is not determined, FindShearModulus may look for the shear modulus.
///
/// Where an axis is to be found, descents start from several (StartsOverAxes).
/// The estimate is not usable where another axis explains the data nearly as
/// well as the best one.
///
/// Where supports or the whole specimen moved by unknown amounts, these are
/// fitted with the parameters (MotionElimination), and resultants count by
/// their errors beside the noise.
///
/// Preconditions are those of Estimator::Run; the supports hold the specimen,
/// and for Descent::kReduced no motions are unknown.  Cost of Descent::kFull: a
/// factorisation at each step, 5 to 8 from each start, and a solve for each
/// load case and parameter.
Estimate FitMaterials(const Scene& scene, const EstimatorOptions& options,
                      Descent descent);

/// Fits as FitMaterials does, from these variables on where there are some.
MaterialFit FitMaterialsFrom(const std::optional<Eigen::VectorXd>& start,
                             const Scene& scene,
                             const EstimatorOptions& options, Descent descent);

/// FitMaterials for one measurement of a scene after another.  Where the
/// minimum is certified and the elements are exact, the reduced model is kept,
/// so that a further measurement of the same nodes costs no factorisation.
/// Elsewhere each fit starts where the last usable one ended; where that leads
/// to none, as FitMaterials does.  `options` must outlive it.
std::unique_ptr<Preparation> PrepareMaterialFit(const Scene& scene,
                                                const EstimatorOptions& options,
                                                Descent descent);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_MATERIAL_FIT_MATERIAL_FIT_H_
