#include "apps/validation_models.h"

#include <algorithm>
#include <stdexcept>

#include "apps/flags.h"
#include "apps/measured_scene.h"
#include "apps/number_list.h"
#include "elastimate/core/materials/laws.h"
#include "elastimate/core/materials/material.h"
#include "elastimate/io/text/printable.h"

namespace elastimate {
namespace {

// Keeps what is said of the parameters that a law has.
template <class Said>
void KeepParametersOf(const Law& law, std::vector<Said>& said) {
  said.erase(std::remove_if(said.begin(), said.end(),
                            [&](const Said& one) {
                              return std::none_of(
                                  law.Parameters().begin(),
                                  law.Parameters().end(),
                                  [&](const LawParameter& parameter) {
                                    return parameter.name == one.name;
                                  });
                            }),
             said.end());
}

std::vector<Material> WithLaw(std::vector<Material> materials, const Law& law) {
  if (materials.empty()) {
    materials.emplace_back();
  }
  for (Material& material : materials) {
    material.law = law.Name();
    KeepParametersOf(law, material.known);
    KeepParametersOf(law, material.bounds);
    KeepParametersOf(law, material.priors);
  }
  return materials;
}

Scene SceneOfModel(Scene scene, const std::string& word) {
  if (word == "one_material") {
    scene.materials.clear();
  } else if (word == "each_region") {
    scene.materials = IsotropicMaterialOfEachRegion(scene.mesh);
  } else if (word == "linear") {
    scene.origin = Origin::kComputed;
  } else if (const Law* const law = FindLaw(word)) {
    scene.materials = WithLaw(scene.materials, *law);
  } else {
    throw std::invalid_argument(
        AsGiven("compare") + ": " + Printable(word) +
        " is no model; give one_material, each_region, linear, or a law that "
        "'elastimate materials' lists, separated by commas");
  }
  return scene;
}

}  // namespace

std::vector<ValidationModel> ModelsToCompare(const Scene& scene,
                                             const EstimatorOptions& options) {
  std::vector<ValidationModel> models = {{"as given", scene, options}};
  for (const std::string& word : WordsOf(FLAGS_compare)) {
    if (std::any_of(
            models.begin(), models.end(),
            [&](const ValidationModel& model) { return model.name == word; })) {
      throw std::invalid_argument(AsGiven("compare") + " names " +
                                  Printable(word) +
                                  " twice; name each model once");
    }
    models.push_back({word, SceneOfModel(scene, word), options});
  }
  for (ValidationModel& model : models) {
    GiveKnownPoissonRatio(model.scene, model.options);
  }
  return models;
}

}  // namespace elastimate
