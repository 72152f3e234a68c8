#include "elastimate/estimators/displacement_fit/displacement_profile.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "elastimate/core/algebra/node_sums.h"
#include "elastimate/estimators/interface/statistics.h"

namespace elastimate {

namespace {

ProfilePoint EvaluateRows(const EstimatorOptions& options,
                          const Eigen::VectorXd& row_weights,
                          ObservedModel& model, double nu) {
  const Eigen::VectorXd w = row_weights.cwiseProduct(model.UnitLoadResponse());
  const Eigen::VectorXd rest = row_weights.cwiseProduct(
      model.Observed().Measured() - model.SupportResponse());
  if (w.isZero(0)) {
    return {{Estimate::kUnknown, nu}, std::numeric_limits<double>::infinity()};
  }
  const double t = options.loss == Loss::kNone
                       ? InnerProduct(w, rest) / SquaredNorm(w)
                       : LeastAbsoluteDeviations(w, rest);
  IsotropicElasticity elasticity =
      IsotropicElasticity::FromComplianceScale(t, nu, model.Section());
  if (!elasticity.IsPhysical()) {
    return {elasticity, CostOf(options.loss, rest - t * w)};
  }
  const IsotropicElasticity unbounded = elasticity;
  double& youngs_modulus = elasticity.youngs_modulus;
  youngs_modulus = std::max(
      youngs_modulus, options.youngs_modulus.lower.value_or(youngs_modulus));
  youngs_modulus = std::min(
      youngs_modulus, options.youngs_modulus.upper.value_or(youngs_modulus));
  const Eigen::VectorXd misfit =
      elasticity.ComplianceScale(model.Section()) * w - rest;
  const Eigen::VectorXd change =
      row_weights.cwiseProduct(model.PoissonRatioSlope(
          elasticity, youngs_modulus != unbounded.youngs_modulus));
  const double slope = options.loss == Loss::kNone
                           ? 2 * InnerProduct(misfit, change)
                           : InnerProduct(misfit.cwiseSign(), change);
  return {elasticity, CostOf(options.loss, misfit), slope, unbounded,
          CostOf(options.loss, rest - t * w)};
}

}  // namespace

double CostOf(Loss loss, const Eigen::VectorXd& residual) {
  return loss == Loss::kNone ? SquaredNorm(residual) : residual.lpNorm<1>();
}

ProfilePoint EvaluateProfile(const EstimatorOptions& options,
                             ObservedModel& model, double nu) {
  return EvaluateRows(options, Eigen::VectorXd::Ones(model.Observed().Size()),
                      model, nu);
}

ProfilePoint EvaluateWeightedProfile(const EstimatorOptions& options,
                                     const Eigen::VectorXd& row_weights,
                                     ObservedModel& model, double nu) {
  EstimatorOptions of_squares = options;
  of_squares.loss = Loss::kNone;
  return EvaluateRows(of_squares, row_weights, model, nu);
}

IsotropicElasticity EvaluatedProfile::EndTowards(double limit,
                                                 double excess) const {
  const double nu = best_.unbounded.poisson_ratio;
  std::vector<ProfilePoint> side = {best_};
  for (const ProfilePoint& point : points_) {
    if ((point.unbounded.poisson_ratio - nu) * (limit - nu) > 0) {
      side.push_back(point);
    }
  }
  std::sort(side.begin(), side.end(),
            [nu](const ProfilePoint& a, const ProfilePoint& b) {
              return std::abs(a.unbounded.poisson_ratio - nu) <
                     std::abs(b.unbounded.poisson_ratio - nu);
            });
  const auto root_of = [&](const ProfilePoint& point) {
    return std::sqrt(
        std::max(point.unbounded_cost - best_.unbounded_cost, 0.0) / excess);
  };
  std::size_t inner = side.size() - 1;
  while (root_of(side[inner]) >= 1) {
    --inner;  // The best is inside.
  }
  const IsotropicElasticity& inside = side[inner].unbounded;
  if (inner + 1 == side.size()) {
    return {inside.youngs_modulus, limit};
  }
  const IsotropicElasticity& outside = side[inner + 1].unbounded;
  const double inner_root = root_of(side[inner]);
  const double share =
      (1 - inner_root) / (root_of(side[inner + 1]) - inner_root);
  const auto between = [share](double a, double b) {
    return a + share * (b - a);
  };
  return {between(inside.youngs_modulus, outside.youngs_modulus),
          between(inside.poisson_ratio, outside.poisson_ratio)};
}

}  // namespace elastimate
