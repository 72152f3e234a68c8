#include "elastimate/estimators/displacement_fit/displacement_fit.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "elastimate/core/algebra/dense_algebra.h"
#include "elastimate/core/mechanics/strain_energy.h"
#include "elastimate/core/scene/rigid_motion.h"
#include "elastimate/estimators/interface/finding_sentences.h"
#include "elastimate/estimators/interface/limits.h"
#include "elastimate/estimators/interface/statistics.h"

namespace elastimate {
namespace {

// The sine of the identifiability angle below which rounding decides: it comes
// from the square root of a difference, which has half the digits.
constexpr double kCollinear = 1e-6;

// Sums over the observed nodes that the statistics are made of.  Derivatives
// are with respect to (ln E, nu); without a loss the bread is S^T S.
struct ResidualSums {
  Eigen::Matrix2d sensitivity_gram = Eigen::Matrix2d::Zero();
  Eigen::Matrix2d bread = Eigen::Matrix2d::Zero();
  Eigen::Matrix2d meat = Eigen::Matrix2d::Zero();
  // The residuals as they count: a loss takes from those of bad nodes.
  Eigen::VectorXd weighted_residual;
};

ResidualSums SumResiduals(const ObservedDisplacements& observed,
                          const DisplacementFit& fit,
                          const NodeLosses& losses) {
  ResidualSums sums;
  sums.weighted_residual = fit.residual;
  for (const ObservedDisplacements::Node& node : observed.Nodes()) {
    const auto r = fit.residual.segment(node.first, node.count);
    const auto s = fit.sensitivities.middleRows(node.first, node.count);
    const std::array<double, 3> rho =
        losses.Evaluate(node.count, r.squaredNorm());
    const Eigen::Vector2d gradient = s.transpose() * r;
    const Eigen::Matrix2d gram = s.transpose() * s;
    sums.sensitivity_gram += gram;
    sums.bread += rho[1] * gram + 2 * rho[2] * gradient * gradient.transpose();
    sums.meat += rho[1] * rho[1] * gradient * gradient.transpose();
    sums.weighted_residual.segment(node.first, node.count) *= std::sqrt(rho[1]);
  }
  return sums;
}

double IdentifiabilityAngle(const Eigen::Matrix2d& gram) {
  const double cosine_product = std::abs(gram(0, 1));
  const double sine_product = std::sqrt(std::max(0.0, gram.determinant()));
  return std::atan2(sine_product, cosine_product);
}

// Variance of the normalised residuals, and whether it is that of the noise.
struct ResidualVariance {
  double variance;
  bool is_explained_by_given_noise;
};

// From the residuals themselves, or as given when they do not contradict it.
ResidualVariance EstimateVariance(const ObservedDisplacements& observed,
                                  const Scene& scene, double square_sum,
                                  Eigen::Index num_free, Estimate& estimate) {
  const Eigen::Index redundancy = observed.Size() - num_free;
  const double norm_squared = observed.Norm() * observed.Norm();
  const std::optional<double>& given = scene.load_cases.front().noise_sd;
  const double m = static_cast<double>(std::max<Eigen::Index>(redundancy, 1));
  const double variance = square_sum / m;
  estimate.noise_sd = given ? *given : std::sqrt(variance) * observed.Norm();
  if (!given) {
    // Student's t of m degrees of freedom has the variance m / (m - 2).
    return ResidualVariance{variance * m / (m - 2), false};
  }
  // chi^2 has mean m and variance 2 m.
  const double ratio = variance * norm_squared;
  if (redundancy > 0 &&
      ratio > 1 + kLimits.significant_score * std::sqrt(2 / m)) {
    estimate.Add(
        ResidualAboveNoise(ResidualKind::kDisplacement, std::sqrt(ratio)));
    return ResidualVariance{variance, false};
  }
  return ResidualVariance{1 / norm_squared, true};
}

// The square sum of the part of the residual that neighbours share; zero when
// independent noise explains what they share.
double SmoothSquareSum(const NodeGraph& graph,
                       const ObservedDisplacements& observed,
                       const Eigen::VectorXd& residual, Estimate& estimate) {
  const std::optional<NeighbourCorrelation> neighbours =
      CorrelateNeighbours(graph, observed, residual);
  if (!neighbours) {
    return 0;
  }
  estimate.residual_correlation =
      std::clamp(neighbours->correlation, -1.0, 1.0);
  estimate.is_model_in_doubt =
      neighbours->standard_score > kLimits.significant_score;
  return estimate.is_model_in_doubt
             ? *estimate.residual_correlation * residual.squaredNorm()
             : 0;
}

void WarnOfSmoothResidual(double relative_error, Estimate& estimate) {
  // Not a number for an E on a bound.
  if (!(relative_error <= kLimits.notable_youngs_modulus_error)) {
    estimate.Add(SmoothResidual(*estimate.residual_correlation));
  }
}

// For E on a bound.  `parameters` are those that are free without it,
// `standard_error` is that of ln E for the residual of the fit, `slope` =
// d nu / d ln E.
void JudgeYoungsModulus(const EstimatorOptions& options,
                        const DisplacementFit& fit,
                        const std::vector<Eigen::Index>& parameters,
                        double slope, double standard_error,
                        Estimate& estimate) {
  const double square_sum = fit.residual.squaredNorm();
  if (square_sum == 0) {
    return;
  }
  // The fit without the bound in the linear model u + S delta: a bound that the
  // data contradict leaves much that is no noise.
  const Eigen::MatrixXd s = fit.sensitivities(Eigen::all, parameters);
  const Eigen::VectorXd change = -SolveLeastSquares(s, fit.residual);
  const double least = (fit.residual + s * change).squaredNorm();
  JudgeContradictedBound(
      square_sum - least, least / static_cast<double>(fit.residual.size()),
      estimate.elasticity.youngs_modulus * std::exp(change(0)), estimate);
  if (estimate.IsUsable()) {
    JudgeYoungsModulusOnBound(options, slope,
                              std::sqrt(least / square_sum) * standard_error,
                              estimate);
  }
}

// The change of (ln E, nu) from the least-squares fit to a robust one, in the
// linear model u + S delta: the weighted least squares of Huber's loss.
Eigen::Vector2d RobustChange(const ObservedDisplacements& observed,
                             const DisplacementFit& fit,
                             const std::vector<Eigen::Index>& free) {
  constexpr int kReweightings = 50;
  Eigen::Vector2d change = Eigen::Vector2d::Zero();
  for (int i = 0; i < kReweightings; ++i) {
    DisplacementFit moved = fit;
    moved.residual += fit.sensitivities * change;
    const NodeLosses losses(Loss::kHuber,
                            RobustStandardDeviation(moved.residual));
    Eigen::Matrix2d gram = Eigen::Matrix2d::Zero();
    Eigen::Vector2d gradient = Eigen::Vector2d::Zero();
    for (const ObservedDisplacements::Node& node : observed.Nodes()) {
      const auto r = moved.residual.segment(node.first, node.count);
      const auto s = fit.sensitivities.middleRows(node.first, node.count);
      const double weight = losses.Evaluate(node.count, r.squaredNorm())[1];
      gram += weight * s.transpose() * s;
      gradient += weight * s.transpose() * r;
    }
    change(free) -= SolveLeastSquares(gram(free, free), gradient(free));
  }
  return change;
}

// Whether some residuals are much larger than the bulk of them.
bool HasHeavyTails(const Eigen::VectorXd& residual) {
  const double n = static_cast<double>(residual.size());
  // The standard deviation of 1.4826 MAD is 1.17 / sqrt(n) of itself.
  const double threshold =
      kLimits.heavy_tails + kLimits.significant_score * 1.17 / std::sqrt(n);
  return residual.norm() / std::sqrt(n) >
         threshold * RobustStandardDeviation(residual);
}

// `smooth` is the smooth part of the residual, relative to the measurement.
void JudgeLargeResidual(double smooth, bool is_explained, Estimate& estimate) {
  if (smooth > kLimits.large_residual && estimate.IsUsable()) {
    estimate.Fail(LargeSmoothResidual(smooth));
  } else if (*estimate.displacement_residual > kLimits.large_residual &&
             smooth == 0 && !is_explained) {
    estimate.Add(LargeResidual(*estimate.displacement_residual));
  }
}

}  // namespace

std::string WhyNoDisplacementFit(const Scene& scene) {
  std::string why = WhyNotHeld(scene.mesh, scene.supports);
  if (!why.empty() && scene.mesh.Order() == 1) {
    why += ", or use closed-form or virtual-fields, which need no supports";
  }
  return why;
}

std::optional<NeighbourCorrelation> CorrelateNeighbours(
    const NodeGraph& graph, const ObservedDisplacements& observed,
    const Eigen::VectorXd& residual) {
  const double square_sum = residual.squaredNorm();
  const Eigen::Index num_nodes = Eigen::Index(graph.start.size()) - 1;
  double product_sum = 0;
  Eigen::Index num_products = 0;
  // Row of each component of each node in the present load case, or -1.
  Eigen::Matrix<Eigen::Index, 3, Eigen::Dynamic> rows(3, num_nodes);
  const auto& nodes = observed.Nodes();
  for (auto begin = nodes.begin(); begin != nodes.end();) {
    const auto end = std::find_if(begin, nodes.end(), [&](const auto& node) {
      return node.load_case != begin->load_case;
    });
    rows.setConstant(-1);
    for (auto node = begin; node != end; ++node) {
      for (int k = 0; k < node->count; ++k) {
        const Eigen::Index row = node->first + k;
        rows(observed.Component(row), node->node) = row;
      }
    }
    for (Eigen::Index node = 0; node < num_nodes; ++node) {
      for (Eigen::Index k = graph.start[node] + 1; k < graph.start[node + 1];
           ++k) {
        for (int i = 0; i < 3; ++i) {
          const Eigen::Index row = rows(i, node);
          const Eigen::Index other = rows(i, graph.row[k]);
          if (row >= 0 && other >= 0) {
            product_sum += residual(row) * residual(other);
            ++num_products;
          }
        }
      }
    }
    begin = end;
  }
  if (num_products == 0 || square_sum == 0) {
    return std::nullopt;
  }
  const double n = static_cast<double>(num_products);
  const double variance = square_sum / static_cast<double>(residual.size());
  const double correlation = product_sum / (n * variance);
  return NeighbourCorrelation{correlation, correlation * std::sqrt(n)};
}

std::optional<double> DescribeDisplacementFit(
    const Scene& scene, const NodeGraph& graph, const EstimatorOptions& options,
    const ObservedDisplacements& observed, const DisplacementFit& fit,
    const NodeLosses& losses, const ActiveBounds& active, Estimate& estimate) {
  const ResidualSums sums = SumResiduals(observed, fit, losses);
  const Eigen::Matrix2d& gram = sums.sensitivity_gram;
  const double slope = -gram(0, 1) / gram(0, 0);
  const double square_sum = fit.residual.squaredNorm();
  estimate.displacement_residual =
      std::sqrt(square_sum) / observed.Measured().norm();
  estimate.identifiability_angle = IdentifiabilityAngle(gram);
  const bool is_collinear =
      std::sin(*estimate.identifiability_angle) < kCollinear;

  std::vector<Eigen::Index> free;
  if (active.youngs_modulus == BoundedParameter::Side::kNone) {
    free.push_back(0);
  }
  if (!options.known_poisson_ratio &&
      active.poisson_ratio == BoundedParameter::Side::kNone) {
    free.push_back(1);
  }
  const bool is_bound_given =
      active.poisson_ratio != BoundedParameter::Side::kNone &&
      !active.is_physical_limit;
  if (active.youngs_modulus == BoundedParameter::Side::kNone &&
      !options.known_poisson_ratio && !is_bound_given && is_collinear) {
    estimate.Fail(OneCombination(estimate.elasticity, {slope, 1}));
    estimate.elasticity = {Estimate::kUnknown, Estimate::kUnknown};
    return std::nullopt;
  }

  // There is nothing to compare the strain of a single element with.
  if (scene.mesh.NumElements() > 1) {
    estimate.discretization_error =
        DiscretizationError(scene.mesh, estimate.elasticity, fit.displacement);
    if (!free.empty() && free.back() == 1) {
      const Eigen::MatrixXd inverse = Inverse(gram(free, free));
      estimate.poisson_ratio_discretization_error =
          *estimate.discretization_error * observed.Measured().norm() *
          std::sqrt(inverse(inverse.rows() - 1, inverse.cols() - 1));
    }
  }

  if (observed.Size() - Eigen::Index(free.size()) < kLimits.least_redundancy &&
      !scene.load_cases.front().noise_sd) {
    if (estimate.IsUsable()) {
      estimate.Fail(TooFewMeasurements(observed.Size()));
    }
    return std::nullopt;
  }
  std::optional<ResidualVariance> variance;
  if (losses.IsLeastSquares()) {
    variance = EstimateVariance(observed, scene, square_sum,
                                Eigen::Index(free.size()), estimate);
  } else {
    estimate.noise_sd = RobustStandardDeviation(fit.residual) * observed.Norm();
  }
  const double smooth_square_sum =
      variance && variance->is_explained_by_given_noise
          ? 0
          : SmoothSquareSum(graph, observed, sums.weighted_residual, estimate);

  // Of the parameters that vary together.
  const auto noise_covariance_of =
      [&](const std::vector<Eigen::Index>& parameters) {
        const Eigen::MatrixXd inverse_bread =
            Inverse(sums.bread(parameters, parameters));
        return variance ? Eigen::MatrixXd(variance->variance * inverse_bread)
                        : Eigen::MatrixXd(inverse_bread *
                                          sums.meat(parameters, parameters) *
                                          inverse_bread);
      };
  const auto model_covariance_of =
      [&](const std::vector<Eigen::Index>& parameters) {
        return Eigen::MatrixXd(smooth_square_sum *
                               Inverse(gram(parameters, parameters)));
      };
  const auto covariance_of = [&](const std::vector<Eigen::Index>& parameters) {
    return Eigen::MatrixXd(noise_covariance_of(parameters) +
                           model_covariance_of(parameters));
  };
  // In (ln E, nu).
  const auto errors_of = [&](const Eigen::MatrixXd& of_free) {
    Eigen::Matrix2d both = Eigen::Matrix2d::Constant(Estimate::kUnknown);
    both(free, free) = of_free;
    return StandardErrors(both, {1, 0});
  };
  ErrorBudget& budget = estimate.error_budget;
  budget.model = errors_of(model_covariance_of(free));
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Constant(Estimate::kUnknown);
  covariance(free, free) = covariance_of(free);
  if (losses.IsLeastSquares() && !free.empty()) {
    Eigen::Vector2d change = Eigen::Vector2d::Zero();
    if (HasHeavyTails(fit.residual)) {
      change = RobustChange(observed, fit, free);
      covariance += change * change.transpose();
      if (std::abs(change(0)) > kLimits.notable_youngs_modulus_error) {
        estimate.Add(Outliers(change));
      }
    }
    budget.outliers = errors_of((change * change.transpose())(free, free));
  }
  const Eigen::Vector2d scale(estimate.elasticity.youngs_modulus, 1);
  if (estimate.IsUsable()) {
    budget.noise = errors_of(noise_covariance_of(free));
    estimate.covariance = scale.asDiagonal() * covariance * scale.asDiagonal();
  }
  if (smooth_square_sum > 0) {
    WarnOfSmoothResidual(std::sqrt(covariance(0, 0)), estimate);
  }
  if (!estimate.active_bounds.empty()) {
    estimate.why_no_standard_error = "a parameter on a bound has none";
  }
  if (estimate.status == Status::kOk &&
      active.youngs_modulus != BoundedParameter::Side::kNone) {
    const bool is_known = options.known_poisson_ratio.has_value();
    const std::vector<Eigen::Index> parameters =
        is_known ? std::vector<Eigen::Index>{0}
                 : std::vector<Eigen::Index>{0, 1};
    const double standard_error =
        !is_known && is_collinear ? std::numeric_limits<double>::infinity()
                                  : std::sqrt(covariance_of(parameters)(0, 0));
    JudgeYoungsModulus(options, fit, parameters, -gram(0, 1) / gram(1, 1),
                       standard_error, estimate);
  }
  JudgeLargeResidual(std::sqrt(smooth_square_sum) / observed.Measured().norm(),
                     variance && variance->is_explained_by_given_noise,
                     estimate);
  if (estimate.status == Status::kOk &&
      active.poisson_ratio != BoundedParameter::Side::kNone) {
    const double standard_error = is_collinear
                                      ? std::numeric_limits<double>::infinity()
                                      : std::sqrt(covariance_of({0, 1})(1, 1));
    JudgePoissonRatioOnBound(options, active, slope, standard_error, estimate);
  }
  if (std::find(free.begin(), free.end(), 1) == free.end()) {
    return active.is_physical_limit && variance
               ? std::optional<double>(variance->variance)
               : std::nullopt;
  }
  const Eigen::MatrixXd inverse_bread = Inverse(sums.bread(free, free));
  return covariance(1, 1) /
         inverse_bread(inverse_bread.rows() - 1, inverse_bread.cols() - 1);
}

}  // namespace elastimate
