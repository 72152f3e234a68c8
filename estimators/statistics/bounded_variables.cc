#include "elastimate/estimators/statistics/bounded_variables.h"

#include <ceres/cost_function.h>
#include <ceres/problem.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "elastimate/core/algebra/dense_algebra.h"
#include "elastimate/estimators/interface/finding_sentences.h"

namespace elastimate {
namespace {

// A variable without a bound may change by the logarithm of a million.
constexpr double kLargestChange = 14;

// What Gauss-Newton steps neglect of the curvature, S = sum_i r_i d2r_i/dx2, by
// the secants of the steps [Dennis, Gay & Welsch, ACM Trans. Math. Softw. 7
// (1981) 348].  Where a wrong model leaves large residuals, Gauss-Newton steps
// overshoot the minimum, and come to it only after dozens of swings, or never.
class NeglectedCurvature {
 public:
  void Update(const Eigen::VectorXd& x, const Eigen::VectorXd& residual,
              const Eigen::MatrixXd& jacobian) {
    const Eigen::VectorXd gradient = jacobian.transpose() * residual;
    if (curvature_.size() == 0) {
      curvature_ = Eigen::MatrixXd::Zero(x.size(), x.size());
    } else if (x != x_) {
      const Eigen::VectorXd step = x - x_;
      const Eigen::VectorXd change =
          gradient - jacobian_.transpose() * residual;
      TakeSecant(step, change, gradient - gradient_);
      is_large_ = step.dot(change) > kLarge * (jacobian * step).squaredNorm();
    }
    x_ = x;
    gradient_ = gradient;
    jacobian_ = jacobian;
  }

  // Returns L with L^T L = S, without directions in which S is negative, where
  // Gauss-Newton steps are too short.  L is zero where S is small, because
  // Gauss-Newton steps converge quickly there, and secants are not accurate.
  Eigen::MatrixXd Root() const {
    if (!is_large_) {
      return Eigen::MatrixXd::Zero(curvature_.rows(), curvature_.cols());
    }
    const SymmetricEigenDecomposition modes = DecomposeSymmetric(curvature_);
    return modes.values.cwiseMax(0).cwiseSqrt().asDiagonal() *
           modes.vectors.transpose();
  }

 private:
  // With S this part of J^T J, each Gauss-Newton step leaves this part of the
  // distance to the minimum.
  static constexpr double kLarge = 0.25;

  // `change` is S times the step, as the Jacobians see it.
  void TakeSecant(const Eigen::VectorXd& step, const Eigen::VectorXd& change,
                  const Eigen::VectorXd& change_of_gradient) {
    const double along = change_of_gradient.dot(step);
    if (!(along > 0)) {
      return;
    }
    // As residuals fall, S does, more quickly than secants tell.
    const double known = std::abs(step.dot(curvature_ * step));
    if (known > 0) {
      curvature_ *= std::min(1.0, std::abs(step.dot(change)) / known);
    }
    const Eigen::VectorXd rest = change - curvature_ * step;
    const Eigen::VectorXd y = change_of_gradient / along;
    curvature_ += rest * y.transpose() + y * rest.transpose() -
                  rest.dot(step) * y * y.transpose();
  }

  Eigen::VectorXd x_;
  Eigen::VectorXd gradient_;
  Eigen::MatrixXd jacobian_;
  Eigen::MatrixXd curvature_;
  bool is_large_ = false;
};

// All residuals, of one block for each variable, so that each may be held.
// Residuals that are always zero follow, whose Jacobian adds the neglected
// curvature to that of Gauss-Newton steps.
class VariablesCost : public ceres::CostFunction {
 public:
  VariablesCost(const ResidualFunction& residual, Eigen::Index num_residuals,
                Eigen::Index num_variables)
      : residual_(residual), num_variables_(num_variables) {
    set_num_residuals(static_cast<int>(num_residuals + num_variables));
    mutable_parameter_block_sizes()->assign(num_variables, 1);
  }

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    Eigen::VectorXd x(num_variables_);
    for (Eigen::Index i = 0; i < num_variables_; ++i) {
      x(i) = *parameters[i];
    }
    Eigen::VectorXd r;
    Eigen::MatrixXd jacobian;
    if (!residual_(x, &r, jacobians == nullptr ? nullptr : &jacobian)) {
      return false;
    }
    Eigen::Map<Eigen::VectorXd>(residuals, num_residuals()) << r,
        Eigen::VectorXd::Zero(num_variables_);
    last_ = x;
    cost_of_last_ = r.squaredNorm() / 2;
    if (jacobians == nullptr) {
      return true;
    }
    neglected_.Update(x, r, jacobian);
    const Eigen::MatrixXd root = neglected_.Root();
    for (Eigen::Index i = 0; i < num_variables_; ++i) {
      if (jacobians[i] != nullptr) {
        Eigen::Map<Eigen::VectorXd>(jacobians[i], num_residuals())
            << jacobian.col(i),
            root.col(i);
      }
    }
    return true;
  }

  // Return the variables whose residuals were found last, and their cost.
  const Eigen::VectorXd& Last() const { return last_; }
  double CostOfLast() const { return cost_of_last_; }

 private:
  const ResidualFunction& residual_;
  Eigen::Index num_variables_;
  mutable NeglectedCurvature neglected_;
  mutable Eigen::VectorXd last_;
  mutable double cost_of_last_ = std::numeric_limits<double>::infinity();
};

End EndOf(const ceres::Solver::Summary& summary) {
  switch (summary.termination_type) {
    case ceres::CONVERGENCE:
      return End::kDone;
    case ceres::NO_CONVERGENCE:
      return End::kIterationLimit;
    default:
      return End::kSearchFailed;
  }
}

// The projected steps of a trust region method stall on a bound, since they
// take the step of the other variables from the unbounded problem.  So
// variables that reach a bound are held there while the others converge, and
// released again when the gradient points into the interior.
class BoundedSearch {
 public:
  BoundedSearch(const ResidualFunction& residual, Eigen::Index num_residuals,
                const std::vector<Bounds>& bounds, const Eigen::VectorXd& start)
      : lower_(start.size()), upper_(start.size()), x_(start) {
    std::vector<double*> blocks;
    for (Eigen::Index i = 0; i < x_.size(); ++i) {
      lower_(i) = bounds[i].lower.value_or(start(i) - kLargestChange);
      upper_(i) = bounds[i].upper.value_or(start(i) + kLargestChange);
      x_(i) = std::min(std::max(x_(i), lower_(i)), upper_(i));
      blocks.push_back(&x_(i));
    }
    cost_ = new VariablesCost(residual, num_residuals, x_.size());
    problem_.AddResidualBlock(cost_, nullptr, blocks);
    for (Eigen::Index i = 0; i < x_.size(); ++i) {
      problem_.SetParameterLowerBound(&x_(i), 0, lower_(i));
      problem_.SetParameterUpperBound(&x_(i), 0, upper_(i));
    }
  }

  BoundedMinimum Minimize(const ceres::Solver::Options& options) {
    constexpr int kMaxRounds = 4;
    Solve(options);
    for (int round = 0; round < kMaxRounds && summary_.IsSolutionUsable();
         ++round) {
      const Eigen::Index num_held = HoldOnBounds();
      if (num_held == 0) {
        break;
      }
      if (num_held < x_.size()) {
        Solve(options);
      }
      if (!ReleaseInwards()) {
        break;
      }
      Solve(options);
    }
    BoundedMinimum minimum;
    minimum.cost = least_cost_;
    minimum.variables = x_;
    for (Eigen::Index i = 0; i < x_.size(); ++i) {
      minimum.on_bound.push_back(SideOf(i));
    }
    minimum.end = EndOf(summary_);
    minimum.message = "Ceres: " + summary_.message;
    return minimum;
  }

 private:
  void Solve(const ceres::Solver::Options& options) {
    ceres::Solve(options, &problem_, &summary_);
    // Where there is no value at the start, Ceres knows no cost.
    least_cost_ = summary_.IsSolutionUsable()
                      ? summary_.final_cost
                      : std::numeric_limits<double>::infinity();
    // Ceres evaluates a step that changes the cost by less than its tolerance,
    // and ends without taking it.
    if (summary_.termination_type == ceres::CONVERGENCE &&
        cost_->CostOfLast() <= (1 + options.function_tolerance) * least_cost_) {
      x_ = cost_->Last();
      least_cost_ = cost_->CostOfLast();
    }
  }

  Side SideOf(Eigen::Index i) const {
    // A variable this close to a bound lies on it.
    constexpr double kOnBound = 1e-9;
    if (x_(i) - lower_(i) < kOnBound) {
      return Side::kLower;
    }
    return upper_(i) - x_(i) < kOnBound ? Side::kUpper : Side::kNone;
  }

  // Holds the variables that lie on a bound, and says how many these are.
  Eigen::Index HoldOnBounds() {
    Eigen::Index num_held = 0;
    for (Eigen::Index i = 0; i < x_.size(); ++i) {
      if (SideOf(i) != Side::kNone) {
        problem_.SetParameterBlockConstant(&x_(i));
        ++num_held;
      }
    }
    return num_held;
  }

  // Releases the variables on a bound from which the cost falls towards the
  // interior, and says whether there are any.
  bool ReleaseInwards() {
    bool is_any_released = false;
    for (Eigen::Index i = 0; i < x_.size(); ++i) {
      const Side side = SideOf(i);
      if (side == Side::kNone) {
        continue;
      }
      problem_.SetParameterBlockVariable(&x_(i));
      if (FallsInwards(side, &x_(i))) {
        is_any_released = true;
      } else {
        problem_.SetParameterBlockConstant(&x_(i));
      }
    }
    return is_any_released;
  }

  bool FallsInwards(Side side, double* block) {
    // Relative to the cost, a smaller gradient is rounding.
    constexpr double kInwardGradient = 1e-6;
    ceres::Problem::EvaluateOptions options;
    options.parameter_blocks = {block};
    double cost = 0;
    std::vector<double> gradient;
    problem_.Evaluate(options, &cost, nullptr, &gradient, nullptr);
    const double inward = side == Side::kLower ? -gradient[0] : gradient[0];
    return inward > kInwardGradient * cost;
  }

  Eigen::VectorXd lower_;
  Eigen::VectorXd upper_;
  Eigen::VectorXd x_;
  VariablesCost* cost_ = nullptr;  ///< The problem owns it.
  ceres::Problem problem_;
  ceres::Solver::Summary summary_;
  double least_cost_ = std::numeric_limits<double>::infinity();
};

}  // namespace

BoundedMinimum MinimizeOverVariables(const ResidualFunction& residual,
                                     Eigen::Index num_residuals,
                                     const std::vector<Bounds>& bounds,
                                     const Eigen::VectorXd& start,
                                     const ceres::Solver::Options& options) {
  return BoundedSearch(residual, num_residuals, bounds, start)
      .Minimize(options);
}

void NoteVariablesOnBounds(const FreeParameters& free,
                           const BoundedMinimum& minimum, Evidence& evidence,
                           Estimate& estimate) {
  // How near its range ends.
  constexpr double kNearLimit = 1e-8;
  std::vector<std::string> names;
  for (Eigen::Index i = 0; i < free.Size(); ++i) {
    if (minimum.on_bound[i] != Side::kNone) {
      const ParameterEstimate& parameter =
          estimate.parameters[free.All().Free()[i]];
      names.push_back(parameter.Label());
      estimate.active_bounds.push_back(
          NameOfBound(parameter, minimum.on_bound[i] == Side::kLower));
      if (parameter.name == "poisson_ratio" &&
          (parameter.value < kSmallestPoissonRatio + kNearLimit ||
           parameter.value > kLargestPoissonRatio - kNearLimit)) {
        evidence.ratios_at_limit.push_back(parameter.Label());
        evidence.is_a_ratio_at_minus_one |= minimum.on_bound[i] == Side::kLower;
      }
    }
  }
  if (!names.empty()) {
    estimate.Add(ParametersOnBounds(names));
  }
}

}  // namespace elastimate
