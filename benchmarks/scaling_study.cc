#include "benchmarks/scaling_study.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "apps/linear_algebra.h"
#include "benchmarks/child_process.h"
#include "benchmarks/measured_body.h"
#include "benchmarks/processor_time.h"
#include "benchmarks/trial.h"
#include "elastimate/core/algebra/dense_algebra.h"
#include "elastimate/estimators/interface/stopwatch.h"
#include "elastimate/estimators/registry.h"

namespace elastimate {
namespace {

constexpr IsotropicElasticity kElasticity = {10e3, 0.33};
constexpr double kDeviation = 0.01;
constexpr std::uint64_t kSeed = 1;
constexpr ProcessLimits kLimits = {100, std::int64_t{16} << 30};

// Runs are repeated until they have taken this long together, and their mean
// counts: the clock of a virtual processor may stand still for milliseconds.
constexpr double kRepeatSeconds = 0.5;

// The slope is that of a line through so many of the largest sizes.
constexpr std::size_t kSizesOfSlope = 3;

constexpr double kMebibyte = 1024.0 * 1024.0;

// Measured cubes have five tetrahedra in each of cells^3 cells; organs have
// about as many tetrahedra as asked for.
struct Body {
  std::string name;
  Scene (*scene)(int, const IsotropicElasticity&);
  std::vector<int> sizes;
};

std::vector<Body> Bodies(bool is_quick) {
  if (is_quick) {
    return {{"cube", MeasuredCube, {6, 9}}, {"organ", MeasuredOrgan, {1000}}};
  }
  return {{"cube", MeasuredCube, {6, 9, 13, 19, 27, 40, 58, 125}},
          {"organ", MeasuredOrgan, {2000, 20000, 200000, 1000000}}};
}

// Holds a scene's size, and the peak memory of a process that only makes it.
struct SceneSize {
  int size;
  std::int64_t tetrahedra;
  double memory;  // Byte.
};

struct Run {
  double tetrahedra = 0;
  ProcessReport report;
  std::string status;
  double seconds = std::numeric_limits<double>::quiet_NaN();
  double processor_seconds = std::numeric_limits<double>::quiet_NaN();
  int repetitions = 0;
  int factorizations = 0;
  double own_memory = std::numeric_limits<double>::quiet_NaN();  // Byte.

  bool IsMeasured() const { return repetitions > 0; }
};

Scene NoisyScene(const Body& body, int size) {
  return WithNoise(body.scene(size, kElasticity), kDeviation, kSeed);
}

std::string RunEstimator(std::string_view name, const Body& body, int size) {
  const Scene scene = NoisyScene(body, size);
  const std::shared_ptr<const Estimator> estimator = MakeEstimator(name);
  Estimate estimate;
  int repetitions = 0;
  double seconds = 0;
  Stopwatch stopwatch;
  const double start = ProcessorSeconds();
  do {
    estimate = estimator->Run(scene, {});
    ++repetitions;
    seconds = ProcessorSeconds() - start;
  } while (seconds < kRepeatSeconds);
  std::ostringstream output;
  output << StatusName(estimate.status) << " " << stopwatch.Lap() / repetitions
         << " " << seconds / repetitions << " " << repetitions << " "
         << estimate.work.factorizations;
  return output.str();
}

Run Measure(std::string_view name, const Body& body, const SceneSize& scene) {
  Run run;
  run.tetrahedra = static_cast<double>(scene.tetrahedra);
  run.report = RunInChildProcess(
      kLimits, [&] { return RunEstimator(name, body, scene.size); });
  if (run.report.outcome == ProcessOutcome::kFinished) {
    std::istringstream(run.report.output) >> run.status >> run.seconds >>
        run.processor_seconds >> run.repetitions >> run.factorizations;
    run.own_memory = static_cast<double>(run.report.peak_memory) - scene.memory;
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
      points.emplace_back(std::log(run.tetrahedra), std::log(run.*value));
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

std::vector<SceneSize> MakeScenes(const Body& body, Progress& progress) {
  std::vector<SceneSize> scenes;
  for (const int size : body.sizes) {
    progress.Show("scaling: scene of " + body.name + " " +
                  std::to_string(size));
    const ProcessReport report = RunInChildProcess(kLimits, [&] {
      return std::to_string(NoisyScene(body, size).mesh.NumElements());
    });
    scenes.push_back({size, std::stoll(report.output),
                      static_cast<double>(report.peak_memory)});
  }
  return scenes;
}

/// Adds a row of the estimator for each size, and returns the runs up to the
/// size that a limit ends.
std::vector<Run> MeasureSizes(const std::string& name, const Body& body,
                              const std::vector<SceneSize>& scenes,
                              Progress& progress, Table& table) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  std::vector<Run> measured;
  std::string limit;
  for (const SceneSize& scene : scenes) {
    if (!limit.empty()) {
      table.AddRow({name, body.name, scene.tetrahedra,
                    "not run: " + limit + " at a smaller size", "", kNone,
                    kNone, std::int64_t{0}, kNone, kNone,
                    scene.memory / kMebibyte, kNone});
      continue;
    }
    progress.Show("scaling: " + name + " with " + body.name + " of " +
                  std::to_string(scene.tetrahedra) + " tetrahedra");
    const Run run = Measure(name, body, scene);
    const bool is_measured = run.IsMeasured();
    table.AddRow({name, body.name, scene.tetrahedra,
                  OutcomeName(run.report.outcome), run.status, run.seconds,
                  run.processor_seconds, std::int64_t{run.repetitions},
                  is_measured ? double(run.factorizations) : kNone,
                  static_cast<double>(run.report.peak_memory) / kMebibyte,
                  scene.memory / kMebibyte, run.own_memory / kMebibyte});
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
  const int threads = static_cast<int>(std::thread::hardware_concurrency());
  SetThreads(threads);
  Table table(
      "scaling",
      {"estimator", "body", "tetrahedra [1]", "outcome", "status", "time [s]",
       "processor_time [s]", "repetitions [1]", "factorizations [1]",
       "peak_memory [MiB]", "scene_memory [MiB]", "own_memory [MiB]"});
  Table slopes("scaling_slopes", {"estimator", "body", "sizes [1]",
                                  "time_slope [1]", "own_memory_slope [1]"});
  for (const Body& body : Bodies(is_quick)) {
    const std::vector<SceneSize> scenes = MakeScenes(body, progress);
    for (const std::string_view name : EstimatorNames()) {
      const std::vector<Run> measured =
          MeasureSizes(std::string(name), body, scenes, progress, table);
      slopes.AddRow({std::string(name), body.name,
                     std::int64_t(std::min(measured.size(), kSizesOfSlope)),
                     Slope(measured, &Run::seconds),
                     Slope(measured, &Run::own_memory)});
    }
  }
  return {{table, slopes},
          {{"cube", "of five tetrahedra in each of n x n x n cells"},
           {"organ", "an unstructured mesh as Gmsh makes it"},
           {"displacement_deviation", kDeviation},
           {"noise_seed", kSeed},
           {"limit_of_processor_time [s]", kLimits.processor_seconds},
           {"limit_of_memory [MiB]",
            static_cast<double>(kLimits.memory) / kMebibyte},
           {"limits", "of a process with its scene and all repetitions"},
           {"threads", threads},
           {"peak_memory",
            "largest resident memory of a process of its own, program and "
            "scene included; of one that a limit ended, up to then"},
           {"own_memory", "what is beyond that of a process with the scene"},
           {"slopes", "of the three largest measured sizes"}}};
}

}  // namespace elastimate
