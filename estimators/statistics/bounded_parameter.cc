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

Bounds EffectivePoissonRatioBounds(const EstimatorOptions& options) {
  return {std::max(options.poisson_ratio.lower.value_or(kSmallestPoissonRatio),
                   kSmallestPoissonRatio),
          std::min(options.poisson_ratio.upper.value_or(kLargestPoissonRatio),
                   kLargestPoissonRatio)};
}

BoundedParameter::BoundedParameter(double value, const Bounds& bounds)
    : value_(value), bounds_(bounds) {
  value_ = std::max(value_, bounds_.lower.value_or(value_));
  value_ = std::min(value_, bounds_.upper.value_or(value_));
}

BoundedParameter BoundedParameter::Constant(double value) {
  BoundedParameter parameter(value, Bounds{});
  parameter.is_constant_ = true;
  return parameter;
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
  if (is_constant_) {
    problem.SetParameterBlockConstant(&value_);
    return;
  }
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
    std::size_t num_constant = 0;
    for (BoundedParameter* parameter : parameters) {
      num_held += parameter->Hold(problem) ? 1 : 0;
      num_constant += parameter->IsConstant() ? 1 : 0;
    }
    if (num_held == 0) {
      break;
    }
    if (num_held + num_constant < parameters.size()) {
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

ActiveBounds NoteActiveBounds(const EstimatorOptions& options,
                              Side youngs_modulus,
                              const BoundedParameter& poisson_ratio,
                              Estimate& estimate) {
  ActiveBounds active;
  active.youngs_modulus = youngs_modulus;
  if (youngs_modulus != Side::kNone) {
    const bool lower = youngs_modulus == Side::kLower;
    estimate.active_bounds.emplace_back(lower ? "youngs_min" : "youngs_max");
    estimate.elasticity.youngs_modulus =
        lower ? *options.youngs_modulus.lower : *options.youngs_modulus.upper;
  }
  active.poisson_ratio = poisson_ratio.OnBound();
  if (active.poisson_ratio != Side::kNone) {
    const bool lower = active.poisson_ratio == Side::kLower;
    estimate.active_bounds.emplace_back(lower ? "nu_min" : "nu_max");
    const std::optional<double>& given =
        lower ? options.poisson_ratio.lower : options.poisson_ratio.upper;
    active.is_physical_limit =
        !given || std::abs(*given - poisson_ratio.Value()) > kOnBound;
  }
  return active;
}

}  // namespace elastimate
