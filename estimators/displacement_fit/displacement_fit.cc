#include "elastimate/estimators/displacement_fit/displacement_fit.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "elastimate/core/algebra/dense_algebra.h"
#include "elastimate/core/algebra/node_sums.h"
#include "elastimate/estimators/interface/limits.h"
#include "elastimate/estimators/statistics/errors_on_bound.h"
#include "elastimate/estimators/statistics/residual_statistics.h"

namespace elastimate {
namespace {

// The sine of the identifiability angle below which rounding decides: it comes
// from the square root of a difference, which has half the digits.
constexpr double kCollinearSensitivities = 1e-6;

// Sums over the observed nodes that the statistics are made of.  Derivatives
// are with respect to (ln E, nu); without a loss the bread is S^T S.
struct ResidualSums {
  Eigen::Matrix2d sensitivity_gram = Eigen::Matrix2d::Zero();
  Eigen::Matrix2d weighted_gram = Eigen::Matrix2d::Zero();  // S^T W S.
  Eigen::Matrix2d bread = Eigen::Matrix2d::Zero();
  Eigen::Matrix2d meat = Eigen::Matrix2d::Zero();
  // How much residuals count: a loss takes from those of bad nodes.
  Eigen::VectorXd weights;
};

ResidualSums SumResiduals(const ObservedDisplacements& observed,
                          const DisplacementFit& fit,
                          const NodeLosses& losses) {
  ResidualSums sums;
  sums.weights.resize(fit.residual.size());
  for (const ObservedDisplacements::Point& node : observed.Points()) {
    const auto r = fit.residual.segment(node.first, node.count);
    const auto s = fit.sensitivities.middleRows(node.first, node.count);
    const std::array<double, 3> rho =
        losses.Evaluate(node.count, r.squaredNorm());
    const Eigen::Vector2d gradient = s.transpose() * r;
    const Eigen::Matrix2d gram = s.transpose() * s;
    sums.sensitivity_gram += gram;
    sums.weighted_gram += rho[1] * gram;
    sums.bread += rho[1] * gram + 2 * rho[2] * gradient * gradient.transpose();
    sums.meat += rho[1] * rho[1] * gradient * gradient.transpose();
    sums.weights.segment(node.first, node.count).setConstant(rho[1]);
  }
  return sums;
}

double IdentifiabilityAngle(const Eigen::Matrix2d& gram) {
  const double cosine_product = std::abs(gram(0, 1));
  const double sine_product = std::sqrt(std::max(0.0, gram.determinant()));
  return std::atan2(sine_product, cosine_product);
}

// A fit and what follows from it.  Covariances are of (ln E, nu).
class FitDescription {
 public:
  FitDescription(const EstimatorOptions& options,
                 const ObservedDisplacements& observed,
                 const DisplacementFit& fit, const NodeLosses& losses,
                 Evidence& evidence, Estimate& estimate)
      : options_(options),
        observed_(observed),
        fit_(fit),
        losses_(losses),
        sums_(SumResiduals(observed, fit, losses)),
        square_sum_(SquaredNorm(fit.residual)),
        evidence_(evidence),
        estimate_(estimate) {
    if (evidence.active.youngs_modulus == Side::kNone) {
      free_.push_back(0);
    }
    if (!options.known_poisson_ratio &&
        evidence.active.poisson_ratio == Side::kNone) {
      free_.push_back(1);
    }
    estimate.displacement_residual =
        std::sqrt(square_sum_) / Norm(observed.Measured());
    estimate.identifiability_angle = IdentifiabilityAngle(Gram());
    is_collinear_ =
        std::sin(*estimate.identifiability_angle) < kCollinearSensitivities;
  }

  // Whether the data determine one combination of the parameters only.
  bool FindFreeDirection() {
    const ActiveBounds& active = evidence_.active;
    const bool is_bound_given =
        active.poisson_ratio != Side::kNone && !active.is_physical_limit;
    if (active.youngs_modulus != Side::kNone || options_.known_poisson_ratio ||
        is_bound_given || !is_collinear_) {
      return false;
    }
    evidence_.free_direction = {estimate_.elasticity,
                                {YoungsModulusSlope(), 1}};
    estimate_.elasticity = {Estimate::kUnknown, Estimate::kUnknown};
    return true;
  }

  // Whether there are no more components than the statistics need.
  bool AreTooFew() {
    if (observed_.GivenNoise() ||
        observed_.Size() - Eigen::Index(free_.size()) >=
            kLimits.least_redundancy) {
      return false;
    }
    evidence_.too_few_components = observed_.Size();
    return true;
  }

  void MeasureNoise(const NodeGraph& graph) {
    if (losses_.IsLeastSquares()) {
      variance_ =
          EstimateVariance(observed_, SquaredNorm(fit_.residual),
                           Eigen::Index(free_.size()), evidence_, estimate_);
    } else {
      estimate_.noise_sd =
          RobustStandardDeviation(fit_.residual) * observed_.Norm();
    }
    evidence_.is_explained_by_given_noise =
        variance_ && variance_->is_explained_by_given_noise;
    smooth_ = MeasureSmoothPart(
        graph, observed_, sums_.weights.cwiseSqrt().cwiseProduct(fit_.residual),
        estimate_);
    const double least =
        evidence_.is_explained_by_given_noise ? 0 : smooth_.least;
    evidence_.smooth_part = std::sqrt(least) / Norm(observed_.Measured());
    smooth_square_sum_ = least;
  }

  void FillCovariance() {
    ErrorBudget& budget = estimate_.error_budget;
    budget.noise = ErrorsOf(NoiseCovariance(free_));
    budget.model = ErrorsOf(ModelCovariance(free_));
    Eigen::Matrix2d covariance = Eigen::Matrix2d::Constant(Estimate::kUnknown);
    covariance(free_, free_) = Covariance(free_);
    if (losses_.IsLeastSquares() && !free_.empty()) {
      Eigen::Vector2d change = Eigen::Vector2d::Zero();
      if (HasHeavyTails(fit_.residual)) {
        change(free_) = RobustChange(observed_, fit_.residual,
                                     fit_.sensitivities(Eigen::all, free_));
        evidence_.outlier_change = change;
      }
      const Eigen::Matrix2d of_outliers = change * change.transpose();
      covariance += of_outliers;
      budget.outliers = ErrorsOf(of_outliers(free_, free_));
    }
    const Eigen::Vector2d scale(estimate_.elasticity.youngs_modulus, 1);
    estimate_.covariance = scale.asDiagonal() * covariance * scale.asDiagonal();
    if (smooth_square_sum_ > 0) {
      evidence_.smooth_residual_error = budget.model(0);
    }
  }

  FitStatistics Statistics() const {
    FitStatistics statistics;
    statistics.row_variance = RowVariance();
    return statistics;
  }

  void MeasureYoungsModulusOnBound() {
    if (square_sum_ == 0) {
      return;
    }
    const std::vector<Eigen::Index> parameters =
        options_.known_poisson_ratio ? std::vector<Eigen::Index>{0}
                                     : std::vector<Eigen::Index>{0, 1};
    // The fit without the bound in the linear model u + S delta.
    const Eigen::MatrixXd s = fit_.sensitivities(Eigen::all, parameters);
    const Eigen::VectorXd change = -SolveLeastSquares(s, fit_.residual);
    const double least = SquaredNorm(fit_.residual + s * change);
    evidence_.bound_excess = {
        square_sum_ - least, least / static_cast<double>(fit_.residual.size()),
        estimate_.elasticity.youngs_modulus * std::exp(change(0)),
        estimate_.elasticity.youngs_modulus, "E"};
    const double standard_error = !options_.known_poisson_ratio && is_collinear_
                                      ? std::numeric_limits<double>::infinity()
                                      : std::sqrt(Covariance(parameters)(0, 0));
    evidence_.youngs_modulus_on_bound = AllowForYoungsModulusOnBound(
        options_, -Gram()(0, 1) / Gram()(1, 1),
        std::sqrt(least / square_sum_) * standard_error, estimate_);
  }

  void MeasurePoissonRatioOnBound() {
    const double standard_error =
        is_collinear_         ? std::numeric_limits<double>::infinity()
        : IsAtPhysicalLimit() ? std::sqrt(PoissonRatioVarianceOffLimit())
                              : std::sqrt(Covariance({0, 1})(1, 1));
    evidence_.poisson_ratio_on_bound = AllowForPoissonRatioOnBound(
        options_, evidence_.active, YoungsModulusSlope(), standard_error,
        estimate_);
  }

 private:
  // Of a row of the residual of weight 1, by the standard error of nu; empty
  // when there is none.
  std::optional<double> RowVariance() const {
    if (IsAtPhysicalLimit()) {
      return PoissonRatioVarianceOffLimit() /
             LastOfInverse(sums_.weighted_gram, FreeOffLimit());
    }
    if (!IsPoissonRatioFree()) {
      return std::nullopt;
    }
    return estimate_.covariance(1, 1) /
           LastOfInverse(sums_.weighted_gram, free_);
  }

  // Where nu is held by the end of its range alone, it may be off by what it
  // would be off by if it were free.
  bool IsAtPhysicalLimit() const {
    return evidence_.active.is_physical_limit && !is_collinear_;
  }
  std::vector<Eigen::Index> FreeOffLimit() const {
    std::vector<Eigen::Index> parameters = free_;
    parameters.push_back(1);
    return parameters;
  }
  double PoissonRatioVarianceOffLimit() const {
    const std::vector<Eigen::Index> parameters = FreeOffLimit();
    const Eigen::MatrixXd covariance = Covariance(parameters);
    return covariance(covariance.rows() - 1, covariance.cols() - 1);
  }
  const Eigen::Matrix2d& Gram() const { return sums_.sensitivity_gram; }
  // d ln E / d nu of the parameters that fit alike.
  double YoungsModulusSlope() const { return -Gram()(0, 1) / Gram()(0, 0); }
  bool IsPoissonRatioFree() const {
    return !free_.empty() && free_.back() == 1;
  }
  // The entry of the last of some parameters, of the inverse over them.
  static double LastOfInverse(const Eigen::Matrix2d& matrix,
                              const std::vector<Eigen::Index>& parameters) {
    const Eigen::MatrixXd inverse = Inverse(matrix(parameters, parameters));
    return inverse(inverse.rows() - 1, inverse.cols() - 1);
  }

  // Of the parameters that vary together.
  Eigen::MatrixXd NoiseCovariance(
      const std::vector<Eigen::Index>& parameters) const {
    const Eigen::MatrixXd inverse_bread =
        Inverse(sums_.bread(parameters, parameters));
    if (variance_) {
      return variance_->variance * inverse_bread;
    }
    return inverse_bread * sums_.meat(parameters, parameters) * inverse_bread;
  }
  Eigen::MatrixXd ModelCovariance(
      const std::vector<Eigen::Index>& parameters) const {
    return smooth_square_sum_ * Inverse(Gram()(parameters, parameters));
  }
  Eigen::MatrixXd Covariance(
      const std::vector<Eigen::Index>& parameters) const {
    return NoiseCovariance(parameters) + ModelCovariance(parameters);
  }
  ParameterErrors ErrorsOf(const Eigen::MatrixXd& of_free) const {
    Eigen::Matrix2d both = Eigen::Matrix2d::Constant(Estimate::kUnknown);
    both(free_, free_) = of_free;
    return StandardErrors(both, {1, 0});
  }

  const EstimatorOptions& options_;
  const ObservedDisplacements& observed_;
  const DisplacementFit& fit_;
  const NodeLosses& losses_;
  ResidualSums sums_;
  double square_sum_;
  Evidence& evidence_;
  Estimate& estimate_;
  std::vector<Eigen::Index> free_;
  bool is_collinear_ = false;
  /// Empty with a loss.
  std::optional<ResidualVariance> variance_;
  SmoothSquareSum smooth_ = {};
  double smooth_square_sum_ = 0;
};

}  // namespace

FitStatistics DescribeDisplacementFit(
    const Scene& scene, const NodeGraph& graph, const EstimatorOptions& options,
    const ObservedDisplacements& observed, const DisplacementFit& fit,
    const NodeLosses& losses, Evidence& evidence, Estimate& estimate) {
  estimate.element_order = scene.mesh.Order();
  FitDescription description(options, observed, fit, losses, evidence,
                             estimate);
  if (description.FindFreeDirection() || description.AreTooFew()) {
    return {};
  }
  description.MeasureNoise(graph);
  description.FillCovariance();
  FitStatistics statistics = description.Statistics();
  if (evidence.active.youngs_modulus != Side::kNone) {
    description.MeasureYoungsModulusOnBound();
  }
  if (evidence.active.poisson_ratio != Side::kNone) {
    description.MeasurePoissonRatioOnBound();
  }
  return statistics;
}

}  // namespace elastimate
