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

/// Returns the estimate of each frame.  Frames form groups of up to four.  Each
/// thread (ForBlocks) of each rank estimates whole groups with an estimator
/// that it prepares once, and each frame starts where the one before it in its
/// group ended.  On large meshes, one thread of rank 0 estimates all, and ranks
/// share the solves.  For a frame that cannot be read or used it says why.
/// `scene` is that of the frames, at the given standard deviation of noise, if
/// any.  `progress` is told what is done next.  Throws std::invalid_argument
/// where the estimator does not take such frames and, on rank 0, where another
/// rank has other frames or none.
///
/// While rank 0 is in this function, the other ranks call it as well
/// (WorkApart), with arguments that they have read themselves.  They send rank
/// 0 their estimates, and return none.
std::vector<FrameEstimate> EstimateFrames(
    const Estimator& estimator, const Scene& scene, const FrameSeries& series,
    const EstimatorOptions& options,
    const std::function<void(const std::string&)>& progress);

/// What a command returns instead of an exit code on a rank other than 0, after
/// it has sent its estimates.
constexpr int kFramesSent = -1;
/// Tells rank 0 how many frames this rank has.  Where it cannot estimate them,
/// `why_not` is the reason as a sentence, which rank 0 then throws.
void SendReadiness(std::size_t num_frames, const std::string& why_not);
/// Throws std::invalid_argument on a rank other than 0, for what rank 0 alone
/// may do.
void RefuseOnOtherRanks();

}  // namespace elastimate

#endif  // ELASTIMATE_APPS_SERIES_H_
