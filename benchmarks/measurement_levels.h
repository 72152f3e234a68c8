#ifndef ELASTIMATE_BENCHMARKS_MEASUREMENT_LEVELS_H_
#define ELASTIMATE_BENCHMARKS_MEASUREMENT_LEVELS_H_

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "elastimate/core/laws/elasticity.h"
#include "elastimate/core/scene/scene.h"

namespace elastimate {

/// All measurements of the study are of steel [N, mm].
inline constexpr IsotropicElasticity kMeasuredSteel = {210000, 0.3};

/// The levels of this factor have noise that neighbours share.
inline constexpr char kCorrelationFactor[] = "correlation length [spacings]";

/// A level is one way to measure a plate, and to say how it was measured.
struct MeasurementLevel {
  std::string factor;  ///< What is varied, with its unit.
  std::string level;
  /// The assumption is "right", or tells what the scene says wrongly.
  std::string assumption;
  /// Returns the scene of a seed.
  std::function<Scene(std::uint64_t seed)> measure;
};

/// Returns the levels of a quarter of a plate of 10 x 10 mm with a hole of
/// radius 2.5 mm, 1 mm thick, which is pulled by 1500 N (`generate plate`).
/// Unless the level says otherwise, its ends were measured, the load cell has
/// an error of .5 %, and the noise is 1e-3 mm.  `cells` is that of
/// PlateOptions.
std::vector<MeasurementLevel> MeasurementLevels(int cells);

/// Returns the levels of the factor "noise [um]": the plate of
/// MeasurementLevels with other noise, which the study runs on a finer mesh.
std::vector<MeasurementLevel> NoiseLevels(int cells);

}  // namespace elastimate

#endif  // ELASTIMATE_BENCHMARKS_MEASUREMENT_LEVELS_H_
