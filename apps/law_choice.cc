#include "apps/law_choice.h"

#include <stdexcept>

#include "apps/flags.h"
#include "elastimate/estimators/displacement_fit/iterative_fe.h"

namespace elastimate {

void CheckLawChoice(const SceneReading& reading,
                    const EstimatorOptions& options) {
  if (FLAGS_estimator != "iterative-fe" && FLAGS_estimator != "reduced-fe" &&
      FLAGS_estimator != "auto") {
    throw std::invalid_argument(AsGiven("material") +
                                " compares fits of displacements; use it with "
                                "--estimator=iterative-fe, reduced-fe or auto");
  }
  if (FLAGS_regions == "merge") {
    throw std::invalid_argument(AsGiven("regions") +
                                " compares isotropic materials; leave out " +
                                AsGiven("material"));
  }
  if (reading.frames) {
    throw std::invalid_argument(
        AsGiven("material") +
        " is of one measurement, and the scene has frames; name the law, or "
        "make a scene of one frame");
  }
  const std::string why_not = WhyNoLawChoice(reading.scene, options);
  if (!why_not.empty()) {
    throw std::invalid_argument(AsGiven("material") + ": " + why_not);
  }
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
                      choice.why_not + "), so that none was chosen");
  }
  modelled.materials = choice.materials;
  scene.materials = choice.materials;
  return choice;
}

}  // namespace elastimate
