#include "elastimate/estimators/statistics/bounded_parameter.h"

#include <algorithm>
#include <cmath>

namespace elastimate {
namespace {

// A parameter this close to a bound lies on it.
constexpr double kOnBound = 1e-9;

// Relative to the cost, the gradient that is more than rounding.
constexpr double kInwardGradient = 1e-6;

}  // namespace

BoundedParameter::BoundedParameter(double value, const Bounds& bounds)
    : value_(value), bounds_(bounds) {
  value_ = std::max(value_, bounds_.lower.value_or(value_));
  value_ = std::min(value_, bounds_.upper.value_or(value_));
}

Side BoundedParameter::OnBound() const {
  if (bounds_.lower && value_ - *bounds_.lower < kOnBound) {
    return Side::kLower;
  }
  if (bounds_.upper && *bounds_.upper - value_ < kOnBound) {
    return Side::kUpper;
  }
  return Side::kNone;
}

void BoundedParameter::Constrain(ceres::Problem& problem) {
  if (bounds_.lower) {
    problem.SetParameterLowerBound(&value_, 0, *bounds_.lower);
  }
  if (bounds_.upper) {
    problem.SetParameterUpperBound(&value_, 0, *bounds_.upper);
  }
}

bool BoundedParameter::Hold(ceres::Problem& problem) {
  if (OnBound() == Side::kNone) {
    return false;
  }
  problem.SetParameterBlockConstant(&value_);
  return true;
}

bool BoundedParameter::Release(ceres::Problem& problem) {
  const Side side = OnBound();
  if (side == Side::kNone) {
    return false;
  }
  problem.SetParameterBlockVariable(&value_);
  ceres::Problem::EvaluateOptions options;
  options.parameter_blocks = {&value_};
  double cost = 0;
  std::vector<double> gradient;
  problem.Evaluate(options, &cost, nullptr, &gradient, nullptr);
  const double inward = side == Side::kLower ? -gradient[0] : gradient[0];
  if (inward > kInwardGradient * cost) {
    return true;
  }
  problem.SetParameterBlockConstant(&value_);
  return false;
}

ceres::Solver::Summary MinimizeWithinBounds(
    const ceres::Solver::Options& options,
    const std::vector<BoundedParameter*>& parameters, ceres::Problem& problem) {
  constexpr int kMaxRounds = 4;
  for (BoundedParameter* parameter : parameters) {
    parameter->Constrain(problem);
  }
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  for (int round = 0; round < kMaxRounds && summary.IsSolutionUsable();
       ++round) {
    std::size_t num_held = 0;
    for (BoundedParameter* parameter : parameters) {
      num_held += parameter->Hold(problem) ? 1 : 0;
    }
    if (num_held == 0) {
      break;
    }
    if (num_held < parameters.size()) {
      ceres::Solve(options, &problem, &summary);
    }
    bool any_released = false;
    for (BoundedParameter* parameter : parameters) {
      any_released |= parameter->Release(problem);
    }
    if (!any_released) {
      break;
    }
    ceres::Solve(options, &problem, &summary);
  }
  return summary;
}

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

}  // namespace elastimate
