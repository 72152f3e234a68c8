#include "elastimate/io/report/validation_report.h"

#include <nlohmann/json.hpp>

#include "elastimate/core/package/version.h"
#include "elastimate/io/report/json_number.h"
#include "elastimate/io/text/printable.h"

namespace elastimate {
namespace {

using ValidationJson = nlohmann::ordered_json;

ValidationJson PredictionJson(const Prediction& prediction) {
  return {{"values", prediction.num_values},
          {"rms_error", OrNull(prediction.RmsError())},
          {"relative_error", OrNull(prediction.RelativeError())},
          {"error_ratio", OrNull(prediction.ErrorRatio())},
          {"is_off", prediction.IsOff()}};
}

ValidationJson FoldJson(const std::string& name, const FoldPrediction& fold) {
  ValidationJson parameters = ValidationJson::array();
  for (const ParameterEstimate& parameter : fold.estimate.parameters) {
    parameters.push_back(
        {{"name", parameter.name},
         {"regions", parameter.regions},
         {"value", OrNull(parameter.value)},
         {"standard_error", OrNull(parameter.standard_error)}});
  }
  ValidationJson json = {
      {"held_out", name},
      {"status", StatusName(fold.estimate.status)},
      {"message",
       Printable(fold.why_not.empty() ? fold.estimate.message : fold.why_not,
                 kLongestSentence)},
      {"parameters", parameters}};
  json.update(PredictionJson(fold.prediction));
  return json;
}

}  // namespace

std::string JsonValidation(const Folds& folds,
                           const std::vector<std::string>& models,
                           const std::vector<CrossValidation>& validations,
                           const std::vector<std::string>& notices) {
  ValidationJson list = ValidationJson::array();
  for (std::size_t i = 0; i < models.size(); ++i) {
    ValidationJson of_folds = ValidationJson::array();
    for (std::size_t f = 0; f < validations[i].folds.size(); ++f) {
      of_folds.push_back(FoldJson(folds.names[f], validations[i].folds[f]));
    }
    ValidationJson model = {{"name", models[i]},
                            {"complete", validations[i].IsComplete()}};
    model.update(PredictionJson(validations[i].Total()));
    model["folds"] = of_folds;
    list.push_back(model);
  }
  ValidationJson sentences = ValidationJson::array();
  for (const std::string& notice : notices) {
    sentences.push_back(Printable(notice, kLongestSentence));
  }
  return ValidationJson({{"elastimate", Version()},
                         {"models", list},
                         {"notices", sentences}})
             .dump(2) +
         "\n";
}

}  // namespace elastimate
