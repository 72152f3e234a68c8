#include "elastimate/estimators/maps/map_mesh_error.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "elastimate/core/laws/elasticity.h"

namespace elastimate {
namespace {

constexpr double kOfMeshChange = 0.5;
constexpr double kOfDisplacementChange = 0.03;
constexpr double kLeastOfRatio = 0.2;
constexpr double kAccurateMeshChange = 1e-2;

// Linear elements may have nu right by accident while E is off.
double CautiousRatioChange(double of_ratio, double of_log_moduli, double nu) {
  return std::copysign(
      std::max(std::abs(of_ratio),
               kLeastOfRatio * of_log_moduli / PoissonRatioSlope(nu)),
      of_ratio);
}

}  // namespace

MapMeshError::MapMeshError(const Scene& linear, SolverKind solver,
                           const MapProblem& problem)
    : problem_(problem), coarse_(linear, solver) {}

Eigen::VectorXd MapMeshError::ChangeOfRows(const MapState& state,
                                           double noise) {
  FieldSensitivity& model = problem_.model;
  const bool is_solved =
      model.MoveTo(state.log_moduli, state.poisson_ratio, noise) &&
      coarse_.MoveTo(state.log_moduli, state.poisson_ratio, noise);
  return is_solved ? Eigen::VectorXd(coarse_.Residual() - model.Residual())
                   : Eigen::VectorXd::Zero(model.NumRows());
}

double MapMeshError::SquareSum(const LevelFit& fit) {
  const Eigen::VectorXd change =
      ChangeOfRows(fit.state, problem_.noise.value_or(0));
  return (kOfMeshChange * fit.unknowns.Project(change)).squaredNorm();
}

Eigen::MatrixXd MapMeshError::CovarianceOf(
    const FieldPrior& prior, const std::vector<int>& part_of_element,
    const LevelFit& fit) {
  const Eigen::Index n = fit.levels.size();
  const double nu = fit.state.poisson_ratio;
  const Eigen::VectorXd change =
      ChangeOfRows(fit.state, problem_.noise.value_or(0));
  const double b = kOfDisplacementChange * std::sqrt(2.0 / double(n + 1));
  Eigen::MatrixXd covariance =
      b * b * change.squaredNorm() * fit.unknowns.InverseGram();
  const std::optional<LevelFit> of_linear =
      FitLevels({coarse_, problem_.known_poisson_ratio, problem_.noise},
                part_of_element, fit.levels, nu);
  if (!of_linear) {
    return covariance;
  }
  Eigen::VectorXd d = Eigen::VectorXd::Zero(n + 1);
  d.head(n) = fit.levels - of_linear->levels;
  if (!problem_.known_poisson_ratio) {
    const double of_level =
        prior.Volumes().dot(Eigen::VectorXd(d(part_of_element)).cwiseAbs()) /
        prior.Volumes().sum();
    d(n) = CautiousRatioChange(
        LogStiffnessRatio(nu) -
            LogStiffnessRatio(of_linear->state.poisson_ratio),
        of_level, nu);
  }
  covariance += kOfMeshChange * kOfMeshChange * d * d.transpose();
  return covariance;
}

MapChanges MapMeshError::ErrorOf(const FieldPrior& prior,
                                 const SmoothMap& map) {
  const Eigen::VectorXd rows = ChangeOfRows(map.state, std::sqrt(map.variance));
  MapChanges change = ChangesOfMap(
      problem_, prior, map, rows, Eigen::MatrixXd::Zero(prior.NumElements(), 1),
      kAccurateMeshChange);
  if (!problem_.known_poisson_ratio) {
    const double of_level =
        std::abs(prior.Volumes().dot(change.log_moduli.col(0))) /
        prior.Volumes().sum();
    change.log_stiffness_ratio(0) = CautiousRatioChange(
        change.log_stiffness_ratio(0), of_level, map.state.poisson_ratio);
  }
  return {kOfMeshChange * change.log_moduli,
          kOfMeshChange * change.log_stiffness_ratio};
}

}  // namespace elastimate
