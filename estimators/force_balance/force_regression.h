#ifndef ELASTIMATE_ESTIMATORS_FORCE_BALANCE_FORCE_REGRESSION_H_
#define ELASTIMATE_ESTIMATORS_FORCE_BALANCE_FORCE_REGRESSION_H_

#include <Eigen/Core>
#include <memory>
#include <optional>

#include "elastimate/core/scene/scene.h"
#include "elastimate/estimators/force_balance/force_residual.h"
#include "elastimate/estimators/interface/estimate.h"
#include "elastimate/estimators/interface/estimator.h"
#include "elastimate/estimators/interface/free_parameters.h"

namespace elastimate {

/// The parameters x of any materials that leave the least force residual,
///
///   min over x of ||F theta(x) - f|| / s(theta(x)),   F = [f_1(q) ... f_m(q)],
///
/// where s is the mean stiffness (ForceScene::Weights).  For one isotropic
/// material this is ||a + nu b - t f||, t = 1 / s, a = H q, b = J q [Becker &
/// Teschner 2007, eq. 20-24].  Where no parameter is known or bounded, theta /
/// s and 1 / s are a linear least-squares problem; else the minimum is sought
/// by Ceres, in the triangle of the QR factorisation of [F f].
///
/// Noise of variance sigma^2 in q adds sigma^2 theta^T T theta / s^2 to the
/// expectation of the square of that residual, which biases its minimum.  What
/// it does not bias is the minimum of
///
///   ||F theta - f|| / sqrt(theta^T T theta)
///
/// (total least squares, Golub & Van Loan 1980), whose square over the
/// redundant equations estimates sigma^2.  The distance of the two minima is
/// the bias, the square of which is added to the covariance
///
///   sigma^2 A^-1 (X^T K K X / s^2) A^-1,   A = X^T X,
///
/// X the derivatives of the residual by x.  The covariance of a parameter on a
/// bound is that without the bound.
///
/// Where Poisson's ratios are known, the second minimum without them says
/// whether the data contradict them.  For a force residual above a tenth of the
/// loads, the balance of virtual work says whether noise explains it.
///
/// For laws of large strains, f_k(q) are the columns of LargeStrainForces at
/// measured displacements of any size, and noise adds the tangent K(theta) at q
/// times the noise, to first order.  In plane stress, where f is not linear in
/// theta, F has the derivatives df / dtheta_k at the last minimum
/// (Gauss-Newton), until the ratios of the moduli stay: about four times.
/// Throws std::invalid_argument where a displacement turns an element inside
/// out.
///
/// Preconditions are those of Estimator::Run; every free component is observed.
/// Cost: three element passes, one more for known Poisson's ratios, and that of
/// virtual-fields of degree 1 where it is asked; for large strains that of
/// ForceResidual instead of two of the passes.
Estimate RegressForces(const Scene& scene, const EstimatorOptions& options,
                       bool is_bounded);

/// Prepares for one measurement after another: what does not depend on the
/// measurement is kept, and an estimate takes two element passes.
std::unique_ptr<Preparation> PrepareForceRegression(
    const Scene& scene, const EstimatorOptions& options, bool is_bounded);

/// The variance of the weighted noise that the force residual of some variables
/// shows, ||F theta - f||^2 / (theta^T T theta) over the redundant equations;
/// empty where there are no more equations than unknowns.
std::optional<double> NoiseVarianceAt(const FreeParameters& free,
                                      const Eigen::VectorXd& variables,
                                      const ForceResidual& forces);

/// The minimum of ||F theta - f|| / sqrt(theta^T T theta).
struct UnbiasedFit {
  Eigen::VectorXd variables;
  std::optional<double> noise_variance;  ///< NoiseVarianceAt there.
};
UnbiasedFit FitWithoutBias(const FreeParameters& free,
                           const Eigen::VectorXd& start,
                           const ForceResidual& forces);

/// The covariance of the variables of that minimum to first order in the noise;
/// empty where they are not determined, or noise makes up half of A or more.
/// One element pass.
std::optional<Eigen::MatrixXd> CovarianceOf(const UnbiasedFit& fit,
                                            const FreeParameters& free,
                                            ForceResidual& forces);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_FORCE_BALANCE_FORCE_REGRESSION_H_
