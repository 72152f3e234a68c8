#include "elastimate/estimators/maps/map_errors.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "elastimate/core/solvers/conjugate_gradients.h"
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
  const Eigen::MatrixXd y =
      SolveByConjugateGradients(
          [&](const Eigen::MatrixXd& columns) {
            return Eigen::MatrixXd(
                columns / map.ratio +
                MultiplyByCurvature(problem, prior, unknowns, columns));
          },
          [&](const Eigen::MatrixXd& columns) {
            return map.modes.Solve(map.ratio, columns);
          },
          prior.ApplyTransposed(
              model.MultiplyTransposed(unknowns.Project(eta))) +
              sigma / std::sqrt(map.ratio) * zeta,
          {}, options)
          .solution;
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
  const Eigen::VectorXd share = map.ratio * map.modes.Values().array() /
                                (1 + map.ratio * map.modes.Values().array());
  const Eigen::VectorXd resolved =
      prior.Apply(map.modes.Vectors())
          .cwiseProduct(prior.ApplyInverseTransposed(map.modes.Vectors())) *
      share;
  const double root = 1.0 / prior.Dimension();
  errors.resolution_length.resize(n);
  for (Eigen::Index e = 0; e < n; ++e) {
    const double least = prior.Volumes()(e) / prior.Volumes().sum();
    errors.resolution_length(e) = std::pow(
        prior.Volumes()(e) / std::clamp(resolved(e), least, 1.0), root);
  }
  return errors;
}

}  // namespace elastimate
