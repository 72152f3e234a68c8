#ifndef ELASTIMATE_APPS_SERIES_H_
#define ELASTIMATE_APPS_SERIES_H_

#include <functional>
#include <string>
#include <vector>

#include "elastimate/core/scene/scene.h"
#include "elastimate/estimators/interface/estimator.h"
#include "elastimate/estimators/series/joint_estimate.h"
#include "elastimate/io/scene/frame_series.h"

namespace elastimate {

/// Reads frame `i`, with the standard deviation of --noise_sd if that is given.
/// Throws as FrameSeries::read does.
LoadCase ReadFrame(const FrameSeries& series, std::size_t i);

/// Returns the estimate of each frame.  Each thread estimates consecutive
/// frames with an estimator that it prepares once (ForBlocks); on large meshes
/// one thread estimates all.  For a frame that cannot be read or used it says
/// why. `scene` is that of the frames, at the given standard deviation of
/// noise, if any.  `progress` is told what is done next.  Throws
/// std::invalid_argument where the estimator does not take such frames.
std::vector<FrameEstimate> EstimateFrames(
    const Estimator& estimator, const Scene& scene, const FrameSeries& series,
    const EstimatorOptions& options,
    const std::function<void(const std::string&)>& progress);

}  // namespace elastimate

#endif  // ELASTIMATE_APPS_SERIES_H_
