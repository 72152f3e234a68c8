#include "elastimate/estimators/maps/map_problem.h"

#include <algorithm>
#include <cmath>

#include "elastimate/core/algebra/dense_algebra.h"
#include "elastimate/core/laws/elasticity.h"
#include "elastimate/estimators/misfit/displacement_misfit.h"

namespace elastimate {
namespace {

// A column that is so small beside the largest one is rounding.
constexpr double kNothingOfColumns = 1e-9;
constexpr double kMostChangeOfMap = 2;

}  // namespace

double MapProblem::Variance(double square_sum,
                            double degrees_of_freedom) const {
  const double variance =
      noise ? *noise * *noise : square_sum / std::max(degrees_of_freedom, 1.0);
  return std::max(variance, kLeastNoise * kLeastNoise);
}

FlatUnknowns::FlatUnknowns(const MapProblem& problem, const MapState& state,
                           const Eigen::MatrixXd& parts)
    : has_free_ratio_(!problem.known_poisson_ratio) {
  columns_ = problem.model.Multiply(parts);
  if (has_free_ratio_) {
    const double nu = state.poisson_ratio;
    columns_.conservativeResize(Eigen::NoChange, parts.cols() + 1);
    columns_.rightCols(1) =
        problem.model.OfPoissonRatio() * PoissonRatioSlope(nu);
  }
  basis_ = OrthonormalBasis(columns_, kNothingOfColumns);
}

Eigen::MatrixXd FlatUnknowns::Project(const Eigen::MatrixXd& rows) const {
  return rows - basis_ * (basis_.transpose() * rows);
}

Eigen::MatrixXd FlatUnknowns::Solve(const Eigen::MatrixXd& rows) const {
  Eigen::MatrixXd solution =
      SolveLeastSquares(columns_, rows, kNothingOfColumns);
  if (!has_free_ratio_) {
    solution.conservativeResize(solution.rows() + 1, Eigen::NoChange);
    solution.bottomRows(1).setZero();
  }
  return solution;
}

Eigen::MatrixXd FlatUnknowns::InverseGram() const {
  const Eigen::MatrixXd root = Solve(basis_);
  return root * root.transpose();
}

MapState Stepped(const MapState& state, const Eigen::VectorXd& of_log_moduli,
                 double of_log_stiffness_ratio) {
  MapState stepped = {state.log_moduli + of_log_moduli, state.poisson_ratio};
  if (of_log_stiffness_ratio != 0) {
    stepped.poisson_ratio = std::clamp(
        PoissonRatioOfLogStiffnessRatio(LogStiffnessRatio(state.poisson_ratio) +
                                        of_log_stiffness_ratio),
        kSmallestPoissonRatio, kLargestPoissonRatio);
  }
  return stepped;
}

double LargestStep(const Eigen::VectorXd& of_log_moduli,
                   double of_log_stiffness_ratio) {
  return std::min(
      1.0, kMostChangeOfMap / std::max(of_log_moduli.lpNorm<Eigen::Infinity>(),
                                       std::abs(of_log_stiffness_ratio)));
}

double TakeStep(const MapProblem& problem, const Eigen::VectorXd& of_log_moduli,
                double of_log_stiffness_ratio, double noise, int most_attempts,
                const MapImprovement& is_better, MapState& state) {
  FieldSensitivity& model = problem.model;
  double share = LargestStep(of_log_moduli, of_log_stiffness_ratio);
  for (int i = 0; i < most_attempts; ++i) {
    const MapState next =
        Stepped(state, share * of_log_moduli, share * of_log_stiffness_ratio);
    if (model.MoveTo(next.log_moduli, next.poisson_ratio, noise) &&
        is_better(share, next)) {
      state = next;
      return share;
    }
    share /= 2;
  }
  // The model was solved there before.
  static_cast<void>(model.MoveTo(state.log_moduli, state.poisson_ratio, noise));
  return 0;
}

}  // namespace elastimate
