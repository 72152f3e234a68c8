#ifndef ELASTIMATE_ESTIMATORS_REDUCED_MODEL_COMPLIANCE_NORM_H_
#define ELASTIMATE_ESTIMATORS_REDUCED_MODEL_COMPLIANCE_NORM_H_

#include <Eigen/Core>

#include "elastimate/core/solvers/stiffness_solver.h"

namespace elastimate {

/// c with ||D x|| <= c ||x||_A for every displacement x, where ||x||_A^2 = x^T
/// A x, A is what the solver has factorised, and D has the non-negative
/// `weights` (3 num_nodes) on its diagonal: c^2 is the largest eigenvalue of D
/// A^-1 D.
///
/// Lanczos' method from a random start finds it from below; the result is
/// larger by what that may lack with a probability of 1e-3 over all starts,
/// whatever the spectrum is [Kuczynski & Wozniakowski 1992, theorem 4.2].
/// Deterministic.  Infinite when a solve failed.
///
/// Precondition: the last Factorize returned true.  Cost: kComplianceSteps
/// solves.
double ComplianceNorm(const Eigen::VectorXd& weights, StiffnessSolver& solver);

/// Solves of ComplianceNorm.
constexpr int kComplianceSteps = 10;

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_REDUCED_MODEL_COMPLIANCE_NORM_H_
