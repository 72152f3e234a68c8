#include <chrono>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <functional>
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
#include "apps/series.h"
#include "elastimate/core/materials/isotropic_law.h"
#include "elastimate/estimators/material_fit/fitted_scene.h"
#include "elastimate/estimators/material_fit/law_choice.h"
#include "elastimate/estimators/material_fit/merge.h"
#include "elastimate/estimators/registry.h"
#include "elastimate/estimators/series/joint_estimate.h"
#include "elastimate/io/report/html_report.h"
#include "elastimate/io/report/report.h"
#include "elastimate/io/report/scene_results.h"
#include "elastimate/io/report/series_table.h"
#include "elastimate/io/report/summary.h"
#include "elastimate/io/scene/scene_reader.h"
#include "elastimate/io/text/file_output.h"
#include "elastimate/io/text/printable.h"
#include "elastimate/io/vtk/vtu_writer.h"

namespace elastimate {
namespace {

using Clock = std::chrono::steady_clock;

// The page that a report is, in place of the fields of an estimate.
struct Page {
  std::string without_data;  // That of ReadPage.
  std::string command;
};

// Makes the page of a report.
using PageOf = std::function<std::string(const std::string& report)>;

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
EstimatorOptions CheckFlags(const std::vector<std::string>& arguments,
                            OutFormats formats) {
  EstimatorOptions options = OptionsFromFlags();
  OriginFromFlag();
  if (IsGiven("noise_sd") && !(FLAGS_noise_sd > 0)) {
    throw std::invalid_argument(AsGiven("noise_sd") + "; it must be positive");
  }
  static_cast<void>(FieldFromFlag());
  ApplyComputingFlags();
  CheckOutputFlags(arguments, formats);
  return options;
}

// Writes the report to where the flags say, together with the other files and,
// where there is one, the page that it is a part of.
void WriteReport(const Estimate& estimate, const Scene& scene,
                 const EstimatorOptions& options, const ReportTimes& times,
                 const std::vector<std::string>& notices, const PageOf& page,
                 StagedFiles& files) {
  const std::string report =
      JsonReport(estimate, scene, options, times, notices);
  if (page) {
    files.Add(FLAGS_out, page(report));
  }
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
void CheckSeries(const FrameSeries& series, bool has_page) {
  for (const std::string flag : {"out", "order"}) {
    if (IsGiven(flag) && (flag == "order" ? FLAGS_order != 1 : !has_page)) {
      throw std::invalid_argument(AsGiven(flag) +
                                  " cannot be used with a scene of several "
                                  "frames; leave it out, or make "
                                  "a scene of one frame");
    }
  }
  for (const std::string* output : {&FLAGS_series, &FLAGS_json, &FLAGS_out}) {
    for (const std::filesystem::path& file : series.files) {
      if (!output->empty() && AreSameFile(*output, file)) {
        throw std::invalid_argument(PrintablePath(*output) +
                                    " would overwrite a frame; choose another "
                                    "file");
      }
    }
  }
}

// Returns the usable frame of the largest load; empty where none is usable.
std::optional<std::size_t> FrameOfLargestLoad(
    const std::vector<FrameEstimate>& frames) {
  std::optional<std::size_t> found;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (frames[i].estimate.IsUsable() &&
        (!found || std::abs(frames[i].load) > std::abs(frames[*found].load))) {
      found = i;
    }
  }
  return found;
}

// Estimates from the frames of a scene, and from all of them together.
int RunSeries(const std::vector<std::string>& arguments,
              const Estimator& estimator, SceneReading reading,
              const EstimatorOptions& options, double read_seconds,
              Clock::time_point start, const Page* page,
              std::optional<Progress>& progress) {
  const FrameSeries& series = *reading.frames;
  CheckSeries(series, page != nullptr);
  const std::vector<FrameEstimate> frames = EstimateFrames(
      estimator, reading.scene, series, options,
      [&progress](const std::string& what) { progress->Show(what); });
  if (frames.empty()) {
    return kFramesSent;
  }
  const Estimate joint = JointEstimate(reading.scene, options, estimator,
                                       frames, series.load_error);
  progress.reset();
  StagedFiles files;
  const std::string table = SeriesTable(series, frames, joint);
  if (!FLAGS_series.empty()) {
    files.Add(FLAGS_series, table);
  }
  const auto page_of = [&](const std::string& report) {
    const std::optional<std::size_t> shown = FrameOfLargestLoad(frames);
    if (!shown) {
      return HtmlReport(page->without_data, reading.scene, joint, {},
                        {Sources(arguments), page->command, report, table});
    }
    const Estimate& estimate = frames[*shown].estimate;
    Scene scene = reading.scene;
    scene.load_cases = {series.read(*shown)};
    const std::optional<Scene> fitted = FittedScene(scene, estimate);
    if (!estimate.large_strain_law.empty()) {
      scene.materials = fitted->materials;
    }
    return HtmlReport(
        page->without_data, scene, estimate,
        ResultsOf(scene, fitted ? *fitted : scene, estimate, options.solver),
        {Sources(arguments), page->command, report, table, *shown + 1});
  };
  WriteReport(joint, reading.scene, options,
              {read_seconds, SecondsSince(start)}, reading.notices,
              page == nullptr ? nullptr : PageOf(page_of), files);
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
           Clock::time_point start, const Page* page,
           std::optional<Progress>& progress) {
  RefuseOnOtherRanks();
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
  SceneResults results;
  if (!FLAGS_out.empty()) {
    progress->Show("writing " + PrintablePath(FLAGS_out));
    results = ResultsOf(scene, reported, estimate, options.solver);
  }
  if (!FLAGS_out.empty() && page == nullptr) {
    files.Add(FLAGS_out, VtuContent(FLAGS_out, scene.mesh, results.fields,
                                    reading.file_order));
  }
  const auto page_of = [&](const std::string& report) {
    return HtmlReport(page->without_data, scene, estimate, results,
                      {Sources(arguments), page->command, report, ""});
  };
  progress.reset();
  for (const std::string& sentence : OutlierLines(estimate.outliers, reading)) {
    reading.notices.push_back(sentence);
  }
  WriteReport(estimate, reported, options, {read_seconds, SecondsSince(start)},
              reading.notices, page == nullptr ? nullptr : PageOf(page_of),
              files);
  return estimate.IsUsable() ? 0 : 1;
}

// Estimates from a scene, and writes a page where there is one to fill.
int Run(const std::vector<std::string>& arguments, const Page* page) {
  const Clock::time_point start = Clock::now();
  if (arguments.empty()) {
    throw std::invalid_argument(
        std::string(page == nullptr ? "estimate" : "report") +
        " needs a scene file; name a .json, .vtu, .pvtu, .vtk or .msh file");
  }
  const std::shared_ptr<const Estimator> estimator =
      MakeEstimator(Printable(FLAGS_estimator));
  EstimatorOptions options = CheckFlags(
      arguments, page == nullptr ? OutFormats::kVtu : OutFormats::kPage);

  std::optional<Progress> progress("reading " + Sources(arguments));
  SceneReading reading = ReadMeasuredScene(arguments);
  if (ChoosesLaw()) {
    CheckLawChoice(reading, options);
  }
  GiveKnownPoissonRatio(reading.scene, options);
  if (MergesRegions()) {
    CheckMerging(reading);
  }
  const double read_seconds = SecondsSince(start);
  if (reading.frames) {
    return RunSeries(arguments, *estimator, std::move(reading), options,
                     read_seconds, start, page, progress);
  }
  if (!FLAGS_series.empty()) {
    throw std::invalid_argument(
        AsGiven("series") + " needs a scene of several frames, and " +
        Sources(arguments) +
        " has none; give the key \"frames\" in a scene.json, or leave the flag "
        "out");
  }
  return RunOne(arguments, *estimator, std::move(reading), options,
                read_seconds, start, page, progress);
}

}  // namespace

int RunEstimate(const std::vector<std::string>& arguments) {
  return Run(arguments, nullptr);
}

int RunReport(const std::vector<std::string>& arguments,
              const std::string& command) {
  if (FLAGS_out.empty()) {
    throw std::invalid_argument("report needs --out=FILE.html");
  }
  const Page page = {ReadPage(), command};
  return Run(arguments, &page);
}

void ApplyComputingFlags() {
  CheckOrderFlag();
  if (FLAGS_threads < 0) {
    throw std::invalid_argument(AsGiven("threads") +
                                "; it must not be negative");
  }
  if (FLAGS_threads > 0) {
    SetThreads(FLAGS_threads);
  }
}

}  // namespace elastimate
