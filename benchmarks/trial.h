#ifndef ELASTIMATE_BENCHMARKS_TRIAL_H_
#define ELASTIMATE_BENCHMARKS_TRIAL_H_

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "benchmarks/table.h"
#include "elastimate/core/laws/elasticity.h"
#include "elastimate/core/scene/scene.h"
#include "elastimate/estimators/interface/estimate.h"

namespace elastimate {

/// An estimate from a measurement of which the truth is known.
struct Trial {
  std::int64_t seed;
  IsotropicElasticity truth;
  /// Covariance of (E, nu) that no unbiased estimator is below.
  Eigen::Matrix2d cramer_rao;
  Estimate estimate;

  /// E / E_true - 1.
  double YoungsModulusError() const;
  /// nu - nu_true.
  double PoissonRatioError() const;
};

/// Whether an estimate is wrong by more than it states: by more than 10 % of E
/// or 0.03 in nu, and by more than three times the standard error; nu must also
/// be outside its interval.  A missing standard error counts as zero.
bool IsWrong(const Trial& trial);

/// What counts as wrong.
inline constexpr double kWrongStandardErrors = 3;
inline constexpr double kWrongYoungsModulus = 0.1;  // Relative.
inline constexpr double kWrongPoissonRatio = 0.03;

/// The columns that all tables of trials have, for the cells of TrialCells.
/// Errors, standard errors and Cramer-Rao bounds (as standard deviations) of E
/// are relative to the true E, those of nu are absolute.
std::vector<std::string> TrialColumns();
std::vector<Value> TrialCells(const Trial& trial);

/// The rung of `auto` that the estimate comes from, as in "reduced-fe order 2";
/// empty for other estimators.
std::string ChosenRung(const Estimate& estimate);

/// For each load case, the standard deviation of noise whose norm over the free
/// components is `deviation` times that of the displacement [length].
Eigen::VectorXd NoiseSd(const Scene& scene, double deviation);

/// The scene with uniform noise of exactly that norm in each load case.  The
/// same seed with another deviation scales the same noise, and the noise of a
/// load case does not depend on those behind it.
Scene WithNoise(Scene scene, double deviation, std::uint64_t seed);

}  // namespace elastimate

#endif  // ELASTIMATE_BENCHMARKS_TRIAL_H_
