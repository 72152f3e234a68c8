#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "apps/commands.h"
#include "apps/element_order.h"
#include "apps/estimator_flags.h"
#include "apps/flags.h"
#include "apps/law_choice.h"
#include "apps/linear_algebra.h"
#include "apps/material_flags.h"
#include "apps/measured_scene.h"
#include "apps/outlier_lines.h"
#include "apps/outputs.h"
#include "apps/progress.h"
#include "apps/result_fields.h"
#include "apps/series.h"
#include "elastimate/core/materials/isotropic_law.h"
#include "elastimate/estimators/material_fit/fitted_scene.h"
#include "elastimate/estimators/material_fit/law_choice.h"
#include "elastimate/estimators/material_fit/merge.h"
#include "elastimate/estimators/registry.h"
#include "elastimate/estimators/series/joint_estimate.h"
#include "elastimate/io/report/report.h"
#include "elastimate/io/report/series_table.h"
#include "elastimate/io/report/summary.h"
#include "elastimate/io/scene/scene_reader.h"
#include "elastimate/io/text/file_output.h"
#include "elastimate/io/text/printable.h"
#include "elastimate/io/vtk/vtu_writer.h"

namespace elastimate {
namespace {

using Clock = std::chrono::steady_clock;

double SecondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

bool MergesRegions() { return FLAGS_regions == "merge"; }

// Returns what of the command line the estimator cannot serve: the scene,
// unless other flags would help.
std::string WhatToBlame(const Estimator& estimator, const Scene& scene,
                        const Scene& modelled, const EstimatorOptions& options,
                        const std::string& sources) {
  if (estimator.WhyUnsupported(modelled, options).empty()) {
    return sources;
  }
  if (estimator.WhyUnsupported(scene, options).empty()) {
    return AsGiven("order");
  }
  return estimator.WhyUnsupported(scene, {}).empty() ? GivenOptionFlags()
                                                     : sources;
}

// `modelled` is `scene` at the element order that was asked for.
Estimate RunEstimator(const Estimator& estimator, const Scene& scene,
                      const Scene& modelled, const EstimatorOptions& options,
                      const std::string& sources) {
  try {
    return estimator.Run(modelled, options);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(
        WhatToBlame(estimator, scene, modelled, options, sources) + ": " +
        error.what());
  }
}

// Returns the options of the flags, all of which are checked before anything is
// read.
EstimatorOptions CheckFlags(const std::vector<std::string>& arguments) {
  EstimatorOptions options = OptionsFromFlags();
  OriginFromFlag();
  if (IsGiven("noise_sd") && !(FLAGS_noise_sd > 0)) {
    throw std::invalid_argument(AsGiven("noise_sd") + "; it must be positive");
  }
  if (IsGiven("map") && FLAGS_map != "youngs_modulus") {
    throw std::invalid_argument(AsGiven("map") + "; it must be youngs_modulus");
  }
  if (IsGiven("map") && (ChoosesLaw() || MergesRegions())) {
    throw std::invalid_argument(
        "--map is for one isotropic material; leave out --material=auto and "
        "--regions=merge");
  }
  ApplyComputingFlags();
  CheckOutputFlags(arguments);
  return options;
}

// Writes the report to where the flags say, together with the other files.
void WriteReport(const Estimate& estimate, const Scene& scene,
                 const EstimatorOptions& options, const ReportTimes& times,
                 const std::vector<std::string>& notices, StagedFiles& files) {
  const std::string report =
      JsonReport(estimate, scene, options, times, notices);
  if (!FLAGS_json.empty() && FLAGS_json != "-") {
    files.Add(FLAGS_json, report);
  }
  WriteStandardOutput(FLAGS_json == "-" ? report
                                        : Summary(estimate, scene, times));
  files.Commit();
  PrintNotices(notices);
}

// Throws for flags that do not go with a series, and for places where its table
// may not go.
void CheckSeries(const FrameSeries& series) {
  for (const std::string flag : {"out", "order"}) {
    if (IsGiven(flag) && (flag != "order" || FLAGS_order != 1)) {
      throw std::invalid_argument(AsGiven(flag) +
                                  " cannot be used with a scene of several "
                                  "frames; leave it out, or make "
                                  "a scene of one frame");
    }
  }
  for (const std::string* output : {&FLAGS_series, &FLAGS_json}) {
    for (const std::filesystem::path& file : series.files) {
      if (!output->empty() && AreSameFile(*output, file)) {
        throw std::invalid_argument(PrintablePath(*output) +
                                    " would overwrite a frame; choose another "
                                    "file");
      }
    }
  }
}

// Estimates from the frames of a scene, and from all of them together.
int RunSeries(const Estimator& estimator, SceneReading reading,
              const EstimatorOptions& options, double read_seconds,
              Clock::time_point start, std::optional<Progress>& progress) {
  const FrameSeries& series = *reading.frames;
  CheckSeries(series);
  const std::vector<FrameEstimate> frames = EstimateFrames(
      estimator, reading.scene, series, options,
      [&progress](const std::string& what) { progress->Show(what); });
  const Estimate joint = JointEstimate(reading.scene, options, estimator,
                                       frames, series.load_error);
  progress.reset();
  StagedFiles files;
  if (!FLAGS_series.empty()) {
    files.Add(FLAGS_series, SeriesTable(series, frames, joint));
  }
  WriteReport(joint, reading.scene, options,
              {read_seconds, SecondsSince(start)}, reading.notices, files);
  return joint.IsUsable() ? 0 : 1;
}

// Throws for what does not go with merging, which compares fits of one
// measurement of isotropic materials.
void CheckMerging(const SceneReading& reading) {
  if (FLAGS_estimator != "iterative-fe" && FLAGS_estimator != "auto") {
    throw std::invalid_argument(
        AsGiven("regions") +
        " compares fits of displacements; give --estimator=iterative-fe or "
        "--estimator=auto");
  }
  if (HasPriors(reading.scene.materials)) {
    throw std::invalid_argument(
        AsGiven("regions") +
        " compares regions by the measurement alone; leave out the key "
        "\"prior\"");
  }
  if (reading.frames) {
    throw std::invalid_argument(
        AsGiven("regions") +
        " cannot be used with a scene of several frames; leave it out, or make "
        "a scene of one frame");
  }
  if (!AreIsotropic(reading.scene.materials)) {
    throw std::invalid_argument(AsGiven("regions") +
                                " compares isotropic materials only, and the "
                                "scene has others; leave it "
                                "out");
  }
}

// Gives both scenes the materials that the measurement tells apart.
MaterialMerge MergeRegions(const Estimator& estimator,
                           const EstimatorOptions& options,
                           const std::string& sources, Scene& modelled,
                           Scene& scene, std::vector<std::string>& notices) {
  const std::string why_not = estimator.WhyUnsupported(modelled, options);
  if (!why_not.empty()) {
    throw std::invalid_argument(sources + ": " + why_not);
  }
  MaterialMerge merge = MergeMaterials(modelled, options);
  if (!merge.why_not.empty()) {
    notices.push_back(sources + ": the regions could not be compared (" +
                      merge.why_not + "), so none were merged");
  }
  modelled.materials = merge.materials;
  scene.materials = merge.materials;
  return merge;
}

// Estimates from one measurement.
int RunOne(const std::vector<std::string>& arguments,
           const Estimator& estimator, SceneReading reading,
           EstimatorOptions options, double read_seconds,
           Clock::time_point start, std::optional<Progress>& progress) {
  Scene& scene = reading.scene;
  std::optional<Scene> quadratic =
      QuadraticSceneIfAsked(Sources(arguments), scene, reading.notices);
  Scene& modelled = quadratic ? *quadratic : scene;

  progress->Show(FLAGS_estimator);
  options.on_factorization = [&progress](int count) {
    progress->Show(FLAGS_estimator + ": factorisation " +
                   std::to_string(count));
  };
  std::optional<MaterialMerge> merge;
  if (MergesRegions()) {
    merge = MergeRegions(estimator, options, Sources(arguments), modelled,
                         scene, reading.notices);
  }
  std::optional<ChosenLaw> law;
  if (ChoosesLaw()) {
    // The notices are shown now, for users who would not wait for the rest.
    progress.reset();
    PrintNotices(NoticesOfLawChoice(modelled));
    progress.emplace("comparing laws");
    law = GiveChosenLaw(options, Sources(arguments), modelled, scene,
                        reading.notices);
  }
  Estimate estimate =
      RunEstimator(estimator, scene, modelled, options, Sources(arguments));
  if (merge) {
    EnterMerge(*merge, estimate);
  }
  if (law) {
    EnterLawChoice(*law, estimate);
  }
  const std::optional<Scene> fitted = FittedScene(modelled, estimate);
  const Scene& reported = fitted ? *fitted : modelled;
  if (!estimate.large_strain_law.empty()) {
    scene.materials = reported.materials;
  }
  StagedFiles files;
  if (!FLAGS_out.empty()) {
    progress->Show("writing " + PrintablePath(FLAGS_out));
    files.Add(FLAGS_out, VtuContent(FLAGS_out, scene.mesh,
                                    ResultFields(scene, reported, estimate,
                                                 options.solver),
                                    reading.file_order));
  }
  progress.reset();
  for (const std::string& sentence :
       OutlierLines(estimate.outliers, reading.measured_lines)) {
    reading.notices.push_back(sentence);
  }
  WriteReport(estimate, reported, options, {read_seconds, SecondsSince(start)},
              reading.notices, files);
  return estimate.IsUsable() ? 0 : 1;
}

}  // namespace

int RunEstimate(const std::vector<std::string>& arguments) {
  const Clock::time_point start = Clock::now();
  if (arguments.empty()) {
    throw std::invalid_argument(
        "estimate needs a scene file; name a .json, .vtu, .vtk or .msh file");
  }
  const std::shared_ptr<const Estimator> estimator =
      MakeEstimator(Printable(FLAGS_estimator));
  EstimatorOptions options = CheckFlags(arguments);

  std::optional<Progress> progress("reading " + Sources(arguments));
  SceneReading reading = ReadMeasuredScene(arguments);
  if (ChoosesLaw()) {
    CheckLawChoice(reading, options);
  }
  if (!FLAGS_map.empty()) {
    GiveField(FLAGS_map, reading.scene.materials);
  }
  GiveKnownPoissonRatio(reading.scene, options);
  if (MergesRegions()) {
    CheckMerging(reading);
  }
  const double read_seconds = SecondsSince(start);
  if (reading.frames) {
    return RunSeries(*estimator, std::move(reading), options, read_seconds,
                     start, progress);
  }
  if (!FLAGS_series.empty()) {
    throw std::invalid_argument(
        AsGiven("series") + " needs a scene of several frames, and " +
        Sources(arguments) +
        " has none; give the key \"frames\" in a scene.json, or leave the flag "
        "out");
  }
  return RunOne(arguments, *estimator, std::move(reading), options,
                read_seconds, start, progress);
}

void ApplyComputingFlags() {
  CheckOrderFlag();
  if (FLAGS_threads < 0) {
    throw std::invalid_argument(AsGiven("threads") +
                                "; it must not be negative");
  }
  if (FLAGS_threads > 0) {
    SetBlasThreads(FLAGS_threads);
  }
}

}  // namespace elastimate
