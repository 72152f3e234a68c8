#include "apps/measured_scene.h"

#include <algorithm>
#include <optional>
#include <stdexcept>

#include "apps/estimator_flags.h"
#include "apps/flags.h"
#include "apps/gap_choice.h"
#include "apps/material_flags.h"
#include "apps/section_flags.h"
#include "elastimate/core/materials/isotropic_law.h"
#include "elastimate/core/materials/laws.h"
#include "elastimate/io/text/printable.h"

namespace elastimate {

SceneReading ReadMeasuredScene(const std::vector<std::string>& arguments) {
  SceneReading reading =
      ReadWithGapsChosen([&arguments](const std::vector<bool>& is_filled) {
        return ReadScene({arguments.begin(), arguments.end()},
                         Measurement::kRequired,
                         {SectionFromFlags(), RegionsFromFlag(),
                          ChoosesLaw() ? AxesOfLawsToChoose() : LawFromFlags(),
                          FieldFromFlag(), is_filled, OriginFromFlag()});
      });
  if (IsGiven("noise_sd")) {
    for (LoadCase& load_case : reading.scene.load_cases) {
      load_case.noise_sd = FLAGS_noise_sd;
    }
  }
  return reading;
}

void GiveKnownPoissonRatio(Scene& scene, EstimatorOptions& options) {
  if (!options.known_poisson_ratio || IsOneIsotropicMaterial(scene.materials)) {
    return;
  }
  const KnownParameter known = {"poisson_ratio", *options.known_poisson_ratio};
  const auto is_of_nu = [&](const auto& given) {
    return given.name == known.name;
  };
  for (Material& material : scene.materials) {
    const std::vector<LawParameter>& parameters =
        FindLaw(material.law)->Parameters();
    if (std::none_of(parameters.begin(), parameters.end(), is_of_nu)) {
      throw std::invalid_argument(
          AsGiven("nu") + " is not a parameter of the law " + material.law +
          ", which the scene has; give its parameters as \"known\" in "
          "\"materials\" of a scene.json");
    }
    if (std::none_of(material.known.begin(), material.known.end(), is_of_nu)) {
      material.known.push_back(known);
      material.bounds.erase(std::remove_if(material.bounds.begin(),
                                           material.bounds.end(), is_of_nu),
                            material.bounds.end());
    }
  }
  options.known_poisson_ratio.reset();
}

std::string Sources(const std::vector<std::string>& arguments) {
  std::string sources;
  for (const std::string& argument : arguments) {
    sources += (sources.empty() ? "" : ", ") + PrintablePath(argument);
  }
  return sources;
}

}  // namespace elastimate
