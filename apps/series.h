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

/// Returns the estimate of each frame.  Each thread (ForBlocks) of each rank
/// estimates consecutive frames with an estimator that it prepares once.  On
/// large meshes, one thread of rank 0 estimates all, and ranks share the
/// solves. For a frame that cannot be read or used it says why. `scene` is that
/// of the frames, at the given standard deviation of noise, if any.  `progress`
/// is told what is done next.  Throws std::invalid_argument where the estimator
/// does not take such frames.
///
/// While rank 0 is in this function, the other ranks call it as well
/// (WorkApart), with arguments that they have read themselves.  They send rank
/// 0 their estimates, and return none.
std::vector<FrameEstimate> EstimateFrames(
    const Estimator& estimator, const Scene& scene, const FrameSeries& series,
    const EstimatorOptions& options,
    const std::function<void(const std::string&)>& progress);

/// What a command returns on another rank, in place of an exit code, once that
/// has sent its estimates.
constexpr int kFramesSent = -1;
/// Tells rank 0 that another rank is about to estimate frames, or in a
/// sentence, which rank 0 then throws, why it cannot.
void SendReadiness(const std::string& why_not);

}  // namespace elastimate

#endif  // ELASTIMATE_APPS_SERIES_H_
