#include "apps/series.h"

#include <cstddef>
#include <optional>
#include <stdexcept>
#include <utility>

#include "apps/flags.h"
#include "elastimate/io/text/input_error.h"

namespace elastimate {
namespace {

// Of a frame that no estimator has seen.
Estimate NotRun(const std::string& why) {
  Estimate estimate;
  estimate.message = why;
  return estimate;
}

LoadCase ReadFrame(const FrameSeries& series, std::size_t i) {
  LoadCase frame = series.read(i);
  if (IsGiven("noise_sd")) {
    frame.noise_sd = FLAGS_noise_sd;
  }
  return frame;
}

// Prepared for a frame, unless there is something already.
void Prepare(const Estimator& estimator, const Scene& scene,
             const LoadCase& frame, const EstimatorOptions& options,
             std::optional<PreparedEstimator>& prepared) {
  if (!prepared) {
    Scene of_frame = scene;
    of_frame.load_cases = {frame};
    prepared = estimator.Prepare(of_frame, options);
  }
}

// What would be wrong with each frame is wrong with the command.
void CheckFirst(const Estimator& estimator, const Scene& scene,
                const LoadCase& frame, const FrameSeries& series,
                const EstimatorOptions& options) {
  Scene of_frame = scene;
  of_frame.load_cases = {frame};
  try {
    ValidateScene(of_frame);
  } catch (const std::invalid_argument&) {
    return;
  }
  const std::string why = estimator.WhyUnsupported(of_frame, options);
  if (!why.empty()) {
    ThrowInputError(series.files.front(),
                    std::string(estimator.Name()) + ": " + why);
  }
}

}  // namespace

std::vector<FrameEstimate> EstimateFrames(
    const Estimator& estimator, const Scene& scene, const FrameSeries& series,
    const EstimatorOptions& options,
    const std::function<void(const std::string&)>& progress) {
  std::vector<FrameEstimate> estimates;
  std::optional<PreparedEstimator> prepared;
  for (std::size_t i = 0; i < series.files.size(); ++i) {
    progress("frame " + std::to_string(i + 1) + " of " +
             std::to_string(series.files.size()));
    FrameEstimate estimate = {series.Load(i), {}};
    std::optional<LoadCase> frame;
    try {
      frame = ReadFrame(series, i);
    } catch (const std::invalid_argument& error) {
      estimate.estimate = NotRun(error.what());
    }
    if (frame && !prepared) {
      CheckFirst(estimator, scene, *frame, series, options);
    }
    if (frame) {
      try {
        Prepare(estimator, scene, *frame, options, prepared);
        estimate.estimate = prepared->RunLoadCases({*frame});
      } catch (const std::invalid_argument& error) {
        estimate.estimate = NotRun(error.what());
      }
    }
    estimates.push_back(std::move(estimate));
  }
  return estimates;
}

}  // namespace elastimate
