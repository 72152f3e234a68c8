#ifndef ELASTIMATE_IO_SCENE_FRAME_SERIES_H_
#define ELASTIMATE_IO_SCENE_FRAME_SERIES_H_

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <vector>

#include "elastimate/core/scene/scene.h"
#include "elastimate/estimators/series/joint_estimate.h"

namespace elastimate {

/// Measurements of one specimen, one after another: the key "frames" of a
/// scene.json.  Files are read one by one, when they are asked for.
struct FrameSeries {
  /// One for each frame, in their order.
  std::vector<std::filesystem::path> files;
  /// The factors of the loads of the scene, one for each frame; NaN where the
  /// load record has none, and empty without a record.
  std::vector<double> loads;
  /// The relative error that the loads of all frames have in common, as one
  /// standard deviation.  It is that of the record, else the largest of the
  /// resultants.
  LoadError load_error;
  /// Reads the load case of the scene as frame i measured it, under its loads.
  /// Throws std::invalid_argument, naming the file and the mend.
  std::function<LoadCase(std::size_t i)> read;

  double Load(std::size_t i) const { return loads.empty() ? 1 : loads[i]; }
};

}  // namespace elastimate

#endif  // ELASTIMATE_IO_SCENE_FRAME_SERIES_H_
