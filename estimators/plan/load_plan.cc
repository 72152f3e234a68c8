#include "elastimate/estimators/plan/load_plan.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <stdexcept>
#include <utility>

#include "elastimate/core/materials/material_parameters.h"
#include "elastimate/core/scene/loads.h"
#include "elastimate/core/scene/rigid_motion.h"
#include "elastimate/estimators/interface/limits.h"
#include "elastimate/estimators/interface/parameter_judge.h"
#include "elastimate/estimators/misfit/displacement_misfit.h"
#include "elastimate/estimators/plan/sized_loads.h"
#include "elastimate/estimators/plan/unit_loads.h"

namespace elastimate {
namespace {

MaterialParameters ParametersOf(const Scene& scene) {
  return {scene.materials, scene.mesh.section.model};
}

// Each candidate beside what is known, the best first.
std::vector<PlannedLoad> Compare(const Eigen::MatrixXd& known,
                                 const std::vector<SizedCandidate>& candidates,
                                 const std::vector<std::size_t>& chosen) {
  std::vector<PlannedLoad> loads;
  loads.reserve(chosen.size());
  for (const std::size_t i : chosen) {
    loads.push_back({i, ExpectedErrors::Of(known + candidates[i].information),
                     candidates[i].factor});
  }
  std::stable_sort(loads.begin(), loads.end(),
                   [](const PlannedLoad& a, const PlannedLoad& b) {
                     return a.errors.AreSmallerThan(b.errors);
                   });
  return loads;
}

// Enters the comparison and the sequence.
void EnterLoads(Eigen::MatrixXd known,
                const std::vector<SizedCandidate>& candidates, LoadPlan& plan) {
  std::vector<std::size_t> left(candidates.size());
  for (std::size_t i = 0; i < left.size(); ++i) {
    left[i] = i;
  }
  plan.before = ExpectedErrors::Of(known);
  plan.loads = Compare(known, candidates, left);
  std::vector<PlannedLoad> next = plan.loads;
  const ExpectedErrors* before = &plan.before;
  plan.sequence.reserve(candidates.size());
  while (!next.empty() && next.front().errors.AreSmallerThan(*before)) {
    plan.sequence.push_back(next.front());
    before = &plan.sequence.back().errors;
    if (plan.AreDetermined(*before)) {
      break;
    }
    const std::size_t best = next.front().candidate;
    known += candidates[best].information;
    left.erase(std::find(left.begin(), left.end(), best));
    next = Compare(known, candidates, left);
  }
}

// What the priors of the free parameters say of them.
Eigen::VectorXd InformationOfPriors(const MaterialParameters& parameters,
                                    const Eigen::VectorXd& units) {
  Eigen::VectorXd information =
      Eigen::VectorXd::Zero(Eigen::Index(parameters.Free().size()));
  for (Eigen::Index i = 0; i < information.size(); ++i) {
    const Eigen::Index place = parameters.Free()[i];
    const std::optional<Prior>& prior = parameters.All()[place].prior;
    information(i) = prior ? std::pow(units(place) / prior->sd, 2) : 0;
  }
  return information;
}

}  // namespace

std::vector<ParameterEstimate> LoadPlan::Free() const {
  std::vector<ParameterEstimate> free;
  std::copy_if(
      parameters.begin(), parameters.end(), std::back_inserter(free),
      [](const ParameterEstimate& parameter) { return !parameter.is_known; });
  return free;
}

bool LoadPlan::AreDetermined(const ExpectedErrors& errors) const {
  const std::vector<ParameterEstimate> free = Free();
  const Eigen::VectorXd of_parameters = errors.OfParameters();
  for (std::size_t i = 0; i < free.size(); ++i) {
    const double largest = free[i].IsStiffness()
                               ? kLimits.largest_youngs_modulus_error
                               : kLimits.largest_poisson_ratio_error;
    if (!(of_parameters(Eigen::Index(i)) <= largest)) {
      return false;
    }
  }
  return true;
}

LoadPlan PlanLoads(const Scene& scene,
                   const std::vector<CandidateLoad>& candidates,
                   const Eigen::VectorXd& parameters, double relative_noise,
                   SolverKind solver) {
  SizedLoads sized = SizeLoads(scene, candidates, parameters, relative_noise,
                               solver, PlannedElements::kOfFits);
  LoadPlan plan;
  const MaterialParameters of_scene = ParametersOf(scene);
  const Eigen::VectorXd units = of_scene.UnitsOfErrors(parameters);
  plan.parameters = DescribeParameters(scene, of_scene, parameters);
  sized.known.diagonal() += InformationOfPriors(of_scene, units);
  EnterLoads(std::move(sized.known), sized.candidates, plan);
  return plan;
}

LoadCase ObservedAs(const LoadCase& observed, LoadCase load_case) {
  load_case.displacement = observed.displacement;
  load_case.observed = observed.observed;
  load_case.points = observed.points;
  load_case.noise_sd = observed.noise_sd;
  return load_case;
}

std::vector<CandidateLoad> UnitCandidates(const Scene& scene,
                                          const Eigen::MatrixXi& facets) {
  LoadCase load_case = ObservedAs(scene.load_cases[0], {});
  Supports supports = SupportsOf(scene, 0);
  if (scene.load_cases[0].supports || !supports.displacement.isZero(0)) {
    supports.displacement.setZero();
    load_case.supports = supports;
  }
  std::vector<CandidateLoad> candidates;
  for (const UnitLoad& unit : UnitLoads(scene.mesh, facets)) {
    load_case.loads = {unit.load};
    candidates.push_back({unit.name, load_case, true});
  }
  return candidates;
}

Eigen::VectorXd TypicalParameters(const Scene& scene, SolverKind solver) {
  const MaterialParameters parameters = ParametersOf(scene);
  Eigen::VectorXd typical =
      parameters.Typical(parameters.KnownModulus().value_or(1));
  if (parameters.KnownModulus() ||
      !std::all_of(scene.load_cases.begin(), scene.load_cases.end(),
                   IsMeasured)) {
    return typical;
  }
  EstimatorOptions options;
  options.solver = solver;
  DisplacementMisfit misfit(scene, options);
  const auto fit = misfit.FitScale(parameters.Moduli(typical), Loss::kNone);
  return fit ? parameters.Typical(1 / fit->compliance) : typical;
}

std::string CombinationInWords(const Eigen::VectorXd& combination,
                               const std::vector<ParameterEstimate>& free) {
  constexpr std::size_t kMost = 4;
  constexpr double kNotable = 0.2;
  std::vector<std::pair<double, std::size_t>> shares;
  for (std::size_t i = 0; i < free.size(); ++i) {
    const double share = std::abs(combination(Eigen::Index(i)));
    if (share > kNotable * combination.cwiseAbs().maxCoeff()) {
      shares.emplace_back(-share, i);
    }
  }
  std::stable_sort(
      shares.begin(), shares.end(),
      [](const auto& a, const auto& b) { return a.first < b.first; });
  std::string words;
  for (std::size_t k = 0; k < std::min(kMost, shares.size()); ++k) {
    const std::size_t i = shares[k].second;
    words += k == 0 ? "" : k == 1 ? " with " : ", ";
    words += free[i].Label();
    if (shares.size() > 1) {
      words += combination(Eigen::Index(i)) > 0 ? " up" : " down";
    }
  }
  if (shares.size() > kMost) {
    words += " and " + std::to_string(shares.size() - kMost) + " more";
  }
  return words;
}

}  // namespace elastimate
