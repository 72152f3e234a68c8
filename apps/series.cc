#include "apps/series.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <utility>

#include "apps/flags.h"
#include "apps/frame_fit.h"
#include "apps/linear_algebra.h"
#include "elastimate/core/mesh/mesh_points.h"
#include "elastimate/core/parallel/ranks.h"
#include "elastimate/core/scene/camera.h"
#include "elastimate/core/solvers/multigrid.h"
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
void CompareNeighbours(std::vector<FrameFit>& fits) {
  const Eigen::VectorXd* before = nullptr;
  for (auto& [frame, residual] : fits) {
    if (residual.size() == 0) {
      continue;
    }
    if (before != nullptr) {
      CompareWith(*before, residual, frame);
    }
    before = &residual;
  }
}

std::string ReceiveText(const Ranks& ranks, int from) {
  std::string text;
  ranks.Wait(from);
  ReceiveAll(ranks, from, text);
  return text;
}

// Throws on rank 0 where another rank has other frames, or none.
void CheckFramesOfRanks(const Ranks& ranks, std::size_t num_frames) {
  if (ranks.Rank() > 0) {
    return SendReadiness(num_frames, "");
  }
  for (int rank = 1; rank < ranks.Size(); ++rank) {
    ranks.Wait(rank);
    std::size_t num_frames_of_rank = 0;
    ranks.Receive(rank, &num_frames_of_rank, sizeof(num_frames_of_rank));
    std::string why_not = ReceiveText(ranks, rank);
    if (why_not.empty() && num_frames_of_rank != num_frames) {
      why_not =
          "the number of frames is not that of rank 0; give all ranks the same "
          "files";
    }
    if (!why_not.empty()) {
      throw std::invalid_argument("rank " + std::to_string(rank) + ": " +
                                  why_not);
    }
  }
}

// Fits the frames of a series in groups.  Each frame may start from the one
// before it in its group.  Threads and ranks take whole groups, so that no fit
// starts elsewhere where there are more of them.
class SeriesFit {
 public:
  SeriesFit(const Estimator& estimator, const Scene& scene,
            const FrameSeries& series, const EstimatorOptions& options,
            const std::function<void(const std::string&)>& progress)
      : estimator_(estimator),
        scene_(scene),
        series_(series),
        options_(options),
        progress_(progress),
        fits_(series.files.size()),
        frames_of_group_(std::clamp<std::size_t>(fits_.size() / 4, 1, 4)) {}

  // Returns the fits on rank 0, and none on other ranks.
  std::vector<FrameFit> Run() {
    // On larger meshes a fit uses several threads and ranks itself, and needs
    // much memory.
    constexpr Eigen::Index kMostNodes = 20000;
    if (scene_.mesh.NumNodes() > kMostNodes) {
      RefuseOnOtherRanks();
      frames_of_group_ = fits_.size();
      FitOnThreads(0, 1);
    } else if (const Ranks* const ranks = RanksOfSolves()) {
      WorkApart([this, ranks] { FitOnRanks(*ranks); });
    } else {
      FitOnThreads(0, NumGroups());
    }
    return std::move(fits_);
  }

 private:
  std::size_t NumGroups() const {
    return (fits_.size() + frames_of_group_ - 1) / frames_of_group_;
  }
  std::size_t FirstFrame(std::size_t group) const {
    return std::min(group * frames_of_group_, fits_.size());
  }

  void FitFrame(std::size_t i, std::optional<PreparedEstimator>& prepared) {
    auto& [frame, residual] = fits_[i];
    frame.load = series_.Load(i);
    try {
      std::unique_lock<std::mutex> lock(reading_);
      progress_("frame " + std::to_string(++num_started_) + " of " +
                std::to_string(num_own_));
      const LoadCase measured = ReadFrame(series_, i);
      lock.unlock();
      Prepare(estimator_, scene_, measured, options_, prepared);
      frame.estimate = prepared->RunLoadCases({measured});
      residual = ResidualOf(scene_, measured, frame.estimate);
    } catch (const std::invalid_argument& error) {
      frame.estimate = NotRun(error.what());
    }
  }

  void FitOnThreads(std::size_t begin, std::size_t end) {
    num_own_ = FirstFrame(end) - FirstFrame(begin);
    ForBlocks(end - begin, [&](std::size_t first, std::size_t last) {
      std::optional<PreparedEstimator> prepared;
      for (std::size_t i = FirstFrame(begin + first);
           i < FirstFrame(begin + last); ++i) {
        if (prepared && i % frames_of_group_ == 0) {
          prepared->ForgetStart();
        }
        FitFrame(i, prepared);
      }
    });
  }

  void FitOnRanks(const Ranks& ranks) {
    CheckFramesOfRanks(ranks, fits_.size());
    const auto first_group = [&](int rank) {
      return NumGroups() * std::size_t(rank) / std::size_t(ranks.Size());
    };
    const auto first_fit = [&](int rank) {
      return fits_.begin() + std::ptrdiff_t(FirstFrame(first_group(rank)));
    };
    const int own = ranks.Rank();
    FitOnThreads(first_group(own), first_group(own + 1));
    if (own > 0) {
      SendAll(ranks, 0, BytesOf({first_fit(own), first_fit(own + 1)}));
      fits_.clear();
      return;
    }
    for (int rank = 1; rank < ranks.Size(); ++rank) {
      std::vector<FrameFit> fits = FitsOf(ReceiveText(ranks, rank));
      std::move(fits.begin(), fits.end(), first_fit(rank));
    }
    for (FrameFit& fit : fits_) {
      fit.frame.estimate.work.ranks = ranks.Size();
    }
  }

  const Estimator& estimator_;
  const Scene& scene_;
  const FrameSeries& series_;
  const EstimatorOptions& options_;
  const std::function<void(const std::string&)>& progress_;
  std::vector<FrameFit> fits_;
  // Short groups spread evenly over threads.  Long ones let more frames start
  // from the one before.
  std::size_t frames_of_group_;
  std::size_t num_own_ = 0;  // The frames of this rank.
  std::size_t num_started_ = 0;
  // A reader keeps what the frames have in common.
  std::mutex reading_;
};

}  // namespace

LoadCase ReadFrame(const FrameSeries& series, std::size_t i) {
  LoadCase frame = series.read(i);
  if (IsGiven("noise_sd")) {
    frame.noise_sd = FLAGS_noise_sd;
  }
  return frame;
}

void SendReadiness(std::size_t num_frames, const std::string& why_not) {
  const Ranks& ranks = *RanksOfSolves();
  ranks.Send(0, &num_frames, sizeof(num_frames));
  SendAll(ranks, 0, why_not);
}

void RefuseOnOtherRanks() {
  const Ranks* const ranks = RanksOfSolves();
  if (ranks != nullptr && ranks->Rank() > 0) {
    throw std::invalid_argument(
        "this rank does not estimate frames as rank 0 does; give all ranks the "
        "same command and the same files");
  }
}

std::vector<FrameEstimate> EstimateFrames(
    const Estimator& estimator, const Scene& scene, const FrameSeries& series,
    const EstimatorOptions& options,
    const std::function<void(const std::string&)>& progress) {
  CheckFirst(estimator, scene, series, options);
  std::vector<FrameFit> fits =
      SeriesFit(estimator, scene, series, options, progress).Run();
  CompareNeighbours(fits);
  std::vector<FrameEstimate> frames(fits.size());
  for (std::size_t i = 0; i < frames.size(); ++i) {
    frames[i] = std::move(fits[i].frame);
  }
  return frames;
}

}  // namespace elastimate
