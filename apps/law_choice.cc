#include "apps/law_choice.h"

#include <algorithm>
#include <cstddef>
#include <stdexcept>

#include "apps/flags.h"
#include "elastimate/core/materials/anisotropic_law.h"
#include "elastimate/core/scene/observed_displacements.h"
#include "elastimate/estimators/material_fit/iterative_fe.h"

namespace elastimate {
namespace {

// Counts the parameters of the fit without symmetry, with which all laws are
// compared.
std::size_t NumStiffnesses(const Scene& scene) {
  return AnisotropicLaw().Parameters().size() *
         std::max<std::size_t>(scene.materials.size(), 1);
}

std::string HowManyStiffnesses(const Scene& scene) {
  return "laws are compared by a fit of all stiffnesses of all materials (" +
         std::to_string(NumStiffnesses(scene)) + " parameters)";
}

// Throws for fewer components than parameters, which would determine none of
// these.
void RequireMoreDataThanParameters(const Scene& scene) {
  const Eigen::Index num_observed = ObservedDisplacements(scene).Size();
  if (num_observed <= static_cast<Eigen::Index>(NumStiffnesses(scene))) {
    throw std::invalid_argument(
        AsGiven("material") + ": " + HowManyStiffnesses(scene) + ", but only " +
        std::to_string(num_observed) +
        " components were measured; name the law by --material, join regions "
        "in \"materials\" of a scene.json, or measure more");
  }
}

}  // namespace

void CheckLawChoice(const SceneReading& reading,
                    const EstimatorOptions& options) {
  if (FLAGS_estimator != "iterative-fe" && FLAGS_estimator != "reduced-fe" &&
      FLAGS_estimator != "auto") {
    throw std::invalid_argument(
        AsGiven("material") +
        " compares fits of displacements; give --estimator=iterative-fe, "
        "--estimator=reduced-fe or --estimator=auto");
  }
  if (FLAGS_regions == "merge") {
    throw std::invalid_argument(
        AsGiven("regions") +
        " compares isotropic materials only; leave out this flag or " +
        AsGiven("material"));
  }
  if (reading.frames) {
    throw std::invalid_argument(
        AsGiven("material") +
        " cannot be used with a scene of several frames; name a law, or make a "
        "scene of one frame");
  }
  if (HasPriors(reading.scene.materials)) {
    throw std::invalid_argument(AsGiven("material") +
                                " compares laws by the measurement alone; "
                                "leave out the key \"prior\"");
  }
  const std::string why_not = WhyNoLawChoice(reading.scene, options);
  if (!why_not.empty()) {
    throw std::invalid_argument(AsGiven("material") + ": " + why_not);
  }
  RequireMoreDataThanParameters(reading.scene);
}

std::vector<std::string> NoticesOfLawChoice(const Scene& scene) {
  if (scene.materials.size() < 2) {
    return {};
  }
  return {AsGiven("material") + ": " + HowManyStiffnesses(scene) +
          ", which may take many minutes; it is quicker with fewer materials, "
          "and without a comparison, where --material names a law"};
}

ChosenLaw GiveChosenLaw(const EstimatorOptions& options,
                        const std::string& sources, Scene& modelled,
                        Scene& scene, std::vector<std::string>& notices) {
  const std::string why_not = IterativeFe().WhyUnsupported(modelled, options);
  if (!why_not.empty()) {
    throw std::invalid_argument(sources + ": " + why_not);
  }
  ChosenLaw choice = ChooseLaw(modelled, options);
  if (!choice.why_not.empty()) {
    notices.push_back(sources + ": laws could not be compared (" +
                      choice.why_not + "), so the law of the scene is kept");
  }
  modelled.materials = choice.materials;
  scene.materials = choice.materials;
  return choice;
}

}  // namespace elastimate
