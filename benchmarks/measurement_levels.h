#ifndef ELASTIMATE_BENCHMARKS_MEASUREMENT_LEVELS_H_
#define ELASTIMATE_BENCHMARKS_MEASUREMENT_LEVELS_H_

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "elastimate/core/materials/elasticity.h"
#include "elastimate/core/scene/scene.h"

namespace elastimate {

/// What all measurements of the study are of: steel [N, mm].
inline constexpr IsotropicElasticity kMeasuredSteel = {210000, 0.3};

/// The factor of levels whose noise is alike at neighbours.
inline constexpr char kCorrelationFactor[] = "correlation length [spacings]";

/// One way to measure a plate, and to say how it was measured.
struct MeasurementLevel {
  std::string factor;  ///< What is varied, with its unit.
  std::string level;
  /// Whether the scene says what was done, or which wrong thing it says.
  std::string assumption;
  /// The scene of a seed.
  std::function<Scene(std::uint64_t seed)> measure;
};

/// A quarter of a plate of 10 x 10 mm with a hole of radius 2.5 mm, 1 mm
/// thick, pulled by 1500 N (`generate plate`): ends that were measured and a
/// load cell of .5 %, noise of 1e-3 mm, unless the level says otherwise.
/// `cells` is that of PlateOptions.
std::vector<MeasurementLevel> MeasurementLevels(int cells);

/// Makes the levels of the factor "noise [um]", each on a mesh of its own.
std::vector<MeasurementLevel> NoiseLevels(int cells);

}  // namespace elastimate

#endif  // ELASTIMATE_BENCHMARKS_MEASUREMENT_LEVELS_H_
