#include "apps/parameter_flags.h"

#include <algorithm>
#include <stdexcept>
#include <string_view>

#include "apps/estimator_flags.h"
#include "apps/flags.h"
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
  const auto is_other = [](const MaterialParameters::Parameter& parameter) {
    const std::string_view name = parameter.law_parameter->name;
    return name != "youngs_modulus" && name != "poisson_ratio";
  };
  const auto other =
      std::find_if(parameters.All().begin(), parameters.All().end(), is_other);
  if (other != parameters.All().end()) {
    const Law& law = parameters.LawOf(other->material);
    std::string names;
    for (const LawParameter& parameter : law.Parameters()) {
      names += (names.empty() ? "" : ", ") + std::string(parameter.name);
    }
    throw std::invalid_argument(
        AsGiven("youngs") +
        " is for materials that have E and nu, and the law " +
        std::string(law.Name()) + " of the scene has " + names +
        "; give these by --parameters=FILE.json");
  }
  Eigen::VectorXd values(parameters.NumParameters());
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    values(i) =
        parameters.All()[i].law_parameter->is_modulus ? FLAGS_youngs : FLAGS_nu;
  }
  return values;
}

}  // namespace elastimate
