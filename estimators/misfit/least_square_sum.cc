#include "elastimate/estimators/misfit/least_square_sum.h"

#include <algorithm>

#include "elastimate/core/algebra/dense_algebra.h"
#include "elastimate/core/algebra/node_sums.h"

namespace elastimate {

Eigen::VectorXd Moved(const FreeParameters& free, const Eigen::VectorXd& x,
                      const Eigen::VectorXd& move) {
  Eigen::VectorXd moved = x + move;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const Bounds& bounds = free.VariableBounds()[i];
    // Behind a bound there is no model, and none on that of nu = 1/2.
    constexpr double kOfTheWay = 0.9;
    if (bounds.lower && moved(i) < *bounds.lower) {
      moved(i) = x(i) + kOfTheWay * (*bounds.lower - x(i));
    }
    if (bounds.upper && moved(i) > *bounds.upper) {
      moved(i) = x(i) + kOfTheWay * (*bounds.upper - x(i));
    }
  }
  return moved;
}

Least LeastSquareSum(const Eigen::VectorXd& rows,
                     const Eigen::MatrixXd& sensitivities,
                     const Eigen::MatrixXd& information,
                     const Eigen::VectorXd& a) {
  const double square_sum = SquaredNorm(rows);
  if (a.size() == 1) {
    return {square_sum, Eigen::VectorXd::Zero(1)};
  }
  const Eigen::MatrixXd others =
      DecomposeSingularValues(a.transpose()).v.rightCols(a.size() - 1);
  const Eigen::VectorXd gradient =
      others.transpose() * InnerProducts(sensitivities, rows);
  const Eigen::VectorXd step =
      -Inverse(others.transpose() * information * others) * gradient;
  // No more than one step is trusted to gain.
  const double gain = -gradient.dot(step);
  return {square_sum - std::clamp(gain, 0.0, square_sum), others * step};
}

}  // namespace elastimate
