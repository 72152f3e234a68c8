#ifndef ELASTIMATE_ESTIMATORS_PLAN_EXPECTED_ERRORS_H_
#define ELASTIMATE_ESTIMATORS_PLAN_EXPECTED_ERRORS_H_

#include <Eigen/Core>

#include "elastimate/core/algebra/eigen_abi.h"

namespace elastimate {

/// What an information leaves uncertain: the directions d of the parameters, of
/// norm 1, which are independent of each other, and their standard errors,
///
///   I = sum of d d^T / s^2,   s infinite where I is singular.
///
/// No standard error is made of the directions that are determined alone (a
/// pseudo-inverse) where one that is not takes part.
struct ExpectedErrors {
  Eigen::VectorXd standard_errors;  ///< s, the largest first.
  Eigen::MatrixXd directions;       ///< d as columns.

  /// Takes a positive semidefinite information, num_parameters x
  /// num_parameters.
  /// An eigenvalue below 1e-13 of the largest comes from rounding.
  static ExpectedErrors Of(const Eigen::MatrixXd& information);

  /// How many standard errors are infinite.
  Eigen::Index NumUndetermined() const;

  /// The standard error of a combination c of the parameters,
  /// (c^T I^-1 c)^(1/2); infinite where more than a millionth of c is along
  /// directions that are not determined.
  double Along(const Eigen::VectorXd& combination) const;

  /// Along each parameter by itself.
  Eigen::VectorXd OfParameters() const;

  /// Whether fewer directions are undetermined than with the others or, where
  /// these are as many, the largest finite standard error is smaller, by more
  /// than a millionth, so that no order hangs on rounding.
  bool AreSmallerThan(const ExpectedErrors& others) const;
};

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_PLAN_EXPECTED_ERRORS_H_
