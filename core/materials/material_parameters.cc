#include "elastimate/core/materials/material_parameters.h"

#include <algorithm>
#include <cmath>

#include "elastimate/core/materials/laws.h"

namespace elastimate {

MaterialParameters::MaterialParameters(const std::vector<Material>& materials,
                                       SectionModel model)
    : model_(model), first_modulus_({0}), first_parameter_({0}) {
  const std::vector<Material> one = {Material{}};
  for (const Material& material : materials.empty() ? one : materials) {
    const Law* const law = FindLaw(material.law, model);
    for (const LawParameter& law_parameter : law->Parameters()) {
      Parameter parameter = {&law_parameter, laws_.size(), {}, {}};
      for (const KnownParameter& known : material.known) {
        if (known.name == law_parameter.name) {
          parameter.known = known.value;
        }
      }
      for (const Prior& prior : material.priors) {
        if (prior.name == law_parameter.name) {
          parameter.prior = prior;
        }
      }
      if (!parameter.known) {
        free_.push_back(NumParameters());
      }
      parameters_.push_back(parameter);
    }
    laws_.push_back(law);
    first_modulus_.push_back(NumModuli() + law->NumModuli());
    first_parameter_.push_back(NumParameters());
  }
}

std::optional<double> MaterialParameters::KnownModulus() const {
  for (const Parameter& parameter : parameters_) {
    if (parameter.law_parameter->is_modulus && parameter.known) {
      return parameter.known;
    }
  }
  return std::nullopt;
}

Eigen::VectorXd MaterialParameters::Typical(double scale) const {
  Eigen::VectorXd typical(NumParameters());
  for (Eigen::Index i = 0; i < NumParameters(); ++i) {
    const LawParameter& parameter = *parameters_[i].law_parameter;
    typical(i) = parameters_[i].known.value_or(
        parameter.typical *
        (parameter.is_modulus || parameter.beside ? scale : 1));
  }
  return typical;
}

Eigen::VectorXd MaterialParameters::UnitsOfErrors(
    const Eigen::VectorXd& parameters) const {
  Eigen::VectorXd units(NumParameters());
  for (Eigen::Index i = 0; i < NumParameters(); ++i) {
    const LawParameter& parameter = *parameters_[i].law_parameter;
    units(i) = parameter.is_modulus ? parameters(i) : 1;
    if (parameter.beside) {
      const Eigen::Index first = first_parameter_[parameters_[i].material];
      units(i) = std::sqrt(parameters(first + (*parameter.beside)[0]) *
                           parameters(first + (*parameter.beside)[1]));
    }
  }
  return units;
}

Eigen::VectorXd MaterialParameters::Moduli(
    const Eigen::VectorXd& parameters) const {
  Eigen::VectorXd moduli(NumModuli());
  for (std::size_t i = 0; i < laws_.size(); ++i) {
    const Eigen::Index count = first_parameter_[i + 1] - first_parameter_[i];
    moduli.segment(first_modulus_[i], laws_[i]->NumModuli()) = laws_[i]->Moduli(
        parameters.segment(first_parameter_[i], count), model_);
  }
  return moduli;
}

Eigen::MatrixXd MaterialParameters::ModuliJacobian(
    const Eigen::VectorXd& parameters) const {
  Eigen::MatrixXd jacobian =
      Eigen::MatrixXd::Zero(NumModuli(), NumParameters());
  for (std::size_t i = 0; i < laws_.size(); ++i) {
    const Eigen::Index count = first_parameter_[i + 1] - first_parameter_[i];
    jacobian.block(first_modulus_[i], first_parameter_[i],
                   laws_[i]->NumModuli(), count) =
        laws_[i]->ModuliJacobian(parameters.segment(first_parameter_[i], count),
                                 model_);
  }
  return jacobian;
}

Eigen::VectorXd MaterialParameters::ParametersOf(
    const Eigen::VectorXd& moduli) const {
  Eigen::VectorXd parameters(NumParameters());
  for (std::size_t i = 0; i < laws_.size(); ++i) {
    const Eigen::Index count = first_parameter_[i + 1] - first_parameter_[i];
    parameters.segment(first_parameter_[i], count) = laws_[i]->ParametersOf(
        moduli.segment(first_modulus_[i], laws_[i]->NumModuli()), model_);
  }
  return parameters;
}

bool HasLargeStrainLaw(const std::vector<Material>& materials) {
  return std::any_of(
      materials.begin(), materials.end(), [](const Material& material) {
        return FindLaw(material.law)->ForLargeStrains() != nullptr;
      });
}

std::string WhyNotSmallStrains(const MaterialParameters& parameters) {
  for (std::size_t i = 0; i < parameters.NumMaterials(); ++i) {
    const Law& law = parameters.LawOf(i);
    if (law.ForLargeStrains() != nullptr) {
      return "the law " + std::string(law.Name()) +
             " is for large strains, but only small strains are computed "
             "here; give the material a law of small strains, such as "
             "isotropic";
    }
  }
  return "";
}

}  // namespace elastimate
