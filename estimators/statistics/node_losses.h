#ifndef ELASTIMATE_ESTIMATORS_STATISTICS_NODE_LOSSES_H_
#define ELASTIMATE_ESTIMATORS_STATISTICS_NODE_LOSSES_H_

#include <ceres/loss_function.h>

#include <Eigen/Core>
#include <array>
#include <memory>

#include "elastimate/estimators/interface/estimator.h"

namespace elastimate {

/// The loss functions of displacement residuals, one for nodes of one, two and
/// three observed components each, so that a bad node counts less as a whole.
class NodeLosses {
 public:
  /// Huber's (k = 1.345) or Cauchy's (c = 2.385) for residuals of this standard
  /// deviation per component; the norm of n of them is sqrt(n) standard
  /// deviations in the mean.
  NodeLosses(Loss loss, double residual_sd);

  bool IsLeastSquares() const { return losses_[0] == nullptr; }

  /// The loss of a node of `count` components; null for least squares.
  ceres::LossFunction* ForCount(int count) const {
    return losses_[count - 1].get();
  }

  /// rho(s) and its first two derivatives at s = `square_sum` of a node.
  std::array<double, 3> Evaluate(int count, double square_sum) const;

 private:
  std::array<std::unique_ptr<ceres::LossFunction>, 3> losses_;
};

/// 1.4826 MAD of the residuals, which is their standard deviation when they
/// are Gaussian, and is not moved by up to half of them.  Precondition: not
/// empty.
double RobustStandardDeviation(const Eigen::VectorXd& residual);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_STATISTICS_NODE_LOSSES_H_
