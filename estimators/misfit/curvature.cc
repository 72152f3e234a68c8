#include "elastimate/estimators/misfit/curvature.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <optional>

#include "elastimate/core/algebra/dense_algebra.h"
#include "elastimate/core/algebra/node_sums.h"
#include "elastimate/estimators/misfit/least_square_sum.h"

namespace elastimate {
namespace {

// Below this error of a parameter, or of the way to the end of its range, the
// misfit is nearly quadratic.
constexpr double kLeastError = 0.1;
// Above this error a parameter is not determined anyway.
constexpr double kMostError = 2;
constexpr int kMostCombinations = 2;
constexpr double kStandardErrors = 2;
// One look widens an error by a factor of ten at most.
constexpr double kLeastRise = 0.01;
constexpr int kMostLooks = 5;
// A rise from which the error is taken, over that of two standard errors.
constexpr double kSettled = 0.6;

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

Eigen::MatrixXd InformationMatrix(const Eigen::MatrixXd& sensitivities,
                                  const Eigen::VectorXd& beforehand) {
  Eigen::MatrixXd information = InnerProducts(sensitivities, sensitivities);
  information.diagonal() += beforehand;
  return information;
}

// A minimum, and one combination of its variables.
struct Combination {
  const Eigen::VectorXd& x;
  const Eigen::VectorXd& rows;
  const Eigen::MatrixXd& sensitivities;
  const Eigen::MatrixXd& information;
  Eigen::VectorXd a;
  double variance;    ///< a^T (S^T S)^-1 a, where the noise is 1.
  double square_sum;  ///< The least at the combination as it is.
  /// How the square sum rises with the combination: zero but on a bound, and
  /// where a loss leaves rows whose rounding is large beside the noise.
  double slope;
};

// What is found where the combination is moved.
struct Look {
  double rise;  ///< The square sum rises to this part of a quadratic one.
  Eigen::VectorXd bend;  ///< How far the others are off the linear model.
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
  const Least least = LeastSquareSum(
      rows, sensitivities, InformationMatrix(sensitivities, beforehand),
      combination.a);
  const Least of_linear_model = LeastSquareSum(
      combination.rows + combination.sensitivities * (moved - combination.x),
      combination.sensitivities, combination.information, combination.a);
  const double expected = way * way / combination.variance;
  const double of_known = beforehand.dot((moved - combination.x).cwiseAbs2());
  const auto rise_to = [&](double square_sum) {
    return square_sum - combination.square_sum - combination.slope * way +
           of_known;
  };
  double rise = rise_to(least.square_sum);
  // What a long step of a linear model gains may not be there.
  if (rise < kSettled * expected &&
      misfit.Evaluate(Moved(misfit.Free(), moved, least.change), &rows,
                      nullptr)) {
    rise = std::max(rise, rise_to(SquaredNorm(rows)));
  }
  return std::isfinite(rise) && expected > 0
             ? std::optional<Look>(
                   {rise / expected, least.change - of_linear_model.change})
             : std::nullopt;
}

// The least that the misfit rises at the ends of +- `move`, over what a
// quadratic one would, and the largest bend there.
Look LookAtBothEnds(const Eigen::VectorXd& move, const Combination& combination,
                    const Eigen::VectorXd& beforehand,
                    DisplacementMisfit& misfit) {
  constexpr double kLeastWay = 0.1;
  Look both = {1, Eigen::VectorXd::Zero(move.size())};
  for (const double side : {-1.0, 1.0}) {
    const Eigen::VectorXd moved =
        Moved(misfit.Free(), combination.x, side * move);
    // A bound next to the minimum leaves no room to look at.
    if (combination.a.dot(moved - combination.x) * side <
        kLeastWay * combination.a.dot(move)) {
      continue;
    }
    const std::optional<Look> look =
        LookAt(moved, combination, beforehand, misfit);
    if (look) {
      both.rise = std::min(both.rise, look->rise);
      both.bend = both.bend.cwiseMax(look->bend.cwiseAbs());
    }
  }
  return both;
}

// What is added for one combination, from the ends of two standard errors.
Eigen::MatrixXd CovarianceAlong(const Eigen::VectorXd& move,
                                const Combination& combination,
                                const Eigen::VectorXd& beforehand,
                                DisplacementMisfit& misfit) {
  // Where the misfit rises by less than a minimum with these errors would, as
  // around a dip, only a look from farther away tells of their size.
  Look look = {1, Eigen::VectorXd::Zero(move.size())};
  double moves = 1;
  bool is_settled = false;
  for (int i = 0; i < kMostLooks && !is_settled; ++i) {
    const double last = look.rise;
    look = LookAtBothEnds(moves * move, combination, beforehand, misfit);
    look.rise = std::clamp(look.rise, kLeastRise * last, last);
    is_settled = look.rise * moves * moves > kSettled;
    moves *= std::max(2.0, 1 / (moves * std::sqrt(look.rise)));
  }
  constexpr double kSquare = kStandardErrors * kStandardErrors;
  return (1 / look.rise - 1) / kSquare * move * move.transpose() +
         Eigen::MatrixXd(look.bend.cwiseAbs2().asDiagonal()) / kSquare;
}

// The largest error of a parameter, of which a move has two.
double LargestError(const FreeParameters& free, const Eigen::VectorXd& x,
                    const Eigen::VectorXd& move) {
  return (free.RelativeJacobian(x) * move).cwiseAbs().maxCoeff() /
         kStandardErrors;
}

}  // namespace

Eigen::MatrixXd CovarianceOfCurvature(const Eigen::VectorXd& x,
                                      const Eigen::MatrixXd& covariance,
                                      const Eigen::VectorXd& beforehand,
                                      DisplacementMisfit& misfit) {
  Eigen::MatrixXd added = Eigen::MatrixXd::Zero(x.size(), x.size());
  if (!covariance.allFinite()) {
    return added;
  }
  const Eigen::MatrixXd jacobian = ScaledJacobian(misfit.Free(), x);
  const SymmetricEigenDecomposition modes =
      DecomposeSymmetric(jacobian * covariance * jacobian.transpose());
  Eigen::VectorXd rows;
  Eigen::MatrixXd sensitivities;
  if (!(modes.values.maxCoeff() >= kLeastError * kLeastError) ||
      !misfit.Evaluate(x, &rows, &sensitivities)) {
    return added;
  }
  const Eigen::MatrixXd information =
      InformationMatrix(sensitivities, beforehand);
  const Eigen::MatrixXd inverse = Inverse(information);
  const Eigen::VectorXd newton = inverse * InnerProducts(sensitivities, rows);
  int num_looked_at = 0;
  for (Eigen::Index i = x.size() - 1;
       i >= 0 && num_looked_at < kMostCombinations; --i) {
    const double error = std::sqrt(std::max(modes.values(i), 0.0));
    if (error < kLeastError) {
      break;
    }
    const Eigen::VectorXd a = jacobian.transpose() * modes.vectors.col(i);
    const Eigen::VectorXd move = kStandardErrors / error * (covariance * a);
    if (LargestError(misfit.Free(), x, move) > kMostError) {
      continue;
    }
    ++num_looked_at;
    const double variance = a.dot(inverse * a);
    added += CovarianceAlong(
        move,
        {x, rows, sensitivities, information, a, variance,
         LeastSquareSum(rows, sensitivities, information, a).square_sum,
         2 * a.dot(newton) / variance},
        beforehand, misfit);
  }
  return added;
}

}  // namespace elastimate
