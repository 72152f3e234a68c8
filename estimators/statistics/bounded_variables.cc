#include "elastimate/estimators/statistics/bounded_variables.h"

#include <ceres/cost_function.h>
#include <ceres/problem.h>

#include <limits>

#include "elastimate/estimators/interface/finding_sentences.h"
#include "elastimate/estimators/statistics/bounded_parameter.h"

namespace elastimate {
namespace {

// A variable without a bound may change by the logarithm of a million.
constexpr double kLargestChange = 14;

// All residuals, of one block for each variable, so that each may be held.
class VariablesCost : public ceres::CostFunction {
 public:
  VariablesCost(const ResidualFunction& residual, Eigen::Index num_residuals,
                Eigen::Index num_variables)
      : residual_(residual), num_variables_(num_variables) {
    set_num_residuals(static_cast<int>(num_residuals));
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
    Eigen::Map<Eigen::VectorXd>(residuals, r.size()) = r;
    for (Eigen::Index i = 0; jacobians != nullptr && i < num_variables_; ++i) {
      if (jacobians[i] != nullptr) {
        Eigen::Map<Eigen::VectorXd>(jacobians[i], r.size()) = jacobian.col(i);
      }
    }
    return true;
  }

 private:
  const ResidualFunction& residual_;
  Eigen::Index num_variables_;
};

}  // namespace

BoundedMinimum MinimizeOverVariables(const ResidualFunction& residual,
                                     Eigen::Index num_residuals,
                                     const std::vector<Bounds>& bounds,
                                     const Eigen::VectorXd& start,
                                     const ceres::Solver::Options& options) {
  std::vector<BoundedParameter> variables;
  std::vector<double*> blocks;
  std::vector<BoundedParameter*> pointers;
  variables.reserve(bounds.size());
  for (std::size_t i = 0; i < bounds.size(); ++i) {
    const double first = start(Eigen::Index(i));
    variables.emplace_back(
        first, Bounds{bounds[i].lower.value_or(first - kLargestChange),
                      bounds[i].upper.value_or(first + kLargestChange)});
    blocks.push_back(variables.back().Block());
    pointers.push_back(&variables.back());
  }
  ceres::Problem problem;
  problem.AddResidualBlock(
      new VariablesCost(residual, num_residuals, start.size()), nullptr,
      blocks);
  const ceres::Solver::Summary summary =
      MinimizeWithinBounds(options, pointers, problem);
  BoundedMinimum minimum;
  minimum.variables.resize(start.size());
  for (std::size_t i = 0; i < variables.size(); ++i) {
    minimum.variables(Eigen::Index(i)) = variables[i].Value();
    minimum.on_bound.push_back(variables[i].OnBound());
  }
  // Where there is no value at the start, Ceres knows no cost.
  minimum.cost = summary.IsSolutionUsable()
                     ? summary.final_cost
                     : std::numeric_limits<double>::infinity();
  minimum.end = EndOf(summary);
  minimum.message = "Ceres: " + summary.message;
  return minimum;
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
