#include "elastimate/estimators/maps/map_errors.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "elastimate/core/algebra/dense_algebra.h"
#include "elastimate/estimators/maps/random_columns.h"

namespace elastimate {
namespace {

constexpr Eigen::Index kDraws = 64;
// The square of this is the error of a draw in the norm of the posterior,
// relative to the number of its unknowns.
constexpr double kAccurateDraws = 0.1;

// Returns k lambda / (1 + k lambda) of each mode.
Eigen::VectorXd SharesOfModes(const SmoothMap& map) {
  const Eigen::ArrayXd scaled = map.ratio * map.modes.Values().array();
  return scaled / (1 + scaled);
}

// Replaces the density (number over volume) of each element by its mean over
// the element and its neighbours, `num_times` times.
Eigen::VectorXd Smoothed(const FieldPrior& prior, Eigen::VectorXd of_elements,
                         int num_times) {
  for (int i = 0; i < num_times; ++i) {
    Eigen::VectorXd volumes = prior.Volumes();
    Eigen::VectorXd sums = of_elements;
    for (const auto& sides : prior.Facets().elements.colwise()) {
      for (const int side : {0, 1}) {
        if (sides(1) >= 0) {
          volumes(sides(side)) += prior.Volumes()(sides(1 - side));
          sums(sides(side)) += of_elements(sides(1 - side));
        }
      }
    }
    of_elements = prior.Volumes().cwiseProduct(sums.cwiseQuotient(volumes));
  }
  return of_elements;
}

// Returns the diagonal of the part of R that is beside the modes.
Eigen::VectorXd ResolvedBesideModes(const MapProblem& problem,
                                    const FieldPrior& prior,
                                    const SmoothMap& map) {
  constexpr int kNumTimes = 4;
  const FlatUnknowns unknowns(problem, map.state,
                              Eigen::MatrixXd::Ones(prior.NumElements(), 1));
  const ColumnOperator curvature = CurvatureOf(problem, prior, unknowns);
  std::mt19937_64 generator(1);
  const Eigen::MatrixXd signs =
      StandardNormal(prior.NumElements(), kDraws, generator)
          .unaryExpr([](double x) { return x < 0 ? -1.0 : 1.0; });
  const Eigen::MatrixXd y = prior.ApplyInverse(signs);
  ConjugateGradientOptions options;
  options.tolerance = kAccurateDraws;
  const auto modes = map.modes.Vectors();
  const Eigen::MatrixXd beside =
      map.modes.SolveFor(map.ratio, curvature, curvature(y), options) -
      Product(modes,
              SharesOfModes(map).asDiagonal() * ProductOfTransposed(modes, y));
  return Smoothed(prior,
                  signs.cwiseProduct(prior.Apply(beside)).rowwise().mean(),
                  kNumTimes);
}

}  // namespace

MapChanges ChangesOfMap(const MapProblem& problem, const FieldPrior& prior,
                        const SmoothMap& map, const Eigen::MatrixXd& rows,
                        const Eigen::MatrixXd& sources, double tolerance) {
  FieldSensitivity& model = problem.model;
  const FlatUnknowns unknowns(problem, map.state,
                              Eigen::MatrixXd::Ones(prior.NumElements(), 1));
  ConjugateGradientOptions options;
  options.tolerance = tolerance;
  const Eigen::MatrixXd y = map.modes.SolveFor(
      map.ratio, CurvatureOf(problem, prior, unknowns),
      prior.ApplyTransposed(model.MultiplyTransposed(unknowns.Project(rows))) +
          sources,
      options);
  Eigen::MatrixXd fields = prior.Apply(y);
  const Eigen::MatrixXd flat = unknowns.Solve(rows - model.Multiply(fields));
  fields.rowwise() += flat.row(0);
  return {fields, flat.row(1)};
}

MapErrors DescribeMap(const MapProblem& problem, const FieldPrior& prior,
                      const SmoothMap& map) {
  std::mt19937_64 generator(1);
  const double sigma = std::sqrt(map.variance);
  const Eigen::MatrixXd eta = problem.model.Eliminate(
      sigma * StandardNormal(problem.model.NumRows(), kDraws, generator));
  const Eigen::MatrixXd zeta =
      StandardNormal(prior.NumElements(), kDraws, generator);
  const MapChanges draws =
      ChangesOfMap(problem, prior, map, eta,
                   sigma / std::sqrt(map.ratio) * zeta, kAccurateDraws);
  // Where k is that of the greatest evidence, tau^2 = k sigma^2 is |y|^2 /
  // gamma. Where few measurements allow a smaller one only, the field is larger
  // than its prior, and so is what they leave open.
  const double excess =
      std::max(1.0, map.y.squaredNorm() /
                        (map.ratio * map.variance * map.effective_number));
  MapErrors errors;
  errors.log_modulus_sd =
      (excess * draws.log_moduli.rowwise().squaredNorm() / double(kDraws))
          .cwiseSqrt();
  Eigen::Matrix2Xd means(2, kDraws);
  means << prior.Volumes().transpose() * draws.log_moduli /
               prior.Volumes().sum(),
      draws.log_stiffness_ratio;
  errors.covariance_of_means =
      excess * means * means.transpose() / double(kDraws);
  return errors;
}

Eigen::VectorXd ResolutionLengths(const MapProblem& problem,
                                  const FieldPrior& prior,
                                  const SmoothMap& map) {
  Eigen::VectorXd resolved =
      prior.Apply(map.modes.Vectors())
          .cwiseProduct(prior.ApplyInverseTransposed(map.modes.Vectors())) *
      SharesOfModes(map);
  if (!map.modes.HasAll()) {
    resolved += ResolvedBesideModes(problem, prior, map);
  }
  const double root = 1.0 / prior.Dimension();
  Eigen::VectorXd lengths(prior.NumElements());
  for (Eigen::Index e = 0; e < lengths.size(); ++e) {
    const double least = prior.Volumes()(e) / prior.Volumes().sum();
    lengths(e) = std::pow(
        prior.Volumes()(e) / std::clamp(resolved(e), least, 1.0), root);
  }
  return lengths;
}

}  // namespace elastimate
