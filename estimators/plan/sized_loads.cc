#include "elastimate/estimators/plan/sized_loads.h"

#include <cmath>
#include <stdexcept>
#include <string>

#include "elastimate/core/materials/material_parameters.h"
#include "elastimate/core/scene/finer_scene.h"
#include "elastimate/core/scene/loads.h"
#include "elastimate/core/scene/rigid_motion.h"
#include "elastimate/estimators/plan/expected_information.h"

namespace elastimate {
namespace {

void CheckPlan(const Scene& scene, const std::vector<CandidateLoad>& candidates,
               const Eigen::VectorXd& parameters, double relative_noise) {
  const MaterialParameters of_materials(scene.materials,
                                        scene.mesh.section.model);
  if (of_materials.Free().empty()) {
    throw std::invalid_argument(
        "all parameters are known, so that there is nothing to plan; leave one "
        "out of \"known\"");
  }
  if (parameters.size() != of_materials.NumParameters() ||
      !parameters.allFinite()) {
    throw std::invalid_argument("a plan needs a value of each parameter");
  }
  if (candidates.empty()) {
    throw std::invalid_argument("there is no load to choose; give candidates");
  }
  if (!(relative_noise > 0)) {
    throw std::invalid_argument(
        "the noise is not positive, and without noise every load that "
        "determines the parameters is as good as another; give a positive "
        "noise (--noise)");
  }
  const std::string why_not_held = WhyNotHeld(scene);
  if (!why_not_held.empty()) {
    throw std::invalid_argument(why_not_held);
  }
}

// Something has to say how large displacements are.
void RequireLoads(const Scene& scene) {
  const Eigen::MatrixXd forces = AssembleLoadCases(scene);
  for (Eigen::Index k = 0; k < forces.cols(); ++k) {
    const Supports& supports = SupportsOf(scene, k);
    if (IsMeasured(scene.load_cases[k]) || !forces.col(k).isZero(0) ||
        (supports.held && supports.displacement.array() != 0).any() ||
        supports.unknown.any()) {
      return;
    }
  }
  throw std::invalid_argument(
      "all loads are zero and no support is displaced, so that nothing moves; "
      "give the load case a load");
}

// The load cases of the scene, and behind them the candidates.
Scene WithCandidates(Scene scene, const std::vector<CandidateLoad>& candidates,
                     PlannedElements elements) {
  for (const CandidateLoad& candidate : candidates) {
    scene.load_cases.push_back(candidate.load_case);
  }
  return elements == PlannedElements::kOfFits &&
                 scene.origin == Origin::kMeasured && scene.mesh.Order() == 1
             ? FinerScene(scene)
             : scene;
}

double RmsOfScene(const std::vector<CaseInformation>& cases,
                  std::size_t num_cases) {
  double sum = 0;
  for (std::size_t k = 0; k < num_cases; ++k) {
    sum += cases[k].rms_displacement * cases[k].rms_displacement;
  }
  return std::sqrt(sum / double(num_cases));
}

SizedCandidate AtItsSize(const CandidateLoad& candidate,
                         const CaseInformation& as_given, double rms_of_scene) {
  if (!(as_given.rms_displacement > 0)) {
    return {as_given.information, std::nullopt};
  }
  if (!candidate.is_free_in_size) {
    return {as_given.information, 1};
  }
  const double factor = rms_of_scene / as_given.rms_displacement;
  // Relative noise grows with the load.
  const bool is_noise_given = candidate.load_case.noise_sd ||
                              candidate.load_case.points.noise_sd.size() != 0;
  return {as_given.information * (is_noise_given ? factor * factor : 1),
          factor};
}

}  // namespace

SizedLoads SizeLoads(const Scene& scene,
                     const std::vector<CandidateLoad>& candidates,
                     const Eigen::VectorXd& parameters, double relative_noise,
                     SolverKind solver, PlannedElements elements) {
  ValidateScene(scene);
  CheckPlan(scene, candidates, parameters, relative_noise);
  RequireLoads(scene);
  const std::size_t num_cases = scene.load_cases.size();
  const std::vector<CaseInformation> cases =
      ExpectedInformation(WithCandidates(scene, candidates, elements),
                          num_cases, parameters, relative_noise, solver);
  const double rms_of_scene = RmsOfScene(cases, num_cases);
  if (!(rms_of_scene > 0)) {
    throw std::invalid_argument(
        "the loads move nothing that is observed; give loads that deform the "
        "observed part of the specimen");
  }
  SizedLoads sized = {cases[0].information, {}};
  for (std::size_t k = 1; k < num_cases; ++k) {
    sized.known += cases[k].information;
  }
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    sized.candidates.push_back(
        AtItsSize(candidates[i], cases[num_cases + i], rms_of_scene));
  }
  return sized;
}

}  // namespace elastimate
