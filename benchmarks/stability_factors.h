#ifndef ELASTIMATE_BENCHMARKS_STABILITY_FACTORS_H_
#define ELASTIMATE_BENCHMARKS_STABILITY_FACTORS_H_

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "elastimate/core/laws/elasticity.h"
#include "elastimate/core/scene/scene.h"

namespace elastimate {

/// One level of one factor that makes estimation harder.
struct StabilityLevel {
  std::string factor;
  std::string level;
  IsotropicElasticity truth;
  /// Returns the scene as the estimators see it, which need not be the one that
  /// was measured.
  std::function<Scene(std::uint64_t seed)> measure;
  double noise_sd;  ///< The sd of a measured component [length].
  /// Whether the estimators that have a Huber loss are also run with it.
  bool is_with_huber = false;
  /// Whether the data could show that the estimate is wrong.
  bool is_knowable = true;
};

/// Returns all levels, one factor after another, each from harmless to
/// hopeless.  All but the factor is as in the base scene: a block of 0.5 x 0.4
/// x 0.4 m (400 tetrahedra) held at x = 0, an oblique traction of (200, 0,
/// -100) Pa at the other end, E = 10 kPa, nu = 0.3, uniform noise of deviation
/// 1 %.
std::vector<StabilityLevel> StabilityLevels();

}  // namespace elastimate

#endif  // ELASTIMATE_BENCHMARKS_STABILITY_FACTORS_H_
