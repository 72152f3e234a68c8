#include "elastimate/estimators/maps/level_fit.h"

#include <cmath>

namespace elastimate {
namespace {

constexpr int kMostLevelSteps = 30;
constexpr int kMostLevelHalvings = 6;
// A step is the last where it would take less than this from the square sum,
// relative to the square of one row: a hundredth of a standard deviation.
constexpr double kSettledLevels = 1e-4;

}  // namespace

Eigen::MatrixXd PartsOf(const std::vector<int>& part_of_element,
                        Eigen::Index num_parts) {
  Eigen::MatrixXd parts =
      Eigen::MatrixXd::Zero(Eigen::Index(part_of_element.size()), num_parts);
  for (std::size_t e = 0; e < part_of_element.size(); ++e) {
    parts(Eigen::Index(e), part_of_element[e]) = 1;
  }
  return parts;
}

std::optional<LevelFit> FitLevels(const MapProblem& problem,
                                  const std::vector<int>& part_of_element,
                                  const Eigen::VectorXd& levels,
                                  double poisson_ratio, double most) {
  FieldSensitivity& model = problem.model;
  const Eigen::MatrixXd parts = PartsOf(part_of_element, levels.size());
  const double num_rows = double(model.NumIndependentRows());
  Eigen::VectorXd z = levels;
  MapState state = {parts * z, poisson_ratio};
  double noise = problem.noise.value_or(0);
  if (!model.MoveTo(state.log_moduli, state.poisson_ratio, noise)) {
    return std::nullopt;
  }
  for (int i = 0;; ++i) {
    const double square_sum = model.Residual().squaredNorm();
    FlatUnknowns unknowns(problem, state, parts);
    const double gain =
        square_sum - unknowns.Project(model.Residual()).squaredNorm();
    if (i == 0 && square_sum - gain > most) {
      return std::nullopt;
    }
    const Eigen::VectorXd step = unknowns.Solve(model.Residual());
    LevelFit fit = {z, state, square_sum, unknowns};
    if (i == kMostLevelSteps ||
        gain <= kSettledLevels * square_sum / num_rows) {
      return fit;
    }
    const Eigen::Index n = levels.size();
    const double share = TakeStep(
        problem, parts * step.head(n), step(n), noise, kMostLevelHalvings,
        [&](double, const MapState&) {
          return model.Residual().squaredNorm() < square_sum;
        },
        state);
    if (share == 0) {
      return fit;
    }
    z += share * step.head(n);
  }
}

}  // namespace elastimate
