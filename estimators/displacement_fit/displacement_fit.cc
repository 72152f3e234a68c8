#include "elastimate/estimators/displacement_fit/displacement_fit.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "elastimate/core/algebra/dense_algebra.h"
#include "elastimate/core/mechanics/strain_energy.h"
#include "elastimate/estimators/displacement_fit/finer_specimen.h"
#include "elastimate/estimators/displacement_fit/residual_statistics.h"
#include "elastimate/estimators/interface/limits.h"
#include "elastimate/estimators/statistics/errors_on_bound.h"

namespace elastimate {
namespace {

// The sine of the identifiability angle below which rounding decides: it comes
// from the square root of a difference, which has half the digits.
constexpr double kCollinearSensitivities = 1e-6;

// What the elements miss, as a share of a change of the displacements that is
// known, in the direction of a parameter: of linear elements beside the change
// to quadratic ones, and by how much of itself that change of the parameters is
// off; of quadratic ones, of the change from linear ones; and where neither is
// known, of the share of the energy that is missed [benchmarks: unseen].
constexpr double kLinearErrorShare = 0.1;
constexpr double kUnequalShare = 0.33;
constexpr double kQuadraticErrorShare = 0.025;
constexpr double kQuadraticUnequalShare = 0.08;
constexpr double kUnknownErrorShare = 0.3;
// How much more of an error than of the residual that it leaves the parameters
// may take up, squared: beside a change that is known, and where it is not
// known what it looks like.
constexpr double kInSpan = 4;
constexpr double kMostInSpan = 100;
constexpr double kMostVisible = 9;
// Of neighbours, above which residuals say nothing.
constexpr double kMostCorrelation = 0.99;
constexpr double kUnknownShareError = 1e3;

// Sums over the observed nodes that the statistics are made of.  Derivatives
// are with respect to (ln E, nu); without a loss the bread is S^T S.
struct ResidualSums {
  Eigen::Matrix2d sensitivity_gram = Eigen::Matrix2d::Zero();
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
        square_sum_(fit.residual.squaredNorm()),
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
        std::sqrt(square_sum_) / observed.Measured().norm();
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

  // What finer elements would change in the parameters, and how much of that is
  // to be seen in the residual.
  void MeasureElements(const Scene& scene, const NodeGraph& graph) {
    rest_ = fit_.residual;
    const Eigen::Index num_free = Eigen::Index(free_.size());
    covariance_of_correction_ = Eigen::MatrixXd::Zero(num_free, num_free);
    if (free_.empty()) {
      return;
    }
    if (!fit_.element_change) {
      // There is nothing to compare the strain of a single element with.
      if (scene.mesh.NumElements() > 1) {
        missed_norm_ = kUnknownErrorShare * observed_.Measured().norm() *
                       DiscretizationError(scene.mesh, estimate_.elasticity,
                                           fit_.displacement);
      }
      return;
    }
    const Eigen::VectorXd& change = *fit_.element_change;
    const Eigen::MatrixXd s = fit_.sensitivities(Eigen::all, free_);
    of_parameters_ = Inverse(sums_.bread(free_, free_)) *
                     (s.transpose() * sums_.weights.cwiseProduct(change));
    const Eigen::VectorXd visible = change - s * of_parameters_;
    if (scene.mesh.Order() == 2) {
      visible_norm_ = visible.norm();
      missed_norm_ = kQuadraticErrorShare * change.norm();
      return;
    }
    const FinerSpecimen finer = Compare(scene, graph, visible);
    rest_ += finer.Mean() * visible;
    correction_ = -finer.Mean() * of_parameters_;
    const double size = std::sqrt(finer.probability) * std::abs(finer.share);
    covariance_of_correction_ =
        (finer.Variance() + std::pow(kUnequalShare * size, 2)) *
        (of_parameters_ * of_parameters_.transpose());
    missed_norm_ = kLinearErrorShare * size * change.norm();
  }

  // Whether there are no more components than the statistics need.
  bool AreTooFew(const Scene& scene) {
    if (scene.load_cases.front().noise_sd ||
        observed_.Size() - Eigen::Index(free_.size()) >=
            kLimits.least_redundancy) {
      return false;
    }
    evidence_.too_few_components = observed_.Size();
    return true;
  }

  void MeasureNoise(const Scene& scene, const NodeGraph& graph) {
    if (losses_.IsLeastSquares()) {
      variance_ =
          EstimateVariance(observed_, scene, rest_.squaredNorm(),
                           Eigen::Index(free_.size()), evidence_, estimate_);
    } else {
      estimate_.noise_sd = RobustStandardDeviation(rest_) * observed_.Norm();
    }
    evidence_.is_explained_by_given_noise =
        variance_ && variance_->is_explained_by_given_noise;
    const SmoothSquareSum smooth = MeasureSmoothPart(
        graph, observed_, sums_.weights.cwiseSqrt().cwiseProduct(rest_),
        estimate_);
    const double least =
        evidence_.is_explained_by_given_noise ? 0 : smooth.least;
    evidence_.smooth_part = std::sqrt(least) / observed_.Measured().norm();
    if (missed_norm_ >= 0) {
      missed_square_sum_ =
          std::min(missed_norm_ * missed_norm_,
                   (visible_norm_ > 0 ? kInSpan : kMostInSpan) * smooth.most);
    }
    if (visible_norm_ > 0) {
      const double share =
          std::min(kQuadraticUnequalShare,
                   std::sqrt(kMostVisible * smooth.most) / visible_norm_);
      covariance_of_correction_ +=
          share * share * of_parameters_ * of_parameters_.transpose();
    }
    smooth_square_sum_ = std::max(0.0, least - missed_square_sum_);
  }

  void FillCovariance() {
    ErrorBudget& budget = estimate_.error_budget;
    budget.noise = ErrorsOf(NoiseCovariance(free_));
    budget.model = ErrorsOf(ModelCovariance(free_));
    const Eigen::MatrixXd of_elements =
        covariance_of_correction_ +
        missed_square_sum_ * Inverse(Gram()(free_, free_));
    EnterDiscretization(ErrorsOf(of_elements));
    Eigen::Matrix2d covariance = Eigen::Matrix2d::Constant(Estimate::kUnknown);
    covariance(free_, free_) = Covariance(free_) + of_elements;
    if (losses_.IsLeastSquares() && !free_.empty()) {
      Eigen::Vector2d change = Eigen::Vector2d::Zero();
      if (HasHeavyTails(rest_)) {
        change(free_) = RobustChange(observed_, rest_,
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

  // The correction of (ln E, nu) for what the elements miss, where it is known.
  std::optional<Eigen::Vector2d> Correction() const {
    if (correction_.size() == 0) {
      return std::nullopt;
    }
    Eigen::Vector2d of_all = Eigen::Vector2d::Zero();
    of_all(free_) = correction_;
    return of_all;
  }

  // Of a row of the residual, by the standard error of nu; empty when there is
  // none.
  std::optional<double> RowVariance() const {
    if (!IsPoissonRatioFree()) {
      return evidence_.active.is_physical_limit && variance_
                 ? std::optional<double>(variance_->variance)
                 : std::nullopt;
    }
    return estimate_.covariance(1, 1) / LastOfInverse(sums_.bread);
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
    const double least = (fit_.residual + s * change).squaredNorm();
    evidence_.bound_excess = {
        square_sum_ - least, least / static_cast<double>(fit_.residual.size()),
        estimate_.elasticity.youngs_modulus * std::exp(change(0))};
    const double standard_error = !options_.known_poisson_ratio && is_collinear_
                                      ? std::numeric_limits<double>::infinity()
                                      : std::sqrt(Covariance(parameters)(0, 0));
    evidence_.youngs_modulus_on_bound = AllowForYoungsModulusOnBound(
        options_, -Gram()(0, 1) / Gram()(1, 1),
        std::sqrt(least / square_sum_) * standard_error, estimate_);
  }

  void MeasurePoissonRatioOnBound() {
    const double standard_error = is_collinear_
                                      ? std::numeric_limits<double>::infinity()
                                      : std::sqrt(Covariance({0, 1})(1, 1));
    evidence_.poisson_ratio_on_bound = AllowForPoissonRatioOnBound(
        options_, evidence_.active, YoungsModulusSlope(), standard_error,
        estimate_);
  }

 private:
  // What the residual says of the part of the change that it would show.
  FinerSpecimen Compare(const Scene& scene, const NodeGraph& graph,
                        const Eigen::VectorXd& visible) {
    const Eigen::VectorXd weighted = sums_.weights.cwiseProduct(visible);
    const double size = weighted.dot(visible);
    const double redundancy =
        static_cast<double>(observed_.Size() - Eigen::Index(free_.size())) - 1;
    if (!(size > 0) || redundancy < 1) {
      return CompareWithFinerSpecimen(0, kUnknownShareError, 1);
    }
    const double share = -weighted.dot(fit_.residual) / size;
    const Eigen::VectorXd rest =
        sums_.weights.cwiseSqrt().cwiseProduct(fit_.residual + share * visible);
    const std::optional<NeighbourCorrelation> neighbours =
        CorrelateNeighbours(graph, observed_, rest);
    const double correlation =
        neighbours ? std::clamp(neighbours->correlation -
                                    kLimits.explained_score *
                                        neighbours->standard_deviation,
                                0.0, kMostCorrelation)
                   : 0;
    // As many rows of a first-order process say as much as independent ones.
    const double dependence = (1 + correlation) / (1 - correlation);
    // Of the sum of the products; a loss makes the rows unequal.
    double variance = size * rest.squaredNorm() / redundancy;
    if (!losses_.IsLeastSquares()) {
      variance =
          weighted.cwiseProduct(fit_.residual + share * visible).squaredNorm();
    } else if (scene.load_cases.front().noise_sd) {
      variance =
          std::max(variance, size / (observed_.Norm() * observed_.Norm()));
    }
    return CompareWithFinerSpecimen(share,
                                    std::sqrt(variance * dependence) / size,
                                    redundancy / dependence);
  }

  void EnterDiscretization(const ParameterErrors& errors) {
    if (!(missed_norm_ >= 0)) {
      return;
    }
    estimate_.discretization_error = errors(0);
    if (IsPoissonRatioFree()) {
      estimate_.poisson_ratio_discretization_error = errors(1);
    }
  }

  const Eigen::Matrix2d& Gram() const { return sums_.sensitivity_gram; }
  // d ln E / d nu of the parameters that fit alike.
  double YoungsModulusSlope() const { return -Gram()(0, 1) / Gram()(0, 0); }
  bool IsPoissonRatioFree() const {
    return !free_.empty() && free_.back() == 1;
  }
  // The entry of nu, of the inverse over the free parameters.
  double LastOfInverse(const Eigen::Matrix2d& matrix) const {
    const Eigen::MatrixXd inverse = Inverse(matrix(free_, free_));
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
  double smooth_square_sum_ = 0;
  /// The residual without what a finer specimen explains of it.
  Eigen::VectorXd rest_;
  /// Of the free parameters.
  Eigen::VectorXd correction_;
  Eigen::MatrixXd covariance_of_correction_;
  /// What the change of the elements does to the free parameters, and how much
  /// of that of quadratic elements the residual would show.
  Eigen::VectorXd of_parameters_;
  double visible_norm_ = 0;
  /// Of the error that the elements leave in the displacements; NaN where it is
  /// not known.
  double missed_norm_ = Estimate::kUnknown;
  double missed_square_sum_ = 0;
};

}  // namespace

void CorrectForElements(const Evidence& evidence, Estimate& estimate) {
  if (!estimate.IsUsable()) {
    return;
  }
  double& nu = estimate.elasticity.poisson_ratio;
  if (estimate.poisson_ratio_interval) {
    // An error of the elements is none of the measurement, of which the profile
    // knows how it acts next to a limit.
    auto& [lower, upper] = *estimate.poisson_ratio_interval;
    const double distance =
        kTwoSidedErrors *
        estimate.poisson_ratio_discretization_error.value_or(0);
    lower = std::max(std::min(lower, nu - distance), -1.0);
    upper = std::min(std::max(upper, nu + distance), 0.5);
  }
  if (!evidence.element_correction) {
    return;
  }
  const double ratio = std::exp((*evidence.element_correction)(0));
  // Half of the way to a limit at most.
  const double change = std::clamp((*evidence.element_correction)(1),
                                   -(1 + nu) / 2, (0.5 - nu) / 2);
  estimate.elasticity.youngs_modulus *= ratio;
  nu += change;
  const Eigen::Vector2d scale(ratio, 1);
  estimate.covariance =
      scale.asDiagonal() * estimate.covariance * scale.asDiagonal();
  if (estimate.poisson_ratio_interval) {
    auto& [lower, upper] = *estimate.poisson_ratio_interval;
    // A limit stays one.
    lower = lower == -1 ? -1 : std::max(lower + change, -1.0);
    upper = upper == 0.5 ? 0.5 : std::min(upper + change, 0.5);
  }
  estimate.discretization_correction = {ratio - 1, change};
}

std::optional<double> DescribeDisplacementFit(
    const Scene& scene, const NodeGraph& graph, const EstimatorOptions& options,
    const ObservedDisplacements& observed, const DisplacementFit& fit,
    const NodeLosses& losses, Evidence& evidence, Estimate& estimate) {
  FitDescription description(options, observed, fit, losses, evidence,
                             estimate);
  if (description.FindFreeDirection()) {
    return std::nullopt;
  }
  if (description.AreTooFew(scene)) {
    return std::nullopt;
  }
  description.MeasureElements(scene, graph);
  description.MeasureNoise(scene, graph);
  description.FillCovariance();
  evidence.element_correction = description.Correction();
  const std::optional<double> variance = description.RowVariance();
  if (evidence.active.youngs_modulus != Side::kNone) {
    description.MeasureYoungsModulusOnBound();
  }
  if (evidence.active.poisson_ratio != Side::kNone) {
    description.MeasurePoissonRatioOnBound();
  }
  return variance;
}

}  // namespace elastimate
