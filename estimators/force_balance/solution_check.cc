#include "elastimate/estimators/force_balance/solution_check.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "elastimate/core/algebra/dense_algebra.h"
#include "elastimate/core/algebra/node_sums.h"
#include "elastimate/estimators/interface/limits.h"
#include "elastimate/estimators/statistics/element_errors.h"
#include "elastimate/estimators/statistics/profile_likelihood.h"
#include "elastimate/estimators/statistics/residual_statistics.h"

namespace elastimate {
namespace {

// Those that the measurement decides; also where nu lies at the end of its
// physical range.
std::vector<Eigen::Index> FreeOf(const EstimatorOptions& options,
                                 const ActiveBounds& active) {
  std::vector<Eigen::Index> free;
  if (active.youngs_modulus == Side::kNone) {
    free.push_back(0);
  }
  if (!options.known_poisson_ratio &&
      (active.poisson_ratio == Side::kNone || active.is_physical_limit)) {
    free.push_back(1);
  }
  return free;
}

// Of (ln E, nu) by their causes.
struct Covariances {
  Eigen::Matrix2d of_model = Eigen::Matrix2d::Zero();
  Eigen::Matrix2d of_elements = Eigen::Matrix2d::Zero();
};

// Of a step of the free ones of (ln E, nu) in the model that is linear in them,
// that of models that are linear in 1 / E and in LogStiffnessRatio, where these
// are larger: next to nu = 1/2 the former reaches no other nu.
void Lengthen(const std::vector<Eigen::Index>& free,
              const IsotropicElasticity& elasticity, Eigen::VectorXd& step) {
  constexpr double kMost = 0.999;  // A thousand times as stiff.
  const double nu = elasticity.poisson_ratio;
  for (std::size_t i = 0; i < free.size(); ++i) {
    double& change = step(Eigen::Index(i));
    const double other = free[i] == 0
                             ? -std::log1p(-std::min(change, kMost))
                             : PoissonRatioOfLogStiffnessRatio(
                                   LogStiffnessRatio(nu) +
                                   3 * change / ((1 + nu) * (1 - 2 * nu))) -
                                   nu;
    if (std::abs(other) > std::abs(change)) {
      change = other;
    }
  }
}

Covariances CompareWithSolution(const Scene& scene,
                                const std::vector<Eigen::Index>& free,
                                ObservedModel& model, Evidence& evidence,
                                Estimate& estimate) {
  const ObservedDisplacements& observed = model.Observed();
  const double scale = estimate.elasticity.ComplianceScale(model.Section());
  const Eigen::MatrixXd sensitivities =
      model.Sensitivities(estimate.elasticity.youngs_modulus)(Eigen::all, free);
  Eigen::VectorXd residual = scale * model.UnitLoadResponse() +
                             model.SupportResponse() - observed.Measured();
  Eigen::VectorXd step = -SolveLeastSquares(sensitivities, residual);
  residual += sensitivities * step;
  std::optional<RowChange> change;
  if (const std::optional<Eigen::VectorXd> rows =
          model.ElementChangeOf(estimate.elasticity)) {
    change = {*rows, {}, {}};
  }
  const Eigen::VectorXd weights = Eigen::VectorXd::Ones(residual.size());
  const Eigen::MatrixXd information = sensitivities.transpose() * sensitivities;
  const ElementErrors elements(
      scene, model.Graph(), observed,
      FreeFit{residual, sensitivities, information, weights, true, false},
      change, model.Displacement(estimate.elasticity.youngs_modulus),
      estimate.elasticity);
  const SmoothSquareSum smooth =
      MeasureSmoothPart(model.Graph(), observed, elements.Rest(), estimate);
  if (elements.Correction()) {
    step += *elements.Correction();
    Eigen::Vector2d likely = Eigen::Vector2d::Zero();
    likely(free) = elements.LikelyChange();
    evidence.likely_element_change = likely;
  }
  Lengthen(free, estimate.elasticity, step);
  const Eigen::MatrixXd inverse = Inverse(information);
  const double missed = elements.MissedSquareSum(smooth.most);
  const Eigen::MatrixXd of_difference = step * step.transpose();
  const double share = std::clamp(elements.Share(), 0.0, 1.0);
  Covariances covariances;
  covariances.of_elements(free, free) =
      elements.CovarianceOfChange() + missed * inverse + share * of_difference;
  covariances.of_model(free, free) =
      elements.ModelSquareSum(std::max(0.0, smooth.least - missed)) * inverse +
      (1 - share) * of_difference / kTwoSidedQuantile;
  return covariances;
}

}  // namespace

void CheckBySolution(const Scene& scene, const EstimatorOptions& options,
                     ObservedModel& model, Evidence& evidence,
                     Estimate& estimate) {
  const std::vector<Eigen::Index> free = FreeOf(options, evidence.active);
  if (free.empty()) {
    return;
  }
  if (!model.SetPoissonRatio(estimate.elasticity.poisson_ratio)) {
    evidence.end = End::kSingularStiffness;
    return;
  }
  const Covariances covariances =
      CompareWithSolution(scene, free, model, evidence, estimate);
  const Eigen::Matrix2d added = covariances.of_model + covariances.of_elements;
  const Eigen::Vector2d scale(estimate.elasticity.youngs_modulus, 1);
  // What is not free has no covariance, and keeps none.
  estimate.covariance += scale.asDiagonal() * added * scale.asDiagonal();
  WidenInterval(added(1, 1), estimate);
  const bool has_poisson_ratio = std::isfinite(estimate.covariance(1, 1));
  ParameterErrors& of_model = estimate.error_budget.model;
  of_model =
      (of_model.array().square() + covariances.of_model.diagonal().array())
          .sqrt();
  const Eigen::Vector2d of_elements =
      covariances.of_elements.diagonal().cwiseSqrt();
  estimate.discretization_error = of_elements(0);
  if (has_poisson_ratio) {
    estimate.poisson_ratio_discretization_error = of_elements(1);
  }
}

}  // namespace elastimate
