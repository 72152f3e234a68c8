#include "apps/error_flags.h"

#include <stdexcept>
#include <string>

#include "apps/flags.h"
#include "apps/number_list.h"
#include "elastimate/core/scene/rigid_motion.h"

namespace elastimate {
namespace {

void RequireOfFlag(bool condition, const std::string& flag,
                   const std::string& rule) {
  if (!condition) {
    throw std::invalid_argument(AsGiven(flag) + "; " + rule);
  }
}

void CheckRelativeNoise() {
  RequireOfFlag(FLAGS_noise >= 0, "noise", "it must not be negative");
  RequireOfFlag(FLAGS_noise_law == "uniform" || FLAGS_noise_law == "gaussian",
                "noise_law", "it must be uniform or gaussian");
}

void CheckAbsoluteNoise() {
  if (!IsGiven("noise_sd")) {
    RequireOfFlag(
        !IsGiven("correlation_length"), "correlation_length",
        "it belongs to noise of a given standard deviation; give --noise_sd");
    return;
  }
  RequireOfFlag(FLAGS_noise_sd > 0, "noise_sd", "it must be positive");
  RequireOfFlag(!IsGiven("noise"), "noise_sd",
                "--noise is given as well, so give only one of them");
  RequireOfFlag(!IsGiven("noise_law") || FLAGS_noise_law == "gaussian",
                "noise_law", "the noise of --noise_sd is gaussian");
  RequireOfFlag(!IsGiven("correlation_length") || FLAGS_correlation_length > 0,
                "correlation_length", "it must be positive");
}

void CheckOutliers() {
  RequireOfFlag(FLAGS_outliers >= 0 && FLAGS_outliers <= 1, "outliers",
                "it must be from 0 to 1");
  RequireOfFlag(
      FLAGS_outliers == 0 || FLAGS_noise > 0 || IsGiven("noise_sd"), "outliers",
      "their size is a multiple of the noise, so give --noise_sd or --noise");
}

}  // namespace

MeasurementErrors ErrorsFromFlags() {
  CheckRelativeNoise();
  CheckAbsoluteNoise();
  CheckOutliers();
  MeasurementErrors errors;
  errors.relative_noise = FLAGS_noise;
  errors.law =
      FLAGS_noise_law == "uniform" ? NoiseLaw::kUniform : NoiseLaw::kGaussian;
  errors.noise_sd = FLAGS_noise_sd;
  errors.correlation_length = FLAGS_correlation_length;
  errors.outliers = FLAGS_outliers;
  return errors;
}

Eigen::VectorXd RigidMotionFromFlag(int dimension) {
  if (!IsGiven("rigid_motion")) {
    return {};
  }
  return NumberList<Eigen::VectorXd>("rigid_motion", FLAGS_rigid_motion,
                                     "finite numbers",
                                     NumRigidMotions(dimension));
}

}  // namespace elastimate
