#include <chrono>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "apps/commands.h"
#include "apps/estimator_flags.h"
#include "apps/flags.h"
#include "apps/linear_algebra.h"
#include "apps/outputs.h"
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

SceneReading Read(const std::vector<std::string>& arguments) {
  SceneReading reading =
      ReadScene({arguments.begin(), arguments.end()}, Measurement::kRequired);
  if (IsGiven("noise_sd")) {
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

Estimate RunEstimator(const Estimator& estimator, const Scene& scene,
                      const EstimatorOptions& options,
                      const std::string& sources) {
  try {
    return estimator.Run(scene, options);
  } catch (const std::invalid_argument& error) {
    const bool flags_are_to_blame =
        !estimator.WhyUnsupported(scene, options).empty() &&
        estimator.WhyUnsupported(scene, {}).empty();
    throw std::invalid_argument(
        (flags_are_to_blame ? GivenOptionFlags() : sources) + ": " +
        error.what());
  }
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
  if (IsGiven("noise_sd") && !(FLAGS_noise_sd > 0)) {
    throw std::invalid_argument(AsGiven("noise_sd") + "; it must be positive");
  }
  ApplyComputingFlags();
  CheckOutputFlags(arguments);

  std::optional<Progress> progress("reading " + Sources(arguments));
  const SceneReading reading = Read(arguments);
  const double read_seconds = SecondsSince(start);

  progress->Show(FLAGS_estimator);
  options.on_factorization = [&progress](int count) {
    progress->Show(FLAGS_estimator + ": factorisation " +
                   std::to_string(count));
  };
  const Estimate estimate =
      RunEstimator(*estimator, reading.scene, options, Sources(arguments));
  StagedFiles files;
  if (!FLAGS_out.empty()) {
    progress->Show("writing " + FLAGS_out);
    files.Add(FLAGS_out, VtuContent(FLAGS_out, reading.scene.mesh,
                                    ResultFields(reading.scene, estimate)));
  }
  progress.reset();

  const std::string report = JsonReport(estimate, reading.scene, options,
                                        {read_seconds, SecondsSince(start)});
  if (!FLAGS_json.empty() && FLAGS_json != "-") {
    files.Add(FLAGS_json, report);
  }
  WriteStandardOutput(FLAGS_json == "-" ? report
                                        : Summary(estimate, reading.scene));
  files.Commit();
  PrintNotices(reading.notices);
  return estimate.IsUsable() ? 0 : 1;
}

int RunEstimators(const std::vector<std::string>& arguments) {
  if (!arguments.empty()) {
    throw std::invalid_argument("estimators takes no arguments" +
                                ButGot(arguments));
  }
  std::string list;
  for (const std::string_view name : EstimatorNames()) {
    list += std::string(name) + std::string(16 - name.size(), ' ') +
            std::string(MakeEstimator(name)->Description()) + "\n";
  }
  WriteStandardOutput(list);
  return 0;
}

void ApplyComputingFlags() {
  if (FLAGS_order != 1) {
    throw std::invalid_argument(AsGiven("order") +
                                "; this version has linear elements only, "
                                "--order=1");
  }
  if (FLAGS_threads < 0) {
    throw std::invalid_argument(AsGiven("threads") +
                                "; it must not be negative");
  }
  if (FLAGS_threads > 0) {
    SetBlasThreads(FLAGS_threads);
  }
}

}  // namespace elastimate
