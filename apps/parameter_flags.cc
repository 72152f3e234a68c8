#include "apps/parameter_flags.h"

#include <algorithm>
#include <stdexcept>

#include "apps/estimator_flags.h"
#include "apps/flags.h"
#include "elastimate/core/materials/isotropic_law.h"
#include "elastimate/core/materials/material_parameters.h"
#include "elastimate/io/report/parameters_file.h"

namespace elastimate {

void CheckParameterFlags() {
  if (IsGiven("parameters")) {
    if (IsGiven("youngs") || IsGiven("nu")) {
      throw std::invalid_argument(AsGiven("parameters") + " is given beside " +
                                  AsGiven(IsGiven("youngs") ? "youngs" : "nu") +
                                  "; give only one of them");
    }
    return;
  }
  if (IsGiven("youngs") != IsGiven("nu")) {
    const bool has_youngs = IsGiven("youngs");
    throw std::invalid_argument(AsGiven(has_youngs ? "youngs" : "nu") +
                                " is given without " +
                                (has_youngs ? "--nu" : "--youngs") +
                                "; give both, or --parameters=FILE.json");
  }
  if (IsGiven("youngs")) {
    if (!(FLAGS_youngs > 0)) {
      throw std::invalid_argument(AsGiven("youngs") + "; it must be positive");
    }
    CheckPoissonRatioFlag();
  }
}

bool AreParametersGiven() {
  return IsGiven("parameters") || (IsGiven("youngs") && IsGiven("nu"));
}

Eigen::VectorXd ParametersFromFlags(const Scene& scene) {
  if (IsGiven("parameters")) {
    return ReadParameters(FLAGS_parameters, scene);
  }
  const MaterialParameters parameters(scene.materials,
                                      scene.mesh.section.model);
  if (std::any_of(scene.materials.begin(), scene.materials.end(),
                  [](const Material& material) {
                    return material.law != IsotropicLaw::kName;
                  })) {
    throw std::invalid_argument(
        AsGiven("youngs") +
        " is for isotropic materials, and the scene has others; give "
        "--parameters=FILE.json instead");
  }
  Eigen::VectorXd values(parameters.NumParameters());
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    values(i) =
        parameters.All()[i].law_parameter->is_modulus ? FLAGS_youngs : FLAGS_nu;
  }
  return values;
}

}  // namespace elastimate
