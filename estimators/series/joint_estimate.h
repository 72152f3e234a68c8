#ifndef ELASTIMATE_ESTIMATORS_SERIES_JOINT_ESTIMATE_H_
#define ELASTIMATE_ESTIMATORS_SERIES_JOINT_ESTIMATE_H_

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "elastimate/core/scene/scene.h"
#include "elastimate/estimators/interface/estimate.h"
#include "elastimate/estimators/interface/estimator.h"

namespace elastimate {

/// One frame of a series: a specimen that was measured again and again, under
/// loads that are multiples of those of its scene.
struct FrameEstimate {
  double load = 1;    ///< By which the loads were multiplied.
  Estimate estimate;  ///< Of the frame alone.
  /// The correlation of its residual with that of the frame before it, over as
  /// many components; empty where it is not known.
  std::optional<double> likeness = {};
  Eigen::Index num_alike = 0;
};

/// A relative standard deviation that the loads of all frames have in common.
struct LoadError {
  double relative = 0;
  /// Whether each frame has it in its errors, as that of its resultants.
  bool is_in_frames = false;
};

/// What all frames say together.  Of those that are usable, with a finite
/// covariance C_i of y = (ln of moduli, ratios), the mean is that of least
/// variance,
///
///   y = sum of A_i y_i,   A_i = (sum of C_j^-1)^-1 C_i^-1.
///
/// Of each C_i the share s_i that is noise (the smallest of its parameters', by
/// the error budget) differs from frame to frame, but for the correlation of
/// the residuals of one frame and the next; what the model, the elements and
/// correlated noise contribute is taken as common to all, and never averages
/// out, nor does `load_error`:
///
/// Standard deviations that are less than half of what the noise of a frame
/// over its load says, beside the median of all frames, are raised to that:
/// next to nu = 1/2 a frame knows less than it says.
///
///   Cov = b sum of A_i s_i C_i A_i^T + M M^T + load_error.relative^2 1 1^T,
///   M = sum of A_i ((1 - s_i) C_i)^(1/2),
///
/// where the ones are those of moduli, and b, at least 1, is chi^2 per degree
/// of freedom of the scatter between frames over their noise [Birge 1932].
///
/// Estimate::series has the number of frames and how the parameters change
/// with the load, or from the first frame to the last where loads are the same
/// (Trend).  Findings are those that most of the used frames have, and what
/// there is to say of the series; work is that of all frames.
///
/// Preconditions: `scene` and `options` are those that the frames were
/// estimated with, by `estimator`; at least one frame.  O(num_frames).
Estimate JointEstimate(const Scene& scene, const EstimatorOptions& options,
                       const Estimator& estimator,
                       const std::vector<FrameEstimate>& frames,
                       const LoadError& load_error);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_SERIES_JOINT_ESTIMATE_H_
