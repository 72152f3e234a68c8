#include "elastimate/estimators/force_balance/virtual_work_check.h"

#include <cmath>

#include "elastimate/core/algebra/dense_algebra.h"
#include "elastimate/estimators/force_balance/virtual_fields.h"
#include "elastimate/estimators/force_balance/virtual_work.h"
#include "elastimate/estimators/interface/limits.h"
#include "elastimate/estimators/interface/parameter_judge.h"

namespace elastimate {
namespace {

// Whether nothing else makes the estimate one that is not usable.
bool WouldBeUsable(Estimate estimate) {
  JudgeParameters(estimate);
  return estimate.IsUsable();
}

// The roots of the diagonal of a covariance of the parameters, in the units of
// the error budget; not numbers for those that are known.
ParameterErrors ErrorsOfParameters(const Eigen::MatrixXd& covariance,
                                   const Estimate& estimate) {
  ParameterErrors errors(covariance.rows());
  for (Eigen::Index i = 0; i < errors.size(); ++i) {
    errors(i) =
        std::sqrt(covariance(i, i)) / estimate.parameters[i].ErrorUnit();
  }
  return errors;
}

bool IsToBeChecked(const Estimate& estimate) {
  return estimate.force_residual.value_or(0) > kLimits.small_force_residual &&
         WouldBeUsable(estimate);
}

// z and D of all load cases below each other, side by side.
Eigen::MatrixXd LargeBalance(const Scene& scene, const FreeParameters& free,
                             const Eigen::VectorXd& variables,
                             const ForceResidual& forces) {
  const VirtualWork work(scene.mesh, scene.supports, /*degree=*/1);
  const Eigen::MatrixXd fields = work.Fields();
  const Eigen::VectorXd moduli = free.ModuliAt(variables);
  const Eigen::MatrixXd directions = free.ModuliJacobian(variables);
  const Eigen::Index num_cases = forces.LargeDisplacements().cols();
  Eigen::MatrixXd balance(fields.cols() * num_cases, 1 + free.Size());
  for (Eigen::Index k = 0; k < num_cases; ++k) {
    Eigen::MatrixXd columns(fields.rows(), moduli.size());
    for (Eigen::Index i = 0; i < moduli.size(); ++i) {
      columns.col(i) = forces.Products()[i].col(k);
    }
    Eigen::MatrixXd residual(fields.rows(), balance.cols());
    residual << columns * moduli - forces.NodalLoads().col(k),
        columns * directions;
    const Eigen::MatrixXd stiffened = forces.Prepared().Dofs().Restrict(
        forces.Prepared().LargeForces()->TangentProducts(
            moduli, forces.LargeDisplacements().col(k), fields));
    balance.middleRows(fields.cols() * k, fields.cols()) =
        TriangularFactor(stiffened)
            .transpose()
            .triangularView<Eigen::Lower>()
            .solve(work.Of(residual));
  }
  return balance;
}

}  // namespace

WorkCheck CheckByLargeVirtualWork(const Scene& scene,
                                  const FreeParameters& free,
                                  const Eigen::VectorXd& variables,
                                  double noise_variance,
                                  const ForceResidual& forces,
                                  Estimate& estimate) {
  if (!IsToBeChecked(estimate)) {
    return WorkCheck::kNotMade;
  }
  const Eigen::MatrixXd balance = LargeBalance(scene, free, variables, forces);
  estimate.work.element_passes += int(forces.LargeDisplacements().cols());
  const auto redundancy = double(balance.rows() - free.Size());
  const auto derivatives = balance.rightCols(free.Size());
  if (!balance.allFinite() || !(redundancy > 0)) {
    return WorkCheck::kNotMade;
  }
  const double square_sum =
      (balance.col(0) -
       derivatives * SolveLeastSquares(derivatives, balance.col(0)))
          .squaredNorm();
  // The stiffness colours the force residual, from which the variance is.
  const double rough_redundancy = forces.NumEquations() / 4;
  const double excess = kLimits.significant_score *
                        std::sqrt(2 / redundancy + 2 / rough_redundancy);
  const bool is_noise =
      square_sum <= redundancy * noise_variance * (1 + excess);
  const Eigen::MatrixXd of_model =
      (is_noise ? 0 : square_sum) *
      Inverse(derivatives.transpose() * derivatives);
  estimate.is_model_in_doubt = !is_noise;
  estimate.error_budget.model = ErrorsOfVariables(free, variables, of_model);
  const Eigen::MatrixXd jacobian = free.ParameterJacobian(variables);
  estimate.parameter_covariance(free.All().Free(), free.All().Free()) +=
      jacobian * of_model * jacobian.transpose();
  return is_noise ? WorkCheck::kIsNoise : WorkCheck::kIsMore;
}

WorkCheck CheckByVirtualWork(const Scene& scene,
                             const EstimatorOptions& options,
                             Estimate& estimate) {
  if (!IsToBeChecked(estimate)) {
    return WorkCheck::kNotMade;
  }
  EstimatorOptions of_degree_one = options;
  of_degree_one.virtual_field_degree = 1;
  const Estimate check = VirtualFields().Run(scene, of_degree_one);
  estimate.work = estimate.work + check.work;
  if (!check.IsUsable()) {
    estimate.is_model_in_doubt = true;
    return WorkCheck::kContradicts;
  }
  ParameterErrors& model = estimate.error_budget.model;
  if (!check.is_model_in_doubt) {
    model = ErrorsOfParameters(0 * check.parameter_covariance, estimate);
    return WorkCheck::kIsNoise;
  }
  estimate.is_model_in_doubt = true;
  estimate.parameter_covariance += check.parameter_covariance;
  model = ErrorsOfParameters(check.parameter_covariance, estimate);
  return WorkCheck::kIsMore;
}

}  // namespace elastimate
