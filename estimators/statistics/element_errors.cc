#include "elastimate/estimators/statistics/element_errors.h"

#include <algorithm>
#include <cmath>

#include "elastimate/core/algebra/dense_algebra.h"
#include "elastimate/core/algebra/node_sums.h"
#include "elastimate/core/mechanics/strain_energy.h"
#include "elastimate/estimators/interface/limits.h"
#include "elastimate/estimators/statistics/residual_statistics.h"

namespace elastimate {
namespace {

// Where it is not known, what they miss as a share of the share of the energy
// that is missed [benchmarks: unseen].
constexpr double kUnknownErrorShare = 0.3;
// How much more of an error than of the residual that it leaves the parameters
// may take up, squared.
constexpr double kMostInSpan = 100;
// The same of another model error, which moves all displacements rather than
// bends them [benchmarks: stability, inclusions].
constexpr double kModelErrorInSpan = 16;
// Of what finer elements explain, that they leave [benchmarks: unseen].
constexpr double kMostLeft = 1.0 / 3;
constexpr double kUnknownShareError = 1e3;

// What neighbours share of a rest of this square sum: as far as it is above a
// third of what finer elements explain, all of it from once that on.
double UnexplainedShare(const std::optional<NeighbourCorrelation>& neighbours,
                        double rest, double explained) {
  const double significant =
      neighbours ? neighbours->correlation - kLimits.significant_score *
                                                 neighbours->standard_deviation
                 : 0;
  const double left = significant * rest;
  if (left <= kMostLeft * explained) {
    return 0;
  }
  return std::min(1.0, (left / explained - kMostLeft) / (1 - kMostLeft));
}

// What rows show beside the parameters that take them up.
Eigen::VectorXd VisibleOf(const FreeFit& fit, const Eigen::VectorXd& rows,
                          const Eigen::VectorXd& of_parameters) {
  return rows - fit.sensitivities * of_parameters;
}

Eigen::VectorXd ParametersOf(const FreeFit& fit, const Eigen::VectorXd& rows) {
  return Inverse(fit.information) *
         InnerProducts(fit.sensitivities, fit.weights.cwiseProduct(rows));
}

double WeightedSquareSum(const FreeFit& fit, const Eigen::VectorXd& rows) {
  return InnerProduct(fit.weights.cwiseProduct(rows), rows);
}

// The weighted square sum of what noise of a variance of 1 adds to what shows
// of a change.
double VisibleNoise(const FreeFit& fit, const Eigen::VectorXd& by_noise) {
  if (by_noise.size() == 0) {
    return 0;
  }
  return WeightedSquareSum(
      fit, VisibleOf(fit, by_noise, ParametersOf(fit, by_noise)));
}

}  // namespace

ElementErrors::ElementErrors(const Scene& scene, const NodeGraph& graph,
                             const ObservedDisplacements& observed,
                             const FreeFit& fit,
                             const std::optional<RowChange>& change,
                             const Eigen::MatrixXd& displacement,
                             const IsotropicElasticity& elasticity)
    : prior_(PriorOfSpecimen(scene.mesh.Order())),
      rest_(fit.residual),
      of_measurement_(fit.residual),
      of_parameters_(Eigen::VectorXd::Zero(fit.sensitivities.cols())) {
  if (!change) {
    // There is nothing to compare the strain of a single element with.
    if (scene.mesh.NumElements() > 1) {
      missed_norm_ = kUnknownErrorShare * Norm(observed.Measured()) *
                     DiscretizationError(scene.mesh, elasticity, displacement);
    }
    return;
  }
  const Eigen::VectorXd& rows = change->rows;
  of_parameters_ = ParametersOf(fit, rows);
  const Eigen::VectorXd visible = VisibleOf(fit, rows, of_parameters_);
  Eigen::VectorXd of_taken = Eigen::VectorXd::Zero(of_parameters_.size());
  if (change->taken.size() > 0) {
    of_taken = ParametersOf(fit, change->taken);
    rest_ -= VisibleOf(fit, change->taken, of_taken);
  }
  of_measurement_ = rest_;
  // Finer elements that others are cut into change what those of their own
  // kind would not, which decides where the others are very coarse and E alone
  // takes up nearly all that finer ones change.
  const bool is_unlike = !IsSimplex(scene.mesh.kind) &&
                         of_parameters_.size() == 1 &&
                         std::abs(of_parameters_(0)) > kLimits.unusable_error;
  const FinerSpecimen finer = Compare(
      graph, observed, fit, visible, VisibleNoise(fit, change->by_noise),
      is_unlike ? prior_.missed * std::sqrt(WeightedSquareSum(fit, rows)) : 0);
  share_ = finer.Mean();
  rest_ += share_ * visible;
  correction_ = of_taken - share_ * of_parameters_;
  const double size = std::sqrt(finer.probability) * std::abs(finer.share);
  // Much of a change may be there of which little shows.
  const double most =
      std::max(size, finer.probability * finer.probability * prior_.share);
  // A share other than is expected says that it is another change.
  const double unequal = std::hypot(
      prior_.unequal, is_unlike ? finer.share / prior_.share - 1 : 0);
  share_variance_ = finer.Variance() + std::pow(unequal * most, 2) +
                    hidden_share_ * hidden_share_;
  missed_norm_ = prior_.missed * size * Norm(rows);
  likely_change_ = -std::max(share_, hidden_share_) * of_parameters_;
}

double ElementErrors::ModelSquareSum(double smooth) const {
  return (1 + (kModelErrorInSpan - 1) * unexplained_) * smooth;
}

double ElementErrors::MissedSquareSum(double smooth) const {
  if (!missed_norm_) {
    return 0;
  }
  return std::min(*missed_norm_ * *missed_norm_, kMostInSpan * smooth);
}

Eigen::MatrixXd ElementErrors::CovarianceOfChange() const {
  return share_variance_ * (of_parameters_ * of_parameters_.transpose());
}

FinerSpecimen ElementErrors::Compare(const NodeGraph& graph,
                                     const ObservedDisplacements& observed,
                                     const FreeFit& fit,
                                     const Eigen::VectorXd& visible,
                                     double visible_noise, double missed_size) {
  const Eigen::VectorXd weighted = fit.weights.cwiseProduct(visible);
  const double noisy_size = InnerProduct(weighted, visible);
  const double redundancy =
      static_cast<double>(observed.Size() - fit.sensitivities.cols()) - 1;
  const double product = InnerProduct(weighted, of_measurement_);
  // The variance of a row where the residual shows as much as it can.
  const double least_variance = (WeightedSquareSum(fit, of_measurement_) -
                                 product * product / noisy_size) /
                                redundancy;
  const double size = noisy_size - visible_noise * least_variance;
  if (!(size > 0) || redundancy < 1) {
    return CompareWithFinerSpecimen(0, kUnknownShareError, 1, 0, prior_);
  }
  const double share = -product / size;
  const Eigen::VectorXd rest = of_measurement_ + share * visible;
  const Eigen::VectorXd weighted_rest =
      fit.weights.cwiseSqrt().cwiseProduct(rest);
  const std::optional<NeighbourCorrelation> neighbours =
      CorrelateNeighbours(graph, observed, weighted_rest);
  const double dependence =
      neighbours
          ? RowsForOne(neighbours->correlation -
                       kLimits.explained_score * neighbours->standard_deviation)
          : 1;
  // Of the sum of the products; a loss makes the rows unequal.
  double variance = noisy_size * SquaredNorm(weighted_rest) / redundancy;
  if (!fit.is_least_squares) {
    variance = SquaredNorm(weighted.cwiseProduct(rest));
  } else if (observed.GivenNoise()) {
    variance =
        std::max(variance, noisy_size / (observed.Norm() * observed.Norm()));
  }
  FinerSpecimen finer = CompareWithFinerSpecimen(
      share, std::sqrt(variance * dependence) / size, redundancy / dependence,
      missed_size / std::sqrt(noisy_size), prior_);
  unexplained_ = UnexplainedShare(neighbours, SquaredNorm(weighted_rest),
                                  share * share * size);
  finer.probability *= 1 - unexplained_;
  if (!fit.is_on_bound) {
    hidden_share_ =
        unexplained_ *
        std::min(prior_.share, std::sqrt(SquaredNorm(weighted_rest) / size));
  }
  return finer;
}

}  // namespace elastimate
