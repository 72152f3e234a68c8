#ifndef ELASTIMATE_APPS_FRAME_FIT_H_
#define ELASTIMATE_APPS_FRAME_FIT_H_

#include <Eigen/Core>
#include <string>
#include <vector>

#include "elastimate/estimators/series/joint_estimate.h"

namespace elastimate {

/// The estimate of a frame, and what it leaves of the measurement.
struct FrameFit {
  FrameEstimate frame;
  /// NaN where nothing was measured, or where that was left out; empty where it
  /// is not known.
  Eigen::VectorXd residual = {};
};

/// Returns the fits as bytes, from which FitsOf makes them again, in a process
/// of the same build: all of them, with the same bits.
[[nodiscard]] std::string BytesOf(std::vector<FrameFit> fits);
[[nodiscard]] std::vector<FrameFit> FitsOf(std::string bytes);

}  // namespace elastimate

#endif  // ELASTIMATE_APPS_FRAME_FIT_H_
