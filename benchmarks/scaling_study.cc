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
constexpr ProcessLimits kLimits = {600, std::int64_t{20} << 30};

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

// A scene that all processes of its size share, and the memory of one that only
// has it.
struct MeasuredScene {
  Scene scene;
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

// Makes a scene on one thread: the threads of a process are not those of its
// children, which would wait for them.
MeasuredScene MakeScene(const Body& body, int size) {
  SetThreads(1);
  MeasuredScene measured = {
      WithNoise(body.scene(size, kElasticity), kDeviation, kSeed), 0};
  measured.memory = static_cast<double>(
      RunInChildProcess(kLimits, [] { return std::string(); }).peak_memory);
  return measured;
}

int NumThreads() {
  return static_cast<int>(std::thread::hardware_concurrency());
}

std::string RunEstimator(std::string_view name, const Scene& scene) {
  SetThreads(NumThreads());
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

Run Measure(std::string_view name, const MeasuredScene& measured) {
  Run run;
  run.tetrahedra = static_cast<double>(measured.scene.mesh.NumElements());
  run.report = RunInChildProcess(
      kLimits, [&] { return RunEstimator(name, measured.scene); });
  if (run.report.outcome == ProcessOutcome::kFinished) {
    std::istringstream(run.report.output) >> run.status >> run.seconds >>
        run.processor_seconds >> run.repetitions >> run.factorizations;
    run.own_memory =
        static_cast<double>(run.report.peak_memory) - measured.memory;
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

// The runs of an estimator, up to the size that a limit ends.
struct RunsOfEstimator {
  std::vector<Run> measured;
  std::string limit;
};

/// Adds a row of the estimator with this scene.
void MeasureSize(const std::string& name, const std::string& body,
                 const MeasuredScene& scene, RunsOfEstimator& runs,
                 Table& table) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  const std::int64_t tetrahedra = scene.scene.mesh.NumElements();
  if (!runs.limit.empty()) {
    table.AddRow({name, body, tetrahedra,
                  "not run: " + runs.limit + " at a smaller size", "", kNone,
                  kNone, std::int64_t{0}, kNone, kNone,
                  scene.memory / kMebibyte, kNone});
    return;
  }
  const Run run = Measure(name, scene);
  const bool is_measured = run.IsMeasured();
  table.AddRow({name, body, tetrahedra, OutcomeName(run.report.outcome),
                run.status, run.seconds, run.processor_seconds,
                std::int64_t{run.repetitions},
                is_measured ? double(run.factorizations) : kNone,
                static_cast<double>(run.report.peak_memory) / kMebibyte,
                scene.memory / kMebibyte, run.own_memory / kMebibyte});
  if (is_measured) {
    runs.measured.push_back(run);
  } else {
    runs.limit = OutcomeName(run.report.outcome);
  }
}

void MeasureBody(const Body& body, Progress& progress, Table& table,
                 Table& slopes) {
  const std::vector<std::string_view> names = EstimatorNames();
  std::vector<RunsOfEstimator> runs(names.size());
  for (const int size : body.sizes) {
    progress.Show("scaling: scene of " + body.name + " " +
                  std::to_string(size));
    const MeasuredScene scene = MakeScene(body, size);
    for (std::size_t i = 0; i < names.size(); ++i) {
      progress.Show("scaling: " + std::string(names[i]) + " with " + body.name +
                    " of " + std::to_string(scene.scene.mesh.NumElements()) +
                    " tetrahedra");
      MeasureSize(std::string(names[i]), body.name, scene, runs[i], table);
    }
  }
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::vector<Run>& measured = runs[i].measured;
    slopes.AddRow({std::string(names[i]), body.name,
                   std::int64_t(std::min(measured.size(), kSizesOfSlope)),
                   Slope(measured, &Run::seconds),
                   Slope(measured, &Run::own_memory)});
  }
}

}  // namespace

StudyResult RunScalingStudy(bool is_quick, Progress& progress) {
  Table table(
      "scaling",
      {"estimator", "body", "tetrahedra [1]", "outcome", "status", "time [s]",
       "processor_time [s]", "repetitions [1]", "factorizations [1]",
       "peak_memory [MiB]", "scene_memory [MiB]", "own_memory [MiB]"});
  Table slopes("scaling_slopes", {"estimator", "body", "sizes [1]",
                                  "time_slope [1]", "own_memory_slope [1]"});
  for (const Body& body : Bodies(is_quick)) {
    MeasureBody(body, progress, table, slopes);
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
           {"threads", NumThreads()},
           {"peak_memory",
            "largest resident memory of a process of its own, program and "
            "scene included; of one that a limit ended, up to then"},
           {"own_memory", "what is beyond that of a process with the scene"},
           {"slopes", "of the three largest measured sizes"}}};
}

}  // namespace elastimate
