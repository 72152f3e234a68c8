#include "elastimate/estimators/interface/free_parameters.h"

#include <algorithm>
#include <cmath>

namespace elastimate {
namespace {

Bounds GivenBounds(const Scene& scene, const EstimatorOptions& options,
                   const MaterialParameters::Parameter& parameter) {
  const std::string_view name = parameter.law_parameter->name;
  if (!scene.materials.empty()) {
    for (const BoundsOfParameter& given :
         scene.materials[parameter.material].bounds) {
      if (given.name == name) {
        return given.bounds;
      }
    }
  }
  if (name == "youngs_modulus") {
    return options.youngs_modulus;
  }
  return name == "poisson_ratio" ? options.poisson_ratio : Bounds{};
}

}  // namespace

FreeParameters::FreeParameters(const Scene& scene,
                               const EstimatorOptions& options)
    : all_(scene.materials, scene.mesh.section.model), known_(all_.Typical(1)) {
  for (const Eigen::Index i : all_.Free()) {
    const LawParameter& parameter = *all_.All()[i].law_parameter;
    Bounds bounds = GivenBounds(scene, options, all_.All()[i]);
    if (parameter.is_modulus) {
      // Without bounds: a logarithm needs none.
      if (bounds.lower) {
        bounds.lower = std::log(*bounds.lower);
      }
      if (bounds.upper) {
        bounds.upper = std::log(*bounds.upper);
      }
    } else {
      bounds.lower =
          std::max(bounds.lower.value_or(parameter.lower), parameter.lower);
      bounds.upper =
          std::min(bounds.upper.value_or(parameter.upper), parameter.upper);
    }
    bounds_.push_back(bounds);
  }
}

Eigen::VectorXd FreeParameters::ParametersAt(
    const Eigen::VectorXd& variables) const {
  Eigen::VectorXd parameters = known_;
  for (Eigen::Index i = 0; i < Size(); ++i) {
    parameters(all_.Free()[i]) =
        LawParameterOf(i).is_modulus ? std::exp(variables(i)) : variables(i);
  }
  return parameters;
}

Eigen::VectorXd FreeParameters::VariablesOf(
    const Eigen::VectorXd& parameters) const {
  Eigen::VectorXd variables(Size());
  for (Eigen::Index i = 0; i < Size(); ++i) {
    const double value = parameters(all_.Free()[i]);
    variables(i) = LawParameterOf(i).is_modulus ? std::log(value) : value;
    variables(i) =
        std::max(variables(i), bounds_[i].lower.value_or(variables(i)));
    variables(i) =
        std::min(variables(i), bounds_[i].upper.value_or(variables(i)));
  }
  return variables;
}

Eigen::VectorXd FreeParameters::Slopes(const Eigen::VectorXd& variables) const {
  Eigen::VectorXd slopes(Size());
  for (Eigen::Index i = 0; i < Size(); ++i) {
    slopes(i) = LawParameterOf(i).is_modulus ? std::exp(variables(i)) : 1;
  }
  return slopes;
}

Eigen::VectorXd FreeParameters::ModuliAt(
    const Eigen::VectorXd& variables) const {
  return all_.Moduli(ParametersAt(variables));
}

Eigen::MatrixXd FreeParameters::ModuliJacobian(
    const Eigen::VectorXd& variables) const {
  const Eigen::MatrixXd of_all = all_.ModuliJacobian(ParametersAt(variables));
  return of_all(Eigen::all, all_.Free()) * Slopes(variables).asDiagonal();
}

}  // namespace elastimate
