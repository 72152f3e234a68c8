#include "elastimate/estimators/displacement_fit/robust_reduced_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "elastimate/estimators/displacement_fit/displacement_fit.h"
#include "elastimate/estimators/interface/statistics.h"

namespace elastimate {
namespace {

Eigen::VectorXd Residual(const ReducedModel& model,
                         const ObservedDisplacements& observed,
                         const ReducedFit::Point& point) {
  return ExpandFit(
             model, observed,
             IsotropicElasticity::FromComplianceScale(
                 point.compliance_scale, point.poisson_ratio, model.Section()))
      .residual;
}

// The start of a robust fit: the nu and t of least absolute deviations.
ReducedFit::Point LeastAbsoluteDeviationsFit(
    const ReducedModel& model, const ObservedDisplacements& observed,
    const Bounds& poisson_ratio) {
  ReducedFit::Point best = {*poisson_ratio.lower, Estimate::kUnknown,
                            std::numeric_limits<double>::infinity()};
  for (const double candidate : {-0.5, 0.0, 0.3, 0.45}) {
    const double nu =
        std::clamp(candidate, *poisson_ratio.lower, *poisson_ratio.upper);
    // At E = 1: u = t w + v and du / d ln E = -t w.
    const IsotropicElasticity unit = {1, nu};
    const DisplacementFit fit = ExpandFit(model, observed, unit);
    const double unit_scale = unit.ComplianceScale(model.Section());
    const Eigen::VectorXd w = -fit.sensitivities.col(0) / unit_scale;
    if (w.isZero(0)) {
      continue;
    }
    const Eigen::VectorXd rest = -(fit.residual - unit_scale * w);
    const double t = LeastAbsoluteDeviations(w, rest);
    const double deviation = (rest - t * w).lpNorm<1>();
    const bool is_better = (t > 0) == (best.compliance_scale > 0)
                               ? deviation < best.square_sum
                               : t > 0;
    if (is_better) {
      best = {nu, t, deviation};
    }
  }
  return best;
}

}  // namespace

Eigen::VectorXd RowWeights(const ObservedDisplacements& observed,
                           const Eigen::VectorXd& residual,
                           const NodeLosses& losses) {
  Eigen::VectorXd weights(observed.Size());
  for (const ObservedDisplacements::Point& node : observed.Points()) {
    const double square_sum =
        residual.segment(node.first, node.count).squaredNorm();
    weights.segment(node.first, node.count)
        .setConstant(std::sqrt(losses.Evaluate(node.count, square_sum)[1]));
  }
  return weights;
}

ModelFit FitRobustly(const ReducedModel& model,
                     const ObservedDisplacements& observed,
                     const EstimatorOptions& options,
                     const Bounds& poisson_ratio) {
  constexpr int kMostRescalings = 6;
  constexpr int kMostReweightings = 100;
  constexpr double kScaleTolerance = 0.01;
  constexpr double kPointTolerance = 1e-8;
  constexpr double kExactFit = 1e-12;
  ModelFit fit;
  fit.point = LeastAbsoluteDeviationsFit(model, observed, poisson_ratio);
  Eigen::VectorXd residual = Residual(model, observed, fit.point);
  fit.standard_deviation = 0;
  for (int i = 0; i < kMostRescalings; ++i) {
    const double scale = std::max(kExactFit, RobustStandardDeviation(residual));
    if (std::abs(scale - fit.standard_deviation) <= kScaleTolerance * scale) {
      break;
    }
    fit.standard_deviation = scale;
    fit.losses = NodeLosses(options.loss, scale);
    for (int k = 0; k < kMostReweightings; ++k) {
      const ReducedFit::Point previous = fit.point;
      fit.weighted = std::make_unique<ReducedFit>(
          model, observed, RowWeights(observed, residual, fit.losses),
          poisson_ratio, options.youngs_modulus);
      fit.point = fit.weighted->Fit(observed.Measured());
      residual = Residual(model, observed, fit.point);
      if (std::abs(fit.point.poisson_ratio - previous.poisson_ratio) <=
              kPointTolerance &&
          std::abs(fit.point.compliance_scale - previous.compliance_scale) <=
              kPointTolerance * std::abs(fit.point.compliance_scale)) {
        break;
      }
    }
  }
  return fit;
}

}  // namespace elastimate
