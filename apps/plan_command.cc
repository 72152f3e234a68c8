#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "apps/commands.h"
#include "apps/element_order.h"
#include "apps/estimator_flags.h"
#include "apps/flags.h"
#include "apps/material_flags.h"
#include "apps/number_list.h"
#include "apps/outputs.h"
#include "apps/parameter_flags.h"
#include "apps/plan_summary.h"
#include "apps/progress.h"
#include "apps/section_flags.h"
#include "elastimate/core/materials/material_parameters.h"
#include "elastimate/core/scene/rigid_motion.h"
#include "elastimate/core/scene/scene_builder.h"
#include "elastimate/estimators/plan/load_plan.h"
#include "elastimate/estimators/plan/map_plan.h"
#include "elastimate/estimators/plan/unit_loads.h"
#include "elastimate/estimators/registry.h"
#include "elastimate/io/report/plan_report.h"
#include "elastimate/io/scene/scene_reader.h"
#include "elastimate/io/text/file_output.h"
#include "elastimate/io/text/printable.h"

namespace elastimate {
namespace {

// The usual noise over the rms displacement, where nothing is known of the
// noise.
constexpr double kUsualNoise = 0.01;
// A smaller residual is one of simulated data, and says nothing of a
// measurement to come.
constexpr double kLeastResidual = 1e-6;

void CheckPlanFlags(const std::vector<std::string>& arguments) {
  if (arguments.size() != 1) {
    throw std::invalid_argument("plan needs one scene file" +
                                ButGot(arguments));
  }
  CheckParameterFlags();
  CheckNoMerging();
  if (IsGiven("noise") && !(FLAGS_noise > 0)) {
    throw std::invalid_argument(AsGiven("noise") + "; it must be positive");
  }
  if (IsGiven("noise_sd") && !(FLAGS_noise_sd > 0)) {
    throw std::invalid_argument(AsGiven("noise_sd") + "; it must be positive");
  }
  if (IsGiven("noise") && IsGiven("noise_sd")) {
    throw std::invalid_argument(AsGiven("noise_sd") + " is given beside " +
                                AsGiven("noise") + "; give only one of them");
  }
  ApplyComputingFlags();
  CheckOutputFlags(arguments);
}

void ApplyNoiseFlags(Scene& scene) {
  for (LoadCase& load_case : scene.load_cases) {
    if (IsGiven("noise_sd")) {
      load_case.noise_sd = FLAGS_noise_sd;
    }
    if (IsGiven("noise")) {
      load_case.noise_sd.reset();
    }
    if (IsGiven("noise_sd") || IsGiven("noise")) {
      load_case.points.noise_sd.resize(0, 0);
    }
  }
}

/// The load cases that count as measured, and those that are candidates.
struct SplitCases {
  Scene before;
  std::vector<CandidateLoad> candidates;
};

SplitCases Split(const Scene& scene, PlanBasis& basis) {
  SplitCases split = {scene, {}};
  split.before.load_cases.clear();
  const std::vector<LoadCase>& all = scene.load_cases;
  basis.is_measured = std::any_of(all.begin(), all.end(), IsMeasured);
  for (std::size_t k = 0; k < all.size(); ++k) {
    if (basis.is_measured ? IsMeasured(all[k]) : k == 0) {
      split.before.load_cases.push_back(all[k]);
      basis.load_cases.push_back(int(k) + 1);
    } else {
      split.candidates.push_back(
          {"load case " + std::to_string(k + 1), all[k]});
      basis.load_case_of_candidate.push_back(int(k) + 1);
    }
  }
  return split;
}

// Tells whether these are parameters of the laws and no bound holds them.
bool ArePhysical(const Scene& scene, const Estimate& estimate) {
  const MaterialParameters parameters(scene.materials,
                                      scene.mesh.section.model);
  if (!estimate.active_bounds.empty() ||
      estimate.parameters.size() != parameters.All().size()) {
    return false;
  }
  for (std::size_t i = 0; i < estimate.parameters.size(); ++i) {
    const LawParameter& law = *parameters.All()[i].law_parameter;
    const double value = estimate.parameters[i].value;
    if (!(value > law.lower && value < law.upper)) {
      return false;
    }
  }
  return true;
}

bool SaysItsNoise(const LoadCase& load_case) {
  return load_case.noise_sd || load_case.points.noise_sd.size() != 0;
}

// Takes the noise from the residual where it is not given.
void TakeNoiseFrom(const Estimate& estimate, Scene& before, PlanBasis& basis) {
  const double residual = estimate.displacement_residual.value_or(0);
  if (IsGiven("noise") || !(residual > kLeastResidual)) {
    return;
  }
  basis.relative_noise = residual;
  for (LoadCase& load_case : before.load_cases) {
    if (!SaysItsNoise(load_case)) {
      load_case.noise_sd = estimate.noise_sd;
    }
  }
}

void TakeErrorsFrom(const Estimate& estimate, PlanBasis& basis) {
  for (const ParameterEstimate& parameter : estimate.parameters) {
    if (estimate.IsUsable() && !parameter.is_known) {
      basis.errors_of_estimate.push_back(parameter.standard_error
                                             ? *parameter.standard_error /
                                                   parameter.ErrorUnit()
                                             : Estimate::kUnknown);
    }
  }
}

// Returns the parameters of the flags, of the measurement, or typical ones.
Eigen::VectorXd ChooseParameters(SolverKind solver, Scene& before,
                                 PlanBasis& basis) {
  basis.is_scale_known = true;
  if (basis.is_measured) {
    EstimatorOptions options;
    options.solver = solver;
    const Estimate estimate =
        MakeEstimator("iterative-fe")->Run(before, options);
    TakeNoiseFrom(estimate, before, basis);
    TakeErrorsFrom(estimate, basis);
    if (!AreParametersGiven() && estimate.IsUsable() &&
        ArePhysical(before, estimate)) {
      basis.parameters = "estimate";
      return estimate.ParameterValues();
    }
  }
  if (AreParametersGiven()) {
    basis.parameters = "given";
    return ParametersFromFlags(before);
  }
  basis.parameters = "typical";
  basis.is_scale_known =
      basis.is_measured ||
      MaterialParameters(before.materials, before.mesh.section.model)
          .KnownModulus();
  return TypicalParameters(before, solver);
}

// Leaves out a noise that is a length, which says nothing beside moduli of any
// size.
void LeaveNoiseOut(SplitCases& split, std::vector<std::string>& notices) {
  bool is_given = false;
  const auto leave_out = [&](LoadCase& load_case) {
    is_given = is_given || SaysItsNoise(load_case);
    load_case.noise_sd.reset();
    load_case.points.noise_sd.resize(0, 0);
  };
  for (LoadCase& load_case : split.before.load_cases) {
    leave_out(load_case);
  }
  for (CandidateLoad& candidate : split.candidates) {
    leave_out(candidate.load_case);
  }
  if (is_given) {
    notices.emplace_back(
        "the standard deviation of the noise is ignored, because nothing says "
        "how large the displacements will be; give --youngs and --nu, or "
        "--parameters");
  }
}

// Gives each candidate the observed components and the noise of the first load
// case, where it says nothing else.
void CompleteCandidates(SplitCases& split) {
  const LoadCase& first = split.before.load_cases[0];
  for (CandidateLoad& candidate : split.candidates) {
    LoadCase& load_case = candidate.load_case;
    const std::optional<double> noise_sd =
        load_case.noise_sd ? load_case.noise_sd : first.noise_sd;
    if (load_case.observed.size() == 0) {
      load_case = ObservedAs(first, load_case);
    }
    load_case.noise_sd = noise_sd;
  }
}

Eigen::MatrixXi SurfaceOfUnitLoads(const Scene& before,
                                   const std::string& source) {
  const int dimension = before.mesh.Dimension();
  if (!IsGiven("surface")) {
    const Eigen::MatrixXi facets = LoadedFacets(before);
    if (facets.cols() == 0) {
      throw std::invalid_argument(
          source +
          ": no surface is loaded on which other loads could act; give one by "
          "--surface, or add load cases without displacements, which could be "
          "measured next");
    }
    return facets;
  }
  const Eigen::VectorXd box = NumberList<Eigen::VectorXd>(
      "surface", FLAGS_surface, "finite numbers", 2 * Eigen::Index(dimension));
  if (!box.allFinite()) {
    throw std::invalid_argument(AsGiven("surface") +
                                "; its numbers must be finite");
  }
  Eigen::MatrixXi facets =
      FacetsInBox(before.mesh, box.head(dimension), box.tail(dimension));
  if (facets.cols() == 0) {
    throw std::invalid_argument(
        AsGiven("surface") + ": no face of the surface of " + source +
        " lies in this box; give the smallest coordinates, then the largest");
  }
  return facets;
}

void AddUnitLoads(const std::string& source, SplitCases& split,
                  PlanBasis& basis) {
  if (!split.candidates.empty() && !IsGiven("surface")) {
    return;
  }
  for (const CandidateLoad& unit :
       UnitCandidates(split.before, SurfaceOfUnitLoads(split.before, source))) {
    split.candidates.push_back(unit);
    basis.load_case_of_candidate.push_back(0);
  }
}

// Enters the noise and the candidates, once the parameters are there.
void EnterCandidates(const std::string& source, SplitCases& split,
                     PlanBasis& basis, std::vector<std::string>& notices) {
  if (!basis.is_scale_known) {
    LeaveNoiseOut(split, notices);
  }
  CompleteCandidates(split);
  AddUnitLoads(source, split, basis);
  basis.noise_sd = split.before.load_cases[0].noise_sd;
}

// A plan, and what is written of it.
struct PlanOutput {
  std::string report;
  std::string summary;
  bool is_enough;  ///< Whether the loads determine what is asked for.
};

PlanOutput MakeLoadPlan(const std::string& source, SolverKind solver,
                        SplitCases& split, PlanBasis& basis,
                        std::vector<std::string>& notices) {
  const Eigen::VectorXd parameters =
      ChooseParameters(solver, split.before, basis);
  EnterCandidates(source, split, basis, notices);
  const LoadPlan plan = PlanLoads(split.before, split.candidates, parameters,
                                  basis.relative_noise, solver);
  return {
      JsonPlan(plan, basis, split.candidates, notices),
      PlanSummary(plan, basis, split.candidates),
      plan.AreDetermined(plan.sequence.empty() ? plan.before
                                               : plan.sequence.back().errors)};
}

// A fit of one material would take structure for noise, so that a plan of a map
// asks it for the size of the moduli alone.
PlanOutput MakeMapPlan(const std::string& source, SolverKind solver,
                       SplitCases& split, PlanBasis& basis,
                       std::vector<std::string>& notices) {
  split.before.materials.clear();
  const bool are_given = AreParametersGiven();
  basis.parameters = are_given ? "given" : "typical";
  basis.is_scale_known = are_given || basis.is_measured;
  const Eigen::Vector2d parameters =
      are_given ? ParametersFromFlags(split.before)
                : TypicalParameters(split.before, solver);
  EnterCandidates(source, split, basis, notices);
  const MapPlan plan =
      PlanMap(split.before, split.candidates, {parameters(0), parameters(1)},
              basis.relative_noise, solver);
  return {JsonMapPlan(plan, basis, split.candidates, notices),
          MapPlanSummary(plan, basis, split.candidates), true};
}

PlanOutput MakePlan(const std::string& source, SolverKind solver,
                    SplitCases& split, PlanBasis& basis,
                    std::vector<std::string>& notices) {
  try {
    return HasFields(split.before.materials)
               ? MakeMapPlan(source, solver, split, basis, notices)
               : MakeLoadPlan(source, solver, split, basis, notices);
  } catch (const std::exception& error) {
    const std::string sentence = error.what();
    const bool is_named =
        sentence.rfind(source, 0) == 0 || sentence.rfind("--", 0) == 0;
    throw std::invalid_argument(is_named ? sentence : source + ": " + sentence);
  }
}

}  // namespace

int RunPlan(const std::vector<std::string>& arguments) {
  CheckPlanFlags(arguments);
  const SolverKind solver = SolverFromFlag();
  const std::string source = PrintablePath(arguments[0]);
  std::optional<Progress> progress("reading " + source);
  SceneReading reading = ReadScene(
      {arguments[0]}, Measurement::kOptional,
      {SectionFromFlags(), RegionsFromFlag(), LawFromFlags(), FieldFromFlag()});
  if (reading.frames) {
    throw std::invalid_argument(source +
                                ": plan cannot be used with a scene of several "
                                "frames; leave out the key \"frames\"");
  }
  progress->Show("planning");
  const std::string why_not_held = WhyNotHeld(reading.scene);
  if (!why_not_held.empty()) {
    throw std::invalid_argument(source + ": " + why_not_held);
  }
  ApplyNoiseFlags(reading.scene);
  const std::optional<Scene> quadratic =
      QuadraticSceneIfAsked(source, reading.scene, reading.notices);
  PlanBasis basis = {};
  basis.relative_noise = IsGiven("noise") ? FLAGS_noise : kUsualNoise;
  SplitCases split = Split(quadratic ? *quadratic : reading.scene, basis);
  const PlanOutput plan =
      MakePlan(source, solver, split, basis, reading.notices);
  progress.reset();
  StagedFiles files;
  if (!FLAGS_json.empty() && FLAGS_json != "-") {
    files.Add(FLAGS_json, plan.report);
  }
  WriteStandardOutput(FLAGS_json == "-" ? plan.report : plan.summary);
  files.Commit();
  PrintNotices(reading.notices);
  return plan.is_enough ? 0 : 1;
}

}  // namespace elastimate
