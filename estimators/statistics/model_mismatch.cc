#include "elastimate/estimators/statistics/model_mismatch.h"

#include <Eigen/LU>
#include <cmath>

#include "elastimate/core/algebra/dense_algebra.h"
#include "elastimate/estimators/interface/limits.h"

namespace elastimate {
std::optional<ModelMismatch> FindModelMismatch(const Estimate& robust,
                                               const Estimate& efficient) {
  if (!robust.elasticity.IsPhysical() || !efficient.elasticity.IsPhysical() ||
      !robust.covariance.allFinite() || !efficient.covariance.allFinite()) {
    return std::nullopt;
  }
  const Eigen::Vector2d scale(1 / efficient.elasticity.youngs_modulus, 1);
  const Eigen::Vector2d difference(
      std::log(robust.elasticity.youngs_modulus /
               efficient.elasticity.youngs_modulus),
      robust.elasticity.poisson_ratio - efficient.elasticity.poisson_ratio);
  const auto in_logarithm = [&scale](const Eigen::Matrix2d& covariance) {
    return Eigen::Matrix2d(scale.asDiagonal() * covariance *
                           scale.asDiagonal());
  };
  Eigen::Matrix2d covariance =
      in_logarithm(robust.covariance - efficient.covariance);
  const Eigen::Matrix2d of_robust = in_logarithm(robust.covariance);
  // A part of the robust covariance that is too small to be told from zero.
  constexpr double kRounding = 1e-3;
  if (!(DecomposeSymmetric(covariance, of_robust).values(0) > kRounding)) {
    covariance = of_robust;
  }
  ModelMismatch mismatch;
  mismatch.statistic = difference.dot(covariance.inverse() * difference);
  mismatch.p_value = std::exp(-mismatch.statistic / 2);
  mismatch.matters =
      std::abs(difference(0)) > kLimits.notable_youngs_modulus_error ||
      std::abs(difference(1)) > kLimits.notable_poisson_ratio_error;
  return mismatch;
}

}  // namespace elastimate
