#include "elastimate/estimators/series/trend.h"

#include <algorithm>
#include <cmath>

#include "elastimate/estimators/interface/statistics.h"

namespace elastimate {

std::optional<Trend> FindTrend(const Eigen::VectorXd& x,
                               const Eigen::MatrixXd& values,
                               const Eigen::MatrixXd& variances) {
  constexpr Eigen::Index kFewest = 4;
  constexpr double kSame = 1e-9;
  if (x.size() < kFewest) {
    return std::nullopt;
  }
  const double range = x.maxCoeff() - x.minCoeff();
  if (!(range > kSame * x.cwiseAbs().maxCoeff())) {
    return std::nullopt;
  }
  Trend trend;
  trend.change.resize(values.cols());
  trend.standard_error.resize(values.cols());
  trend.p_value.resize(values.cols());
  for (Eigen::Index j = 0; j < values.cols(); ++j) {
    const Eigen::ArrayXd weights = variances.col(j).cwiseInverse();
    const double middle = (weights * x.array()).sum() / weights.sum();
    const double mean = (weights * values.col(j).array()).sum() / weights.sum();
    const Eigen::ArrayXd arm = x.array() - middle;
    const double inertia = (weights * arm.square()).sum();
    const double slope =
        (weights * arm * values.col(j).array()).sum() / inertia;
    const double scatter =
        (weights * (values.col(j).array() - mean - slope * arm).square())
            .sum() /
        static_cast<double>(x.size() - 2);
    const double error = std::sqrt(std::max(1.0, scatter) / inertia);
    trend.change(j) = range * slope;
    trend.standard_error(j) = range * error;
    trend.p_value(j) = StudentTwoSidedProbability(
        static_cast<double>(x.size() - 2), slope / error);
  }
  return trend;
}

}  // namespace elastimate
