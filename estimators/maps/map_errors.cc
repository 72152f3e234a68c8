#include "elastimate/estimators/maps/map_errors.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "elastimate/estimators/maps/random_columns.h"

namespace elastimate {
namespace {

constexpr Eigen::Index kDraws = 64;
// The square of this is the error of a draw in the norm of the posterior,
// relative to the number of its unknowns.
constexpr double kAccurateDraws = 0.1;

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
      map.ratio,
      [&](const Eigen::MatrixXd& columns) {
        return MultiplyByCurvature(problem, prior, unknowns, columns);
      },
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

Eigen::VectorXd ResolutionLengths(const FieldPrior& prior,
                                  const SmoothMap& map) {
  const Eigen::VectorXd share = map.ratio * map.modes.Values().array() /
                                (1 + map.ratio * map.modes.Values().array());
  const Eigen::VectorXd resolved =
      prior.Apply(map.modes.Vectors())
          .cwiseProduct(prior.ApplyInverseTransposed(map.modes.Vectors())) *
      share;
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
