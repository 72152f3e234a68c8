#include "benchmarks/scaling_study.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "apps/linear_algebra.h"
#include "benchmarks/child_process.h"
#include "benchmarks/measured_cube.h"
#include "benchmarks/processor_time.h"
#include "benchmarks/trial.h"
#include "elastimate/core/algebra/dense_algebra.h"
#include "elastimate/estimators/registry.h"

namespace elastimate {
namespace {

constexpr IsotropicElasticity kElasticity = {10e3, 0.33};
constexpr double kDeviation = 0.01;
constexpr std::uint64_t kSeed = 1;
constexpr ProcessLimits kLimits = {600, std::int64_t{16} << 30};

// Runs are repeated until they have taken this long together, and their mean
// counts: the clock of a virtual processor may stand still for milliseconds.
constexpr double kRepeatSeconds = 0.5;

// The slope is that of a line through so many of the largest sizes.
constexpr std::size_t kSizesOfSlope = 3;

constexpr double kMebibyte = 1024.0 * 1024.0;

// Returns the numbers of cells along each edge; a cell has five tetrahedra.
std::vector<int> Sizes(bool is_quick) {
  return is_quick ? std::vector<int>{6, 9}
                  : std::vector<int>{6, 9, 13, 19, 27, 40, 58};
}

Scene NoisyCube(int cells) {
  return WithNoise(MeasuredCube(cells, kElasticity), kDeviation, kSeed);
}

struct Run {
  int cells = 0;
  ProcessReport report;
  std::string status;
  double processor_seconds = std::numeric_limits<double>::quiet_NaN();
  int repetitions = 0;
  int factorizations = 0;
  double own_memory = std::numeric_limits<double>::quiet_NaN();  // Byte.

  bool IsMeasured() const { return repetitions > 0; }
};

std::string RunEstimator(std::string_view name, int cells) {
  const Scene scene = NoisyCube(cells);
  const std::shared_ptr<const Estimator> estimator = MakeEstimator(name);
  Estimate estimate;
  int repetitions = 0;
  double seconds = 0;
  const double start = ProcessorSeconds();
  do {
    estimate = estimator->Run(scene, {});
    ++repetitions;
    seconds = ProcessorSeconds() - start;
  } while (seconds < kRepeatSeconds);
  std::ostringstream output;
  output << StatusName(estimate.status) << " " << seconds / repetitions << " "
         << repetitions << " " << estimate.work.factorizations;
  return output.str();
}

Run Measure(std::string_view name, int cells, double scene_memory) {
  Run run;
  run.cells = cells;
  run.report =
      RunInChildProcess(kLimits, [&] { return RunEstimator(name, cells); });
  if (run.report.outcome == ProcessOutcome::kFinished) {
    std::istringstream(run.report.output) >> run.status >>
        run.processor_seconds >> run.repetitions >> run.factorizations;
    run.own_memory = static_cast<double>(run.report.peak_memory) - scene_memory;
  }
  return run;
}

const char* OutcomeName(ProcessOutcome outcome) {
  switch (outcome) {
    case ProcessOutcome::kFinished:
      return "measured";
    case ProcessOutcome::kTimeLimit:
      return "time_limit";
    case ProcessOutcome::kMemoryLimit:
      return "memory_limit";
  }
  return "";
}

// Returns the slope, by least squares, of the line through the logarithms at
// the largest sizes; NaN if fewer than two values are above zero.
double Slope(const std::vector<Run>& runs, double Run::*value) {
  std::vector<std::pair<double, double>> points;
  for (const Run& run : runs) {
    if (run.*value > 0) {
      points.emplace_back(3 * std::log(run.cells), std::log(run.*value));
    }
  }
  points.erase(points.begin(),
               points.end() - std::min(points.size(), kSizesOfSlope));
  Eigen::MatrixX2d lines(points.size(), 2);
  Eigen::VectorXd values(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    lines.row(i) << 1, points[i].first;
    values(i) = points[i].second;
  }
  return points.size() < 2 ? std::numeric_limits<double>::quiet_NaN()
                           : SolveLeastSquares(lines, values)(1);
}

std::int64_t NumTetrahedra(int cells) {
  return std::int64_t{5} * cells * cells * cells;
}

/// Returns, for each size, the peak memory of a process that only makes the
/// scene.
std::map<int, double> SceneMemory(const std::vector<int>& sizes,
                                  Progress& progress) {
  std::map<int, double> memory;
  for (const int cells : sizes) {
    progress.Show("scaling: scene of " + std::to_string(NumTetrahedra(cells)) +
                  " tetrahedra");
    const auto make_scene = [cells] {
      return std::to_string(NoisyCube(cells).mesh.NumNodes());
    };
    memory[cells] =
        static_cast<double>(RunInChildProcess(kLimits, make_scene).peak_memory);
  }
  return memory;
}

/// Adds a row of the estimator for each size, and returns the runs up to the
/// size that a limit ends.
std::vector<Run> MeasureSizes(const std::string& name,
                              const std::map<int, double>& scene_memory,
                              Progress& progress, Table& table) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  std::vector<Run> measured;
  std::string limit;
  for (const auto& [cells, scene] : scene_memory) {
    if (!limit.empty()) {
      table.AddRow({name, NumTetrahedra(cells),
                    "not run: " + limit + " at a smaller size", "", kNone,
                    std::int64_t{0}, kNone, kNone, scene / kMebibyte, kNone});
      continue;
    }
    progress.Show("scaling: " + name + " with " +
                  std::to_string(NumTetrahedra(cells)) + " tetrahedra");
    const Run run = Measure(name, cells, scene);
    const bool is_measured = run.IsMeasured();
    table.AddRow({name, NumTetrahedra(cells), OutcomeName(run.report.outcome),
                  run.status, run.processor_seconds,
                  std::int64_t{run.repetitions},
                  is_measured ? double(run.factorizations) : kNone,
                  static_cast<double>(run.report.peak_memory) / kMebibyte,
                  scene / kMebibyte, run.own_memory / kMebibyte});
    if (is_measured) {
      measured.push_back(run);
    } else {
      limit = OutcomeName(run.report.outcome);
    }
  }
  return measured;
}

}  // namespace

StudyResult RunScalingStudy(bool is_quick, Progress& progress) {
  SetThreads(1);
  const std::map<int, double> scene_memory =
      SceneMemory(Sizes(is_quick), progress);
  Table table("scaling",
              {"estimator", "tetrahedra [1]", "outcome", "status",
               "processor_time [s]", "repetitions [1]", "factorizations [1]",
               "peak_memory [MiB]", "scene_memory [MiB]", "own_memory [MiB]"});
  Table slopes("scaling_slopes",
               {"estimator", "sizes [1]", "processor_time_slope [1]",
                "own_memory_slope [1]"});
  for (const std::string_view name : EstimatorNames()) {
    const std::vector<Run> measured =
        MeasureSizes(std::string(name), scene_memory, progress, table);
    slopes.AddRow({std::string(name),
                   std::int64_t(std::min(measured.size(), kSizesOfSlope)),
                   Slope(measured, &Run::processor_seconds),
                   Slope(measured, &Run::own_memory)});
  }
  return {{table, slopes},
          {{"cube", "of five tetrahedra in each of n x n x n cells"},
           {"displacement_deviation", kDeviation},
           {"noise_seed", kSeed},
           {"limit_of_processor_time [s]", kLimits.processor_seconds},
           {"limit_of_memory [MiB]",
            static_cast<double>(kLimits.memory) / kMebibyte},
           {"limits", "of a process with its scene and all repetitions"},
           {"blas_threads", 1},
           {"peak_memory",
            "largest resident memory of a process of its own, program and "
            "scene included; of one that a limit ended, up to then"},
           {"own_memory", "what is beyond that of a process with the scene"},
           {"slopes", "of the three largest measured sizes"}}};
}

}  // namespace elastimate
