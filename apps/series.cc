#include "apps/series.h"

#include <cmath>
#include <cstddef>
#include <limits>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <utility>

#include "apps/flags.h"
#include "apps/linear_algebra.h"
#include "elastimate/core/mesh/mesh_points.h"
#include "elastimate/core/scene/camera.h"
#include "elastimate/io/text/input_error.h"

namespace elastimate {
namespace {

// Returns an estimate for a frame that no estimator has seen.
Estimate NotRun(const std::string& why) {
  Estimate estimate;
  estimate.message = why;
  return estimate;
}

// Prepares the estimator for a frame, unless it is prepared already.
void Prepare(const Estimator& estimator, const Scene& scene,
             const LoadCase& frame, const EstimatorOptions& options,
             std::optional<PreparedEstimator>& prepared) {
  if (!prepared) {
    Scene of_frame = scene;
    of_frame.load_cases = {frame};
    // Priors count once, in the joint estimate.
    for (Material& material : of_frame.materials) {
      material.priors.clear();
    }
    prepared = estimator.Prepare(of_frame, options);
  }
}

// Checks the first valid frame: what is wrong with each frame is wrong with the
// command.
void CheckFirst(const Estimator& estimator, const Scene& scene,
                const FrameSeries& series, const EstimatorOptions& options) {
  Scene of_frame = scene;
  for (std::size_t i = 0; i < series.files.size(); ++i) {
    try {
      of_frame.load_cases = {ReadFrame(series, i)};
      ValidateScene(of_frame);
    } catch (const std::invalid_argument&) {
      continue;
    }
    const std::string why = estimator.WhyUnsupported(of_frame, options);
    if (!why.empty()) {
      ThrowInputError(series.files[i],
                      std::string(estimator.Name()) + ": " + why);
    }
    return;
  }
}

// Returns what is left of a measurement; NaN where there is none, or where it
// was left out.
Eigen::VectorXd ResidualOf(const Scene& scene, const LoadCase& frame,
                           const Estimate& estimate) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  if (estimate.fitted_displacement.size() == 0) {
    return {};
  }
  const Mesh& mesh = scene.mesh;
  const Eigen::MatrixXd fitted =
      SeenDisplacements(mesh, estimate.fitted_displacement, estimate.cameras)
          .col(0)
          .reshaped(mesh.Dimension(), mesh.NumNodes());
  Eigen::MatrixXd residual;
  if (frame.displacement.size() != 0) {
    residual = frame.displacement - fitted;
    if (frame.observed.size() != 0) {
      residual = frame.observed.select(residual.array(), kNone).matrix();
    }
  } else {
    residual = frame.points.displacement -
               Interpolate(mesh, frame.points.points, fitted);
  }
  for (const Outlier& outlier : estimate.outliers) {
    residual.col(outlier.index).setConstant(kNone);
  }
  return residual.reshaped();
}

// Compares the components that both frames have.
void CompareWith(const Eigen::VectorXd& before, const Eigen::VectorXd& residual,
                 FrameEstimate& frame) {
  if (before.size() != residual.size()) {
    return;
  }
  const Eigen::Array<bool, Eigen::Dynamic, 1> is_in_both =
      before.array().isFinite() && residual.array().isFinite();
  const Eigen::ArrayXd a = is_in_both.select(before.array(), 0.0);
  const Eigen::ArrayXd b = is_in_both.select(residual.array(), 0.0);
  const double size = std::sqrt(a.square().sum() * b.square().sum());
  if (size > 0) {
    frame.likeness = (a * b).sum() / size;
    frame.num_alike = is_in_both.count();
  }
}

// Compares each residual with that of the nearest earlier frame that has one.
void CompareNeighbours(const std::vector<Eigen::VectorXd>& residuals,
                       std::vector<FrameEstimate>& frames) {
  const Eigen::VectorXd* before = nullptr;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (residuals[i].size() == 0) {
      continue;
    }
    if (before != nullptr) {
      CompareWith(*before, residuals[i], frames[i]);
    }
    before = &residuals[i];
  }
}

}  // namespace

LoadCase ReadFrame(const FrameSeries& series, std::size_t i) {
  LoadCase frame = series.read(i);
  if (IsGiven("noise_sd")) {
    frame.noise_sd = FLAGS_noise_sd;
  }
  return frame;
}

std::vector<FrameEstimate> EstimateFrames(
    const Estimator& estimator, const Scene& scene, const FrameSeries& series,
    const EstimatorOptions& options,
    const std::function<void(const std::string&)>& progress) {
  CheckFirst(estimator, scene, series, options);
  const std::size_t num_frames = series.files.size();
  std::vector<FrameEstimate> frames(num_frames);
  std::vector<Eigen::VectorXd> residuals(num_frames);
  std::size_t num_started = 0;
  // A reader keeps what the frames have in common.
  std::mutex reading;
  const auto estimate_block = [&](std::size_t begin, std::size_t end) {
    std::optional<PreparedEstimator> prepared;
    for (std::size_t i = begin; i < end; ++i) {
      frames[i].load = series.Load(i);
      try {
        std::unique_lock<std::mutex> lock(reading);
        progress("frame " + std::to_string(++num_started) + " of " +
                 std::to_string(num_frames));
        const LoadCase frame = ReadFrame(series, i);
        lock.unlock();
        Prepare(estimator, scene, frame, options, prepared);
        frames[i].estimate = prepared->RunLoadCases({frame});
        residuals[i] = ResidualOf(scene, frame, frames[i].estimate);
      } catch (const std::invalid_argument& error) {
        frames[i].estimate = NotRun(error.what());
      }
    }
  };
  // On larger meshes a fit uses several threads itself, and needs much memory.
  constexpr Eigen::Index kMostNodes = 20000;
  if (scene.mesh.NumNodes() > kMostNodes) {
    estimate_block(0, num_frames);
  } else {
    ForBlocks(num_frames, estimate_block);
  }
  CompareNeighbours(residuals, frames);
  return frames;
}

}  // namespace elastimate
