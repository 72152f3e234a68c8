#include "elastimate/core/large_strain/cross_gradient.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace elastimate {
namespace {

// Returns H_33 of the law of small strains, in proportion to the logarithms of
// the stretches.
double FirstGuess(const PointMatrices& gradients, int point, double ratio) {
  const double area =
      (1 + gradients.row[0][point]) * (1 + gradients.row[4][point]) -
      gradients.row[1][point] * gradients.row[3][point];
  return area > 0 ? std::expm1(-ratio * std::log(area)) : 0;
}

// Returns the contraction across a plate over the growth of its area at rest,
// nu / (1 - nu).
double RatioAtRest(const LargeStrainLaw& law, const Eigen::VectorXd& moduli) {
  const Eigen::MatrixXd tangent =
      law.Tangent(moduli, Eigen::Matrix3d::Zero(), SectionModel::kSolid);
  return tangent(kCrossPlace, 0) / tangent(kCrossPlace, kCrossPlace);
}

}  // namespace

void SetCrossGradients(const LargeStrainLaw& law, const Eigen::VectorXd& moduli,
                       int count, PointMatrices& gradients) {
  constexpr int kMostSteps = 50;
  // After a step of this share of the stretch, Newton's method has squared its
  // error, to that of rounding.
  constexpr double kTolerance = 1e-8;
  const double ratio = RatioAtRest(law, moduli);
  for (const int row : {2, 5, 6, 7}) {
    std::fill_n(gradients.row[row], PointMatrices::kPoints, 0.0);
  }
  double* const cross = gradients.row[kCrossPlace];
  std::fill_n(cross, PointMatrices::kPoints, 0.0);
  for (int p = 0; p < count; ++p) {
    cross[p] = FirstGuess(gradients, p, ratio);
  }
  PointMatrices stresses;
  PointTangents tangents;
  const double* const stress = stresses.row[kCrossPlace];
  const double* const slope =
      tangents.row[TangentRow(kCrossPlace, kCrossPlace)];
  for (int step = 0; step < kMostSteps; ++step) {
    law.TangentsAtPoints(moduli, gradients, GradientEntries::kAcross, count,
                         tangents, &stresses);
    bool is_found = true;
    for (int p = 0; p < count; ++p) {
      // Where the slope is negative, the step goes the way of the stress.  The
      // stretch becomes half or twice of what it is at most.
      const double stretch = 1 + cross[p];
      const double change =
          std::clamp(-stress[p] / std::abs(slope[p]), -stretch / 2, stretch);
      cross[p] += change;
      is_found = is_found && std::abs(change) <= kTolerance * stretch;
    }
    if (is_found) {
      return;
    }
  }
  for (int p = 0; p < count; ++p) {
    // Rounding may be all that is left.
    constexpr double kRounding = 1e-9;
    if (!(std::abs(stress[p]) <= kRounding * std::abs(slope[p]))) {
      cross[p] = std::numeric_limits<double>::quiet_NaN();
    }
  }
}

}  // namespace elastimate
