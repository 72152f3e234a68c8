#ifndef ELASTIMATE_ESTIMATORS_VALIDATION_CROSS_VALIDATION_H_
#define ELASTIMATE_ESTIMATORS_VALIDATION_CROSS_VALIDATION_H_

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "elastimate/core/scene/scene.h"
#include "elastimate/estimators/interface/estimate.h"
#include "elastimate/estimators/interface/estimator.h"
#include "elastimate/estimators/validation/folds.h"

namespace elastimate {

/// Displacements that were measured beside those that a model predicts.
struct Prediction {
  /// The number of components, less the unknown motions that were fitted to
  /// them.
  Eigen::Index num_values = 0;
  /// r^T Cov^-1 r of the differences r; about num_values if the model and its
  /// errors are right.
  double chi_square = 0;
  double square_sum = 0;           ///< Of the differences [length^2].
  double measured_square_sum = 0;  ///< Of the measurement [length^2].

  /// Counts another prediction as well.
  Prediction& operator+=(const Prediction& other);
  /// The root mean square of the differences over their stated errors: about 1
  /// if the model and its errors are right.  NaN without values.
  double ErrorRatio() const;
  /// The root mean square of the differences [length].
  double RmsError() const;
  /// The root mean square of the differences over that of the measurement.
  double RelativeError() const;
  /// Tells whether the differences are larger than stated, by more than chance
  /// explains, and by more than what standard deviations are known to.
  bool IsOff() const;
};

/// What the measurement without one fold says of that fold.
struct FoldPrediction {
  Estimate estimate;      ///< Of the measurement without the fold.
  Prediction prediction;  ///< Without values if nothing was predicted.
  std::string why_not;    ///< Why nothing was predicted; else empty.
};

/// Measured less predicted displacements of a load case.
struct PredictionErrors {
  Eigen::MatrixXd of_nodes;   ///< dimension x num_nodes [length], or NaN.
  Eigen::MatrixXd of_points;  ///< dimension x num_points [length], or NaN.
  /// These have the errors above, divided by their stated standard errors.
  Eigen::MatrixXd standardised_of_nodes;
  Eigen::MatrixXd standardised_of_points;
};

/// How well a model predicts what it has not seen.
struct CrossValidation {
  std::vector<FoldPrediction> folds;     ///< In the order of Folds.
  std::vector<PredictionErrors> errors;  ///< One for each load case.

  Prediction Total() const;
  /// Tells whether each fold was predicted.
  bool IsComplete() const;
  /// Tells whether the differences of a fold, or of all together, are too large
  /// (Prediction::IsOff).
  bool IsOff() const;
};

/// Fits a scene without each of its folds in turn, and predicts what was
/// measured there.
///
/// With parameters p of the fit, whose covariance is C, the prediction u(p) and
/// the noise of the standard deviation s, the differences have the covariance
///
///   Cov = s^2 I + J C J^T,   J = du/dp on the held out components.
///
/// If the estimate of a fold is not usable but has a number, the number is used
/// and C is zero.  Motions of supports, or of the whole specimen, that are not
/// known are fitted to what is held out, and the differences are what they
/// leave of it.  Displacements are those of the elements with which the
/// estimator has fitted, the mesh not divided.
///
/// `progress` is called before each fold, with its number from 0 on.  Throws
/// std::invalid_argument as Estimator::Run does, and for materials with a map.
/// A fit and a solution with its derivatives for each fold.
[[nodiscard]] CrossValidation CrossValidate(
    const Scene& scene, const Folds& folds, const Estimator& estimator,
    const EstimatorOptions& options, const std::function<void(int)>& progress);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_VALIDATION_CROSS_VALIDATION_H_
