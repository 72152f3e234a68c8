#include "elastimate/io/report/plan_report.h"

#include <nlohmann/json.hpp>

#include "elastimate/core/package/version.h"
#include "elastimate/io/report/json_number.h"
#include "elastimate/io/text/printable.h"

namespace elastimate {
namespace {

using PlanJson = nlohmann::ordered_json;

PlanJson ErrorsJson(const LoadPlan& plan, const ExpectedErrors& errors) {
  PlanJson of_parameters = PlanJson::array();
  for (const double error : errors.OfParameters()) {
    of_parameters.push_back(OrNull(error));
  }
  const Eigen::VectorXd worst = errors.directions.col(0);
  return {{"standard_errors", of_parameters},
          {"determined", plan.AreDetermined(errors)},
          {"undetermined_combinations", errors.NumUndetermined()},
          {"worst_combination",
           {{"standard_error", OrNull(errors.standard_errors(0))},
            {"direction", std::vector<double>(worst.begin(), worst.end())},
            {"text", CombinationInWords(worst, plan.Free())}}}};
}

PlanJson FreeParametersJson(const LoadPlan& plan) {
  PlanJson list = PlanJson::array();
  for (const ParameterEstimate& parameter : plan.Free()) {
    const std::vector<int>& regions = parameter.regions;
    list.push_back({{"name", parameter.name},
                    {"region", regions.empty()       ? PlanJson(nullptr)
                               : regions.size() == 1 ? PlanJson(regions[0])
                                                     : PlanJson(regions)},
                    {"value", parameter.value}});
  }
  return list;
}

PlanJson CandidateJson(std::size_t place, const std::optional<double>& factor,
                       const PlanBasis& basis,
                       const std::vector<CandidateLoad>& candidates) {
  const CandidateLoad& candidate = candidates[place];
  const int load_case = basis.load_case_of_candidate[place];
  return {
      {"name", candidate.name},
      {"load_case", load_case == 0 ? PlanJson(nullptr) : PlanJson(load_case)},
      {"size", candidate.is_free_in_size && basis.is_scale_known && factor
                   ? PlanJson(*factor)
                   : PlanJson(nullptr)}};
}

PlanJson LoadJson(const LoadPlan& plan, const PlannedLoad& load,
                  const PlanBasis& basis,
                  const std::vector<CandidateLoad>& candidates) {
  PlanJson json = CandidateJson(load.candidate, load.factor, basis, candidates);
  json.update(ErrorsJson(plan, load.errors));
  json["standard_error_of_worst_before"] =
      OrNull(load.errors.Along(plan.before.directions.col(0)));
  return json;
}

PlanJson SentencesJson(const std::vector<std::string>& notices) {
  PlanJson sentences = PlanJson::array();
  for (const std::string& notice : notices) {
    sentences.push_back(Printable(notice, kLongestSentence));
  }
  return sentences;
}

PlanJson RelativeNoiseJson(const PlanBasis& basis) {
  return basis.noise_sd ? PlanJson(nullptr) : PlanJson(basis.relative_noise);
}

PlanJson ErrorsOfEstimateJson(const PlanBasis& basis) {
  if (basis.errors_of_estimate.empty()) {
    return nullptr;
  }
  PlanJson errors = PlanJson::array();
  for (const double error : basis.errors_of_estimate) {
    errors.push_back(OrNull(error));
  }
  return errors;
}

}  // namespace

std::string JsonPlan(const LoadPlan& plan, const PlanBasis& basis,
                     const std::vector<CandidateLoad>& candidates,
                     const std::vector<std::string>& notices) {
  PlanJson loads = PlanJson::array();
  for (const PlannedLoad& load : plan.loads) {
    loads.push_back(LoadJson(plan, load, basis, candidates));
  }
  PlanJson sequence = PlanJson::array();
  for (const PlannedLoad& load : plan.sequence) {
    sequence.push_back(LoadJson(plan, load, basis, candidates));
  }
  const PlanJson report = {
      {"elastimate", Version()},
      {"parameters", FreeParametersJson(plan)},
      {"parameters_from", basis.parameters},
      {"noise_sd", OrNull(basis.noise_sd)},
      {"relative_noise", RelativeNoiseJson(basis)},
      {"before", PlanJson({{"load_cases", basis.load_cases},
                           {"measured", basis.is_measured}})},
      {"candidates", loads},
      {"sequence", sequence},
      {"notices", SentencesJson(notices)}};
  PlanJson complete = report;
  complete["before"].update(ErrorsJson(plan, plan.before));
  complete["before"]["standard_errors_of_estimate"] =
      ErrorsOfEstimateJson(basis);
  return complete.dump(2) + "\n";
}

std::string JsonMapPlan(const MapPlan& plan, const PlanBasis& basis,
                        const std::vector<CandidateLoad>& candidates,
                        const std::vector<std::string>& notices) {
  PlanJson loads = PlanJson::array();
  for (const PlannedMapLoad& load : plan.loads) {
    loads.push_back(
        CandidateJson(load.candidate, load.factor, basis, candidates));
    loads.back()["supported_parameters"] = load.supported_parameters;
  }
  const PlanJson report = {{"elastimate", Version()},
                           {"map", "youngs_modulus"},
                           {"parameters_from", basis.parameters},
                           {"noise_sd", OrNull(basis.noise_sd)},
                           {"relative_noise", RelativeNoiseJson(basis)},
                           {"before",
                            {{"load_cases", basis.load_cases},
                             {"measured", basis.is_measured},
                             {"supported_parameters", plan.supported_before}}},
                           {"candidates", loads},
                           {"notices", SentencesJson(notices)}};
  return report.dump(2) + "\n";
}

}  // namespace elastimate
