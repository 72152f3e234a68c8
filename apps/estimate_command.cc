#include <glog/logging.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <optional>
#include <sstream>
#include <stdexcept>

#include "apps/commands.h"
#include "apps/flags.h"
#include "apps/linear_algebra.h"
#include "apps/progress.h"
#include "apps/result_fields.h"
#include "apps/summary.h"
#include "elastimate/estimators/registry.h"
#include "elastimate/io/file_output.h"
#include "elastimate/io/report.h"
#include "elastimate/io/scene_reader.h"
#include "elastimate/io/vtu_writer.h"

namespace elastimate {
namespace {

using Clock = std::chrono::steady_clock;

double SecondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

std::optional<double> Given(const std::string& flag, double value) {
  return IsGiven(flag) ? std::optional<double>(value) : std::nullopt;
}

Loss LossNamed(const std::string& name) {
  if (name == "none") {
    return Loss::kNone;
  }
  if (name == "huber") {
    return Loss::kHuber;
  }
  if (name == "cauchy") {
    return Loss::kCauchy;
  }
  throw std::invalid_argument("--loss=" + name +
                              "; it is none, huber or cauchy");
}

EstimatorOptions OptionsFromFlags() {
  EstimatorOptions options;
  options.known_poisson_ratio = Given("nu", FLAGS_nu);
  options.poisson_ratio = {Given("nu_min", FLAGS_nu_min),
                           Given("nu_max", FLAGS_nu_max)};
  options.youngs_modulus = {Given("youngs_min", FLAGS_youngs_min),
                            Given("youngs_max", FLAGS_youngs_max)};
  options.loss = LossNamed(FLAGS_loss);
  const std::string why_invalid = options.WhyInvalid();
  if (!why_invalid.empty()) {
    throw std::invalid_argument(why_invalid);
  }
  return options;
}

void CheckOutputs() {
  if (!FLAGS_json.empty() && FLAGS_json != "-") {
    CheckWritable(FLAGS_json);
  }
  if (!FLAGS_out.empty()) {
    CheckWritable(FLAGS_out);
  }
}

SceneReading Read(const std::vector<std::string>& arguments) {
  SceneReading reading =
      ReadScene({arguments.begin(), arguments.end()}, Measurement::kRequired);
  for (const std::string& notice : reading.notices) {
    LOG(WARNING) << notice;
  }
  if (IsGiven("noise_sd")) {
    if (!(FLAGS_noise_sd > 0)) {
      throw std::invalid_argument("--noise_sd must be positive");
    }
    for (LoadCase& load_case : reading.scene.load_cases) {
      load_case.noise_sd = FLAGS_noise_sd;
    }
  }
  return reading;
}

// The library does not know where the scene came from; the user wants to.
std::string Sources(const std::vector<std::string>& arguments) {
  std::string sources;
  for (const std::string& argument : arguments) {
    sources += (sources.empty() ? "" : ", ") + argument;
  }
  return sources;
}

}  // namespace

int RunEstimate(const std::vector<std::string>& arguments) {
  const Clock::time_point start = Clock::now();
  if (arguments.empty()) {
    throw std::invalid_argument(
        "estimate needs a scene file (.vtu, .vtk, .msh or .json)");
  }
  const std::unique_ptr<Estimator> estimator = MakeEstimator(FLAGS_estimator);
  EstimatorOptions options = OptionsFromFlags();
  ApplyComputingFlags();
  CheckOutputs();

  std::optional<Progress> progress("reading " + Sources(arguments));
  const SceneReading reading = Read(arguments);
  const double read_seconds = SecondsSince(start);

  progress->Show(FLAGS_estimator);
  options.on_factorization = [&progress](int count) {
    progress->Show(FLAGS_estimator + ": factorisation " +
                   std::to_string(count));
  };
  Estimate estimate;
  try {
    estimate = estimator->Run(reading.scene, options);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(Sources(arguments) + ": " + error.what());
  }
  if (!FLAGS_out.empty()) {
    progress->Show("writing " + FLAGS_out);
    WriteVtu(FLAGS_out, reading.scene.mesh,
             ResultFields(reading.scene, estimate));
  }
  progress.reset();

  if (!FLAGS_json.empty()) {
    const std::string report = JsonReport(estimate, reading.scene, options,
                                          {read_seconds, SecondsSince(start)});
    if (FLAGS_json == "-") {
      std::cout << report;
    } else {
      WriteWholeFile(FLAGS_json, report);
    }
  }
  if (FLAGS_json != "-") {
    std::cout << Summary(estimate, reading.scene);
  }
  return estimate.IsUsable() ? 0 : 1;
}

int RunEstimators(const std::vector<std::string>& arguments) {
  if (!arguments.empty()) {
    throw std::invalid_argument("estimators takes no arguments");
  }
  for (const std::string_view name : EstimatorNames()) {
    std::cout << name << std::string(16 - name.size(), ' ')
              << MakeEstimator(name)->Description() << "\n";
  }
  return 0;
}

void ApplyComputingFlags() {
  if (FLAGS_order != 1) {
    throw std::invalid_argument("--order=" + std::to_string(FLAGS_order) +
                                "; this version has linear elements only "
                                "(--order=1)");
  }
  if (FLAGS_threads < 0) {
    throw std::invalid_argument("--threads=" + std::to_string(FLAGS_threads) +
                                "; it must not be negative");
  }
  if (FLAGS_threads > 0) {
    SetBlasThreads(FLAGS_threads);
  }
}

}  // namespace elastimate
