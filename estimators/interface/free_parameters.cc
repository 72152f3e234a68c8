#include "elastimate/estimators/interface/free_parameters.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "elastimate/core/algebra/dense_algebra.h"
#include "elastimate/core/materials/stiffness_factors.h"

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

Bounds BoundsOfVariable(const Law& law, const LawParameter& parameter,
                        Bounds bounds) {
  if (parameter.beside) {
    return law.BlockEntries().empty() ? Bounds{} : Bounds{-1, 1};
  }
  if (parameter.is_modulus) {
    // Without bounds: a logarithm needs none.
    if (bounds.lower) {
      bounds.lower = std::log(*bounds.lower);
    }
    if (bounds.upper) {
      bounds.upper = std::log(*bounds.upper);
    }
    return bounds;
  }
  return {std::max(bounds.lower.value_or(parameter.lower), parameter.lower),
          std::min(bounds.upper.value_or(parameter.upper), parameter.upper)};
}

// The options know Poisson's ratio of one isotropic material.
std::vector<Material> WithKnownPoissonRatio(const Scene& scene,
                                            const EstimatorOptions& options) {
  if (!options.known_poisson_ratio ||
      !IsOneIsotropicMaterial(scene.materials)) {
    return scene.materials;
  }
  Material material = scene.materials.empty() ? Material() : scene.materials[0];
  material.known.push_back({"poisson_ratio", *options.known_poisson_ratio});
  return {material};
}

}  // namespace

FreeParameters::FreeParameters(const Scene& scene,
                               const EstimatorOptions& options)
    : all_(WithKnownPoissonRatio(scene, options), scene.mesh.section.model),
      known_(all_.Typical(1)) {
  for (std::size_t i = 0; i < all_.NumMaterials(); ++i) {
    has_factors_.push_back(!all_.LawOf(i).BlockEntries().empty() &&
                           scene.materials[i].known.empty() &&
                           scene.materials[i].bounds.empty());
  }
  for (Eigen::Index i = 0; i < Size(); ++i) {
    const Bounds given = GivenBounds(scene, options, Free(i));
    bounds_.push_back(IsOfFactors(i)
                          ? Bounds{}
                          : BoundsOfVariable(all_.LawOf(Free(i).material),
                                             *Free(i).law_parameter, given));
    are_bounds_given_.push_back(given.AreGiven());
  }
}

Eigen::VectorXd FreeParameters::ErrorsByBounds(
    const Eigen::VectorXd& variables) const {
  Eigen::VectorXd errors = Eigen::VectorXd::Constant(
      Size(), std::numeric_limits<double>::infinity());
  for (Eigen::Index i = 0; i < Size(); ++i) {
    const auto& [lower, upper] = bounds_[i];
    if (are_bounds_given_[i] && lower && upper) {
      errors(i) = std::hypot((*upper - *lower) / std::sqrt(12.0),
                             variables(i) - (*lower + *upper) / 2);
    }
  }
  return errors;
}

std::vector<Eigen::Index> FreeParameters::FirstOfFactors() const {
  std::vector<Eigen::Index> first;
  for (Eigen::Index i = 0; i < Size(); ++i) {
    if (IsOfFactors(i) &&
        all_.Free()[i] == all_.FirstParameter(Free(i).material)) {
      first.push_back(i);
    }
  }
  return first;
}

Eigen::VectorXd FreeParameters::ParametersAt(
    const Eigen::VectorXd& variables) const {
  Eigen::VectorXd parameters = known_;
  for (Eigen::Index i = 0; i < Size(); ++i) {
    parameters(all_.Free()[i]) = Free(i).law_parameter->is_modulus
                                     ? std::exp(variables(i))
                                     : variables(i);
  }
  const Eigen::VectorXd units = all_.UnitsOfErrors(parameters);
  for (Eigen::Index i = 0; i < Size(); ++i) {
    if (Free(i).law_parameter->beside) {
      parameters(all_.Free()[i]) = variables(i) * units(all_.Free()[i]);
    }
  }
  for (const Eigen::Index first : FirstOfFactors()) {
    const Law& law = all_.LawOf(Free(first).material);
    const Eigen::Index size = law.NumModuli();
    parameters.segment(all_.Free()[first], size) = law.ParametersOf(
        ModuliOfFactors(law.BlockEntries(), variables.segment(first, size)),
        all_.Model());
  }
  return parameters;
}

Eigen::VectorXd FreeParameters::VariablesOf(Eigen::VectorXd parameters) const {
  for (Eigen::Index i = 0; i < parameters.size(); ++i) {
    parameters(i) = all_.All()[i].known.value_or(parameters(i));
  }
  const Eigen::VectorXd units = all_.UnitsOfErrors(parameters);
  Eigen::VectorXd variables(Size());
  for (Eigen::Index i = 0; i < Size(); ++i) {
    const Eigen::Index place = all_.Free()[i];
    const double value = parameters(place);
    variables(i) = Free(i).law_parameter->is_modulus ? std::log(value) : value;
    if (Free(i).law_parameter->beside) {
      variables(i) = value / units(place);
    }
    variables(i) =
        std::max(variables(i), bounds_[i].lower.value_or(variables(i)));
    variables(i) =
        std::min(variables(i), bounds_[i].upper.value_or(variables(i)));
  }
  for (const Eigen::Index first : FirstOfFactors()) {
    const Law& law = all_.LawOf(Free(first).material);
    const Eigen::Index size = law.NumModuli();
    variables.segment(first, size) = FactorsOfModuli(
        law.BlockEntries(),
        law.Moduli(parameters.segment(all_.Free()[first], size), all_.Model()));
  }
  return variables;
}

std::optional<Eigen::VectorXd> FreeParameters::VariablesOfModuli(
    const Eigen::VectorXd& moduli) const {
  const Eigen::VectorXd variables = VariablesOf(all_.ParametersOf(moduli));
  return variables.allFinite() ? std::optional<Eigen::VectorXd>(variables)
                               : std::nullopt;
}

Eigen::MatrixXd FreeParameters::ParameterJacobian(
    const Eigen::VectorXd& variables) const {
  const Eigen::VectorXd parameters = ParametersAt(variables);
  const Eigen::VectorXd units = all_.UnitsOfErrors(parameters);
  Eigen::MatrixXd of_all = Eigen::MatrixXd::Zero(all_.NumParameters(), Size());
  for (Eigen::Index i = 0; i < Size(); ++i) {
    of_all(all_.Free()[i], i) = units(all_.Free()[i]);
  }
  // Half of the change of ln of either stiffness beside one off the diagonal.
  for (const Eigen::Index place : all_.Free()) {
    const MaterialParameters::Parameter& parameter = all_.All()[place];
    if (parameter.law_parameter->beside) {
      for (const int beside : *parameter.law_parameter->beside) {
        const Eigen::Index other =
            all_.FirstParameter(parameter.material) + beside;
        of_all.row(place) +=
            parameters(place) / 2 / parameters(other) * of_all.row(other);
      }
    }
  }
  for (const Eigen::Index first : FirstOfFactors()) {
    const Law& law = all_.LawOf(Free(first).material);
    const Eigen::Index size = law.NumModuli();
    const Eigen::Index place = all_.Free()[first];
    of_all.block(place, first, size, size) =
        Inverse(
            law.ModuliJacobian(parameters.segment(place, size), all_.Model())) *
        ModuliOfFactorsJacobian(law.BlockEntries(),
                                variables.segment(first, size));
  }
  return of_all(all_.Free(), Eigen::all);
}

Eigen::MatrixXd FreeParameters::RelativeJacobian(
    const Eigen::VectorXd& variables) const {
  const Eigen::VectorXd units = all_.UnitsOfErrors(ParametersAt(variables));
  return units(all_.Free()).cwiseInverse().asDiagonal() *
         ParameterJacobian(variables);
}

Eigen::VectorXd FreeParameters::ModuliAt(
    const Eigen::VectorXd& variables) const {
  return all_.Moduli(ParametersAt(variables));
}

Eigen::MatrixXd FreeParameters::ModuliJacobian(
    const Eigen::VectorXd& variables) const {
  const Eigen::MatrixXd of_all = all_.ModuliJacobian(ParametersAt(variables));
  return of_all(Eigen::all, all_.Free()) * ParameterJacobian(variables);
}

}  // namespace elastimate
