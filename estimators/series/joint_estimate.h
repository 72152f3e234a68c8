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
  Estimate estimate;  ///< What the frame alone says.
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
/// variance, parameter by parameter,
///
///   y = sum of W_i y_i,   W_i diagonal, of weights 1 / v_i whose sum is 1.
///
/// A parameter that errs may err in its variance as well, which would bias the
/// mean, so that v_i is what noise over load usually tells of it, by the median
/// of all frames, within a factor of 4 of its own variance.  Where each frame
/// knows its noise from few degrees of freedom only, all have that of the
/// median frame.  Standard deviations that are less than half of the usual ones
/// are raised to these: next to nu = 1/2 a frame knows less than it says.
///
/// The shares S_i of the variances that are noise (by the error budget) differ
/// from frame to frame, but for the correlation of the residuals of one frame
/// and the next; what the model, the elements and correlated noise contribute
/// is taken as common to all, and never averages out, nor does `load_error`:
///
///   Cov = B^(1/2) (sum of W_i N_i W_i) B^(1/2) + M M^T
///         + load_error.relative^2 1 1^T,
///   N_i = S_i^(1/2) C_i S_i^(1/2),
///   M = sum of W_i ((1 - S_i)^(1/2) C_i (1 - S_i)^(1/2))^(1/2),
///
/// where the ones are those of moduli, and B has, for each parameter, chi^2 per
/// degree of freedom of the scatter between frames over their noise, at least 1
/// [Birge 1932].  Frames are said to scatter where it is notable and more than
/// all of C_i explains: parts of what the elements and smooth noise contribute
/// differ between frames as well, in a way that is not known.
///
/// If most of the usable frames determine the shear modulus alone
/// (Estimate::shear_modulus), y is its logarithm, and E and nu are those of the
/// frame with the least relative error of the shear modulus.  Frames that
/// determine E and nu join with mu = E / (2 (1 + nu)), whose error follows from
/// the covariance of E and nu.
///
/// Estimate::series has the number of frames and how the parameters change
/// with the load, or from the first frame to the last where loads are the same
/// (Trend).  Findings are those that most of the used frames have, and what
/// there is to say of the series; work is that of all frames.
///
/// Preconditions: `scene` and `options` are those that the frames were
/// estimated with, by `estimator`; at least one frame.  O(num_frames).
[[nodiscard]] Estimate JointEstimate(const Scene& scene,
                                     const EstimatorOptions& options,
                                     const Estimator& estimator,
                                     const std::vector<FrameEstimate>& frames,
                                     const LoadError& load_error);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_SERIES_JOINT_ESTIMATE_H_
