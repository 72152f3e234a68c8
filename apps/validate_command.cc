#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "apps/commands.h"
#include "apps/element_order.h"
#include "apps/estimator_flags.h"
#include "apps/flags.h"
#include "apps/material_flags.h"
#include "apps/measured_scene.h"
#include "apps/outputs.h"
#include "apps/progress.h"
#include "apps/section_flags.h"
#include "apps/series.h"
#include "apps/validation_models.h"
#include "apps/validation_summary.h"
#include "elastimate/estimators/registry.h"
#include "elastimate/estimators/validation/cross_validation.h"
#include "elastimate/io/report/validation_report.h"
#include "elastimate/io/text/file_output.h"
#include "elastimate/io/text/printable.h"
#include "elastimate/io/vtk/vtu_writer.h"

namespace elastimate {
namespace {

HeldOutPart HeldOutPartFromFlag() {
  if (FLAGS_hold_out == "points") {
    return HeldOutPart::kPoints;
  }
  if (FLAGS_hold_out == "load_cases") {
    return HeldOutPart::kLoadCases;
  }
  if (!FLAGS_hold_out.empty()) {
    throw std::invalid_argument(AsGiven("hold_out") +
                                "; it must be points or load_cases");
  }
  return HeldOutPart::kAutomatic;
}

// Checks all flags before anything is read, and returns the options of theirs.
EstimatorOptions CheckValidateFlags(const std::vector<std::string>& arguments) {
  if (arguments.empty()) {
    throw std::invalid_argument(
        "validate needs a scene file; name a .json, .vtu, .pvtu, .vtk or .msh "
        "file");
  }
  if (FLAGS_folds < 2) {
    throw std::invalid_argument(AsGiven("folds") + "; it must be 2 or more");
  }
  if (ChoosesLaw()) {
    throw std::invalid_argument(AsGiven("material") +
                                ": validate compares laws that are named; "
                                "give --compare=LAW,LAW,...");
  }
  CheckNoMerging();
  ApplyComputingFlags();
  CheckOutputFlags(arguments);
  return OptionsFromFlags();
}

// Makes each frame of a series a load case.
void JoinFrames(SceneReading& reading) {
  if (!reading.frames) {
    return;
  }
  reading.scene.load_cases.clear();
  for (std::size_t i = 0; i < reading.frames->files.size(); ++i) {
    reading.scene.load_cases.push_back(ReadFrame(*reading.frames, i));
  }
}

Fields ErrorFields(const Scene& scene, const CrossValidation& validation) {
  Fields fields = SceneFields(scene);
  for (std::size_t k = 0; k < validation.errors.size(); ++k) {
    const std::string suffix = CaseSuffix(k);
    const PredictionErrors& errors = validation.errors[k];
    fields.point.push_back({"prediction_error" + suffix, errors.of_nodes});
    fields.point.push_back(
        {"prediction_error_ratio" + suffix, errors.standardised_of_nodes});
  }
  return fields;
}

// The cross-validations of some models.
struct ComparedModels {
  Folds folds;
  std::vector<std::string> names;
  std::vector<CrossValidation> validations;
};

ComparedModels Compare(const Estimator& estimator, const Scene& scene,
                       const EstimatorOptions& options, HeldOutPart part,
                       const std::string& sources, Progress& progress) {
  ComparedModels compared;
  std::string source = sources;
  try {
    compared.folds = DivideMeasurement(scene, part, FLAGS_folds);
    for (const ValidationModel& model : ModelsToCompare(scene, options)) {
      if (!compared.names.empty()) {
        source = sources + " as " + Printable(model.name);
      }
      compared.validations.push_back(CrossValidate(
          model.scene, compared.folds, estimator, model.options, [&](int fold) {
            progress.Show("predicting " + compared.folds.names[fold] + " (" +
                          model.name + ")");
          }));
      compared.names.push_back(model.name);
    }
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(source + ": " + error.what());
  }
  return compared;
}

}  // namespace

int RunValidate(const std::vector<std::string>& arguments) {
  const HeldOutPart part = HeldOutPartFromFlag();
  const EstimatorOptions options = CheckValidateFlags(arguments);
  const std::shared_ptr<const Estimator> estimator =
      MakeEstimator(IsGiven("estimator") ? Printable(FLAGS_estimator) : "auto");
  const std::string sources = Sources(arguments);
  std::optional<Progress> progress("reading " + sources);
  SceneReading reading = ReadMeasuredScene(arguments);
  JoinFrames(reading);
  const std::optional<Scene> quadratic =
      QuadraticSceneIfAsked(sources, reading.scene, reading.notices);
  const ComparedModels compared =
      Compare(*estimator, quadratic ? *quadratic : reading.scene, options, part,
              sources, *progress);
  const CrossValidation& first = compared.validations.front();
  StagedFiles files;
  if (!FLAGS_out.empty()) {
    files.Add(FLAGS_out, VtuContent(FLAGS_out, reading.scene.mesh,
                                    ErrorFields(reading.scene, first),
                                    reading.file_order));
  }
  progress.reset();
  const std::string report = JsonValidation(
      compared.folds, compared.names, compared.validations, reading.notices);
  if (!FLAGS_json.empty() && FLAGS_json != "-") {
    files.Add(FLAGS_json, report);
  }
  WriteStandardOutput(FLAGS_json == "-"
                          ? report
                          : ValidationSummary(compared.folds, compared.names,
                                              compared.validations));
  files.Commit();
  PrintNotices(reading.notices);
  return first.IsComplete() && !first.IsOff() ? 0 : 1;
}

}  // namespace elastimate
