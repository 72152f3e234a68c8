#include "elastimate/estimators/misfit/curvature.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <optional>

#include "elastimate/core/algebra/dense_algebra.h"
#include "elastimate/core/algebra/node_sums.h"

namespace elastimate {
namespace {

// Of a parameter, or of the way to the end of its range: below, the misfit is
// nearly quadratic; above, the parameter is not determined anyway.
constexpr double kLeastError = 0.1;
constexpr double kMostError = 2;
constexpr int kMostCombinations = 2;
constexpr double kStandardErrors = 2;
// Of a misfit that rises less the errors are no longer those of a minimum.
constexpr double kLeastRise = 0.01;

// The change of the parameters by the variables, in the units in which the
// misfit is not quadratic.
Eigen::MatrixXd ScaledJacobian(const FreeParameters& free,
                               const Eigen::VectorXd& x) {
  constexpr double kLeastWay = 1e-4;
  Eigen::MatrixXd jacobian = free.RelativeJacobian(x);
  for (Eigen::Index i = 0; i < jacobian.rows(); ++i) {
    const Bounds& bounds = free.VariableBounds()[i];
    const bool is_modulus =
        free.All().All()[free.All().Free()[i]].law_parameter->is_modulus;
    if (!is_modulus && bounds.lower && bounds.upper) {
      jacobian.row(i) /= std::max(
          std::min(x(i) - *bounds.lower, *bounds.upper - x(i)), kLeastWay);
    }
  }
  return jacobian;
}

// As far as the bounds allow.
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

// The least square sum near rows r + S d where a^T d = 0, and d there.
struct Least {
  double square_sum;
  Eigen::VectorXd change;
};

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

Eigen::MatrixXd InformationOf(const Eigen::MatrixXd& sensitivities,
                              const Eigen::VectorXd& beforehand) {
  Eigen::MatrixXd information = InnerProducts(sensitivities, sensitivities);
  information.diagonal() += beforehand;
  return information;
}

// A minimum, and one combination of its variables.
struct Combination {
  const Eigen::VectorXd& x;
  double square_sum;
  Eigen::VectorXd a;
  double variance;  ///< a^T (S^T S)^-1 a, where the noise is 1.
};

// What is found where the combination is moved.
struct Look {
  double rise;  ///< Of the square sum, over that of a quadratic misfit.
  Eigen::VectorXd bend;  ///< Of the others, off the straight line.
};

// Empty where there is no model.
std::optional<Look> LookAt(const Eigen::VectorXd& moved,
                           const Combination& combination,
                           const Eigen::VectorXd& beforehand,
                           DisplacementMisfit& misfit) {
  const double way = combination.a.dot(moved - combination.x);
  Eigen::VectorXd rows;
  Eigen::MatrixXd sensitivities;
  if (way == 0 || !misfit.Evaluate(moved, &rows, &sensitivities)) {
    return std::nullopt;
  }
  const Least least =
      LeastSquareSum(rows, sensitivities,
                     InformationOf(sensitivities, beforehand), combination.a);
  const double rise = least.square_sum - combination.square_sum;
  const double expected = way * way / combination.variance;
  return std::isfinite(rise) && expected > 0
             ? std::optional<Look>(
                   {std::max(rise / expected, kLeastRise), least.change})
             : std::nullopt;
}

}  // namespace

Eigen::MatrixXd CovarianceOfCurvature(const Eigen::VectorXd& x,
                                      const Eigen::MatrixXd& covariance,
                                      const Eigen::MatrixXd& sensitivities,
                                      const Eigen::VectorXd& beforehand,
                                      DisplacementMisfit& misfit) {
  Eigen::MatrixXd added = Eigen::MatrixXd::Zero(x.size(), x.size());
  Eigen::VectorXd rows;
  if (!covariance.allFinite() || !misfit.Evaluate(x, &rows, nullptr)) {
    return added;
  }
  const double square_sum = SquaredNorm(rows);
  const Eigen::MatrixXd inverse =
      Inverse(InformationOf(sensitivities, beforehand));
  const Eigen::MatrixXd jacobian = ScaledJacobian(misfit.Free(), x);
  const SymmetricEigenDecomposition modes =
      DecomposeSymmetric(jacobian * covariance * jacobian.transpose());
  int num_looked_at = 0;
  for (Eigen::Index i = x.size() - 1;
       i >= 0 && num_looked_at < kMostCombinations; --i) {
    const double error = std::sqrt(std::max(modes.values(i), 0.0));
    if (error < kLeastError) {
      break;
    }
    if (error > kMostError) {
      continue;
    }
    ++num_looked_at;
    const Eigen::VectorXd a = jacobian.transpose() * modes.vectors.col(i);
    const Combination combination = {x, square_sum, a, a.dot(inverse * a)};
    const Eigen::VectorXd move = kStandardErrors / error * (covariance * a);
    double rise = 1;
    Eigen::VectorXd bend = Eigen::VectorXd::Zero(x.size());
    for (const double side : {-1.0, 1.0}) {
      const Eigen::VectorXd moved = Moved(misfit.Free(), x, side * move);
      const std::optional<Look> look =
          LookAt(moved, combination, beforehand, misfit);
      if (look) {
        rise = std::min(rise, look->rise);
        bend = bend.cwiseAbs().cwiseMax(look->bend.cwiseAbs());
      }
    }
    const double square = kStandardErrors * kStandardErrors;
    added += (1 / rise - 1) / square * (move * move.transpose());
    added += Eigen::MatrixXd(bend.cwiseAbs2().asDiagonal()) / square;
  }
  return added;
}

}  // namespace elastimate
