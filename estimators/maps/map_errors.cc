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

MapErrors DescribeMap(const MapProblem& problem, const FieldPrior& prior,
                      const SmoothMap& map) {
  FieldSensitivity& model = problem.model;
  const Eigen::Index n = prior.NumElements();
  const FlatUnknowns unknowns(problem, map.state, Eigen::MatrixXd::Ones(n, 1));
  std::mt19937_64 generator(1);
  const double sigma = std::sqrt(map.variance);
  const Eigen::MatrixXd eta = model.Eliminate(
      sigma * StandardNormal(model.NumRows(), kDraws, generator));
  const Eigen::MatrixXd zeta = StandardNormal(n, kDraws, generator);
  ConjugateGradientOptions options;
  options.tolerance = kAccurateDraws;
  const Eigen::MatrixXd y = map.modes.SolveFor(
      map.ratio,
      [&](const Eigen::MatrixXd& columns) {
        return MultiplyByCurvature(problem, prior, unknowns, columns);
      },
      prior.ApplyTransposed(model.MultiplyTransposed(unknowns.Project(eta))) +
          sigma / std::sqrt(map.ratio) * zeta,
      options);
  Eigen::MatrixXd fields = prior.Apply(y);
  const Eigen::MatrixXd flat = unknowns.Solve(eta - model.Multiply(fields));
  fields.rowwise() += flat.row(0);

  MapErrors errors;
  errors.log_modulus_sd =
      (fields.rowwise().squaredNorm() / double(kDraws)).cwiseSqrt();
  Eigen::Matrix2Xd means(2, kDraws);
  means << prior.Volumes().transpose() * fields / prior.Volumes().sum(),
      flat.row(1);
  errors.covariance_of_means = means * means.transpose() / double(kDraws);
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
