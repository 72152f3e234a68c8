#include "elastimate/estimators/misfit/across_range.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "elastimate/core/algebra/node_sums.h"
#include "elastimate/estimators/misfit/least_square_sum.h"

namespace elastimate {
namespace {

// The parts of the way to an end of the range of a ratio at which the misfit is
// evaluated.
struct WayOfLooks {
  double way;
  std::array<double, 3> parts;
};

// Returns the ways on which other values may fit as well: to the other end
// where a ratio is close to one, and to both where its error is not small.
std::vector<WayOfLooks> WaysAcrossRange(const FreeParameters& free,
                                        const Eigen::VectorXd& x,
                                        Eigen::Index i, double error) {
  constexpr double kSmall = 0.02;  // Of the range.
  constexpr std::array<double, 3> kFromEnd = {1.0 / 32, 1.0 / 8, 1.0 / 2};
  constexpr std::array<double, 3> kFromInside = {1.0 / 4, 1.0 / 2, 3.0 / 4};
  const Bounds& bounds = free.VariableBounds()[i];
  if (!bounds.lower || !bounds.upper ||
      free.Free(i).law_parameter->is_modulus) {
    return {};
  }
  const double to_lower = *bounds.lower - x(i);
  const double to_upper = *bounds.upper - x(i);
  const double small = kSmall * (*bounds.upper - *bounds.lower);
  if (to_upper < small) {
    return {{to_lower, kFromEnd}};
  }
  if (-to_lower < small) {
    return {{to_upper, kFromEnd}};
  }
  return error < small ? std::vector<WayOfLooks>()
                       : std::vector<WayOfLooks>{{to_lower, kFromInside},
                                                 {to_upper, kFromInside}};
}

// Fits all variables but x(i), and returns the square sum: infinity where it
// stays above `most`, or where the model cannot be solved.
double LeastWithOneHeld(Eigen::Index i, double variance, double most,
                        DisplacementMisfit& misfit, Eigen::VectorXd& x) {
  constexpr int kMostSteps = 4;
  constexpr double kSettledGain = 0.1;  // Of the variance.
  const Eigen::VectorXd held = Eigen::VectorXd::Unit(x.size(), i);
  double best = std::numeric_limits<double>::infinity();
  Eigen::VectorXd next = x;
  for (int step = 0; step < kMostSteps; ++step) {
    Eigen::VectorXd rows;
    Eigen::MatrixXd sensitivities;
    if (!misfit.Evaluate(next, &rows, &sensitivities)) {
      break;
    }
    const double square_sum = SquaredNorm(rows);
    const Least least = LeastSquareSum(
        rows, sensitivities, InnerProducts(sensitivities, sensitivities), held);
    if (!(square_sum < best) || !(least.square_sum < most)) {
      break;
    }
    best = square_sum;
    x = next;
    if (square_sum - least.square_sum < kSettledGain * variance) {
      break;
    }
    next = Moved(misfit.Free(), x, least.change);
  }
  return best;
}

}  // namespace

Eigen::MatrixXd CovarianceAcrossRange(const Eigen::VectorXd& x,
                                      const Eigen::MatrixXd& covariance,
                                      double variance,
                                      const Eigen::VectorXd& minimum,
                                      DisplacementMisfit& misfit) {
  constexpr double kAlike = 9;      // Chi^2.
  constexpr double kHopeless = 25;  // Chi^2.
  Eigen::MatrixXd added = Eigen::MatrixXd::Zero(x.size(), x.size());
  Eigen::VectorXd rows;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const std::vector<WayOfLooks> ways = WaysAcrossRange(
        misfit.Free(), x, i,
        misfit.HasLargeStrains() ? 0 : std::sqrt(covariance(i, i)));
    if (ways.empty() ||
        (rows.size() == 0 && !misfit.Evaluate(minimum, &rows, nullptr))) {
      continue;
    }
    const double least = SquaredNorm(rows);
    double largest = covariance(i, i) + added(i, i);
    for (const auto& [way, parts] : ways) {
      Eigen::VectorXd looked_at = minimum;
      for (const double part : parts) {
        looked_at(i) = x(i) + part * way;
        if (part * part * way * way <= largest) {
          continue;  // It could add nothing.
        }
        const double rise =
            LeastWithOneHeld(i, variance, least + kHopeless * variance, misfit,
                             looked_at) -
            least;
        const Eigen::VectorXd move = looked_at - x;
        const double of_look =
            move(i) * move(i) / std::max(rise / variance, 1.0);
        if (rise < kAlike * variance && of_look > largest) {
          added += (of_look - largest) / (move(i) * move(i)) * move *
                   move.transpose();
          largest = of_look;
        }
      }
    }
  }
  return added;
}

}  // namespace elastimate
