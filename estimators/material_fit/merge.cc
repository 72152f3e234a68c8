#include "elastimate/estimators/material_fit/merge.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

#include "elastimate/core/scene/observed_displacements.h"
#include "elastimate/core/text/numbers.h"
#include "elastimate/estimators/interface/finding_sentences.h"
#include "elastimate/estimators/interface/limits.h"
#include "elastimate/estimators/interface/parameter_judge.h"
#include "elastimate/estimators/material_fit/material_fit.h"
#include "elastimate/estimators/material_fit/outliers.h"

namespace elastimate {
namespace {

std::vector<int> RegionsOf(const std::vector<Material>& materials,
                           const std::vector<std::size_t>& group) {
  std::vector<int> regions;
  for (const std::size_t member : group) {
    regions.insert(regions.end(), materials[member].regions.begin(),
                   materials[member].regions.end());
  }
  std::sort(regions.begin(), regions.end());
  return regions;
}

// Whether a fit after these steps of a plan is as near to that of all apart as
// it said, or as the steps may be.
bool HoldsWhatWasPlanned(const MergePlan& plan, std::size_t num_steps,
                         const MaterialParameters& parameters,
                         const VariableEstimate& apart,
                         const MaterialFit& merged) {
  double allowed = 0;
  for (std::size_t i = 0; i < num_steps; ++i) {
    allowed += std::max(plan.path[i].chi_square, plan.path[i].limit);
  }
  const Eigen::VectorXd& variables = merged.errors.corrected;
  const PlannedMerge& last = plan.path[num_steps - 1];
  return merged.minimum && variables.size() == last.variables.size() &&
         DistanceOfGroups(last.groups, parameters, apart, variables) <= allowed;
}

// The regions of materials with a variable that is not determined, which no
// step of the plan compares.
std::vector<std::vector<int>> NotCompared(
    const std::vector<Material>& materials, const FreeParameters& free,
    const Eigen::MatrixXd& covariance, const MergePlan& plan) {
  const Eigen::VectorXd limits = LargestErrorsOfVariables(free);
  std::vector<bool> are_left_out(materials.size(), false);
  for (Eigen::Index i = 0; i < free.Size(); ++i) {
    if (!(std::sqrt(covariance(i, i)) <= limits(i))) {
      are_left_out[free.Free(i).material] = true;
    }
  }
  for (const PlannedMerge& step : plan.path) {
    for (const auto* const group : {&step.first, &step.second}) {
      for (const std::size_t member : *group) {
        are_left_out[member] = false;
      }
    }
  }
  std::vector<std::vector<int>> regions;
  for (std::size_t i = 0; i < materials.size(); ++i) {
    if (are_left_out[i]) {
      regions.push_back(materials[i].regions);
    }
  }
  return regions;
}

std::string WhyNotCompared(const MaterialFit& apart) {
  if (apart.minimum && apart.errors.total.size() > 0 &&
      apart.errors.total.allFinite() && apart.errors.variance > 0) {
    return "";
  }
  return apart.estimate.message.empty() ? "without noise there is no measure "
                                          "of how far materials have to differ"
                                        : apart.estimate.message;
}

// How many of the first steps of a plan a fit bears out.
std::size_t NumBorneOut(const MergePlan& plan, const Scene& scene,
                        const EstimatorOptions& options,
                        const MaterialParameters& parameters,
                        const VariableEstimate& apart, Work& work) {
  Scene merged = scene;
  for (std::size_t num_taken = plan.num_taken; num_taken > 0; --num_taken) {
    const PlannedMerge& last = plan.path[num_taken - 1];
    merged.materials = MaterialsOfGroups(scene.materials, last.groups);
    const MaterialFit fit =
        FitMaterialsFrom(last.variables, merged, options, Descent::kFull);
    work = work + fit.estimate.work;
    if (HoldsWhatWasPlanned(plan, num_taken, parameters, apart, fit)) {
      return num_taken;
    }
  }
  return 0;
}

// Adds this variance of its variable to that of a parameter.
void AddVariance(double variance, Eigen::Index place, Estimate& estimate) {
  ParameterEstimate& parameter = estimate.parameters[std::size_t(place)];
  if (variance == 0 || !parameter.standard_error) {
    return;
  }
  const double unit = parameter.is_modulus ? parameter.value : 1;
  double& of_parameter = estimate.parameter_covariance(place, place);
  of_parameter += variance * unit * unit;
  parameter.standard_error = std::sqrt(of_parameter);
  ParameterErrors& model = estimate.error_budget.model;
  if (model.size() > place) {
    model(place) = std::hypot(model(place), std::sqrt(variance));
  }
}

// The region that may be farthest off its material, in errors that this has.
struct FarthestRegion {
  std::vector<int> regions;
  double in_errors = 0;
  /// 95 %, of all parameters, zero for those of other materials.
  Eigen::VectorXd differences;

  void Look(const std::vector<int>& regions_of_member,
            const Eigen::VectorXd& errors, Eigen::Index first,
            const Estimate& estimate) {
    double farthest = 0;
    Eigen::VectorXd all = Eigen::VectorXd::Zero(
        static_cast<Eigen::Index>(estimate.parameters.size()));
    for (Eigen::Index k = 0, i = first; k < errors.size(); ++i) {
      const ParameterEstimate& parameter = estimate.parameters[std::size_t(i)];
      if (parameter.is_known) {
        continue;
      }
      all(i) = kTwoSidedErrors * errors(k);
      if (parameter.standard_error) {
        farthest = std::max(farthest, errors(k) * parameter.ErrorUnit() /
                                          *parameter.standard_error);
      }
      ++k;
    }
    if (farthest > in_errors) {
      *this = {regions_of_member, farthest, all};
    }
  }
};

// "3 % in E", of the largest of the parameters of one symbol.
std::vector<std::string> DifferencesInWords(
    const Estimate& estimate, const Eigen::VectorXd& differences) {
  std::vector<std::string> words;
  for (std::size_t i = 0; i < estimate.parameters.size(); ++i) {
    const ParameterEstimate& parameter = estimate.parameters[i];
    double largest = 0;
    bool is_first = true;
    for (std::size_t j = 0; j < estimate.parameters.size(); ++j) {
      if (estimate.parameters[j].symbol == parameter.symbol) {
        is_first = is_first && j >= i;
        largest = std::max(largest, differences(Eigen::Index(j)));
      }
    }
    if (is_first && largest > 0) {
      words.push_back(
          (parameter.is_modulus ? Percent(largest) : TwoDigits(largest)) +
          " in " + parameter.symbol);
    }
  }
  return words;
}

// Whether a region may be another one than its material by more than a user
// may take for its error: that of the material is that of what they share.
bool AreNotable(const Estimate& estimate, const Eigen::VectorXd& differences) {
  constexpr double kNotableOfModulus = 0.2;
  constexpr double kNotableOfRatio = 0.1;
  for (std::size_t i = 0; i < estimate.parameters.size(); ++i) {
    if (differences(Eigen::Index(i)) > (estimate.parameters[i].is_modulus
                                            ? kNotableOfModulus
                                            : kNotableOfRatio)) {
      return true;
    }
  }
  return false;
}

}  // namespace

MaterialMerge MergeMaterials(const Scene& scene,
                             const EstimatorOptions& options) {
  MaterialMerge merge;
  merge.materials = scene.materials;
  const MaterialFit apart =
      FitMaterialsFrom(std::nullopt, scene, options, Descent::kFull);
  merge.work = apart.estimate.work;
  merge.why_not = WhyNotCompared(apart);
  if (!merge.why_not.empty()) {
    return merge;
  }
  const FreeParameters free(scene, options);
  const VariableEstimate variables = {apart.errors.corrected,
                                      apart.errors.total};
  const auto num_observations =
      static_cast<double>(ObservedDisplacements(scene).Size());
  const MergePlan plan =
      PlanMerges(scene.materials, free.All(), LargestErrorsOfVariables(free),
                 variables, num_observations);
  const std::size_t num_taken =
      NumBorneOut(plan, WithoutOutliers(scene, apart.estimate.outliers),
                  options, free.All(), variables, merge.work);
  for (std::size_t i = 0; i < plan.path.size(); ++i) {
    const PlannedMerge& step = plan.path[i];
    merge.path.push_back({RegionsOf(scene.materials, step.first),
                          RegionsOf(scene.materials, step.second),
                          step.chi_square, step.limit, i < num_taken});
  }
  merge.not_compared =
      NotCompared(scene.materials, free, variables.covariance, plan);
  if (num_taken > 0) {
    const MaterialGroups& groups = plan.path[num_taken - 1].groups;
    merge.materials = MaterialsOfGroups(scene.materials, groups);
    merge.spreads = SpreadOfMembers(groups, free.All(), variables,
                                    apart.errors.of_noise, num_observations);
    for (const std::vector<std::size_t>& group : groups) {
      merge.members.emplace_back();
      for (const std::size_t member : group) {
        merge.members.back().push_back(scene.materials[member].regions);
      }
    }
  }
  return merge;
}

void EnterMerge(const MaterialMerge& merge, Estimate& estimate) {
  estimate.merges = merge.path;
  estimate.work = estimate.work + merge.work;
  if (!merge.not_compared.empty()) {
    std::vector<std::string> regions;
    for (const std::vector<int>& not_compared : merge.not_compared) {
      regions.push_back(RegionsLabel(not_compared));
    }
    estimate.Add(RegionsNotCompared(regions));
  }
  if (estimate.parameters.empty()) {
    return;
  }
  Eigen::Index place = 0;
  Eigen::VectorXd differences =
      Eigen::VectorXd::Zero(Eigen::Index(estimate.parameters.size()));
  FarthestRegion farthest;
  for (std::size_t i = 0; i < merge.spreads.size(); ++i) {
    const MemberSpread& spread = merge.spreads[i];
    const Eigen::Index first = place;
    for (Eigen::Index k = 0; k < spread.variance.size(); ++k) {
      while (estimate.parameters[std::size_t(place)].is_known) {
        ++place;
      }
      differences(place) = spread.largest_differences(k);
      AddVariance(spread.variance(k), place, estimate);
      ++place;
    }
    for (std::size_t j = 0; j < merge.members[i].size(); ++j) {
      farthest.Look(merge.members[i][j], spread.errors.col(Eigen::Index(j)),
                    first, estimate);
    }
    if (i < estimate.materials.size() && spread.largest_differences.any()) {
      estimate.materials[i].largest_differences = {
          spread.largest_differences.begin(), spread.largest_differences.end()};
    }
  }
  JudgeGrownErrors(estimate);
  EnterElasticity(estimate);
  constexpr double kManyErrors = 3;
  if (farthest.in_errors > kManyErrors) {
    estimate.Add(
        RegionMayBeAnother(RegionsLabel(farthest.regions),
                           DifferencesInWords(estimate, farthest.differences)));
    return;
  }
  const std::vector<std::string> words =
      DifferencesInWords(estimate, differences);
  if (!words.empty()) {
    estimate.Add(RegionsMayDiffer(words, AreNotable(estimate, differences)
                                             ? Severity::kWarning
                                             : Severity::kNotice));
  }
}

}  // namespace elastimate
