#ifndef ELASTIMATE_CORE_MATERIALS_MATERIAL_PARAMETERS_H_
#define ELASTIMATE_CORE_MATERIALS_MATERIAL_PARAMETERS_H_

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "elastimate/core/materials/law.h"
#include "elastimate/core/materials/material.h"

namespace elastimate {

/// The parameters p of some materials, one after another, m in all, and the
/// moduli theta(p) of their laws: the charts of all materials as one.
class MaterialParameters {
 public:
  struct Parameter {
    const LawParameter* law_parameter;
    std::size_t material;         ///< Its place among the materials.
    std::optional<double> known;  ///< Its value, where that is given.
  };

  /// Precondition: valid materials; none are one isotropic material.
  MaterialParameters(const std::vector<Material>& materials,
                     SectionModel model);

  const std::vector<Parameter>& All() const { return parameters_; }
  Eigen::Index NumParameters() const {
    return Eigen::Index(parameters_.size());
  }
  /// The law of a material.
  const Law& LawOf(std::size_t material) const { return *laws_[material]; }
  std::size_t NumMaterials() const { return laws_.size(); }
  /// Where the moduli of a material begin in theta.
  Eigen::Index FirstModulus(std::size_t material) const {
    return first_modulus_[material];
  }
  Eigen::Index NumModuli() const { return first_modulus_.back(); }
  /// Where its parameters begin in p.
  Eigen::Index FirstParameter(std::size_t material) const {
    return first_parameter_[material];
  }
  SectionModel Model() const { return model_; }
  /// Which are not known.
  const std::vector<Eigen::Index>& Free() const { return free_; }

  /// The first modulus among the known parameters, which sets the scale of the
  /// others; empty when none is known.
  std::optional<double> KnownModulus() const;

  /// The known values, and typical ones for the others, stiffnesses of which
  /// are `scale` times as large.
  Eigen::VectorXd Typical(double scale) const;

  /// What errors of p are measured by: of a modulus its value, of a stiffness
  /// off the diagonal the geometric mean of those beside it, of a ratio 1.
  Eigen::VectorXd UnitsOfErrors(const Eigen::VectorXd& parameters) const;

  /// theta(p), its Jacobian (num_moduli x num_parameters), and p(theta).
  Eigen::VectorXd Moduli(const Eigen::VectorXd& parameters) const;
  Eigen::MatrixXd ModuliJacobian(const Eigen::VectorXd& parameters) const;
  Eigen::VectorXd ParametersOf(const Eigen::VectorXd& moduli) const;

 private:
  SectionModel model_;
  std::vector<const Law*> laws_;
  std::vector<Eigen::Index> first_modulus_;    ///< num_materials + 1.
  std::vector<Eigen::Index> first_parameter_;  ///< num_materials + 1.
  std::vector<Parameter> parameters_;
  std::vector<Eigen::Index> free_;
};

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_MATERIALS_MATERIAL_PARAMETERS_H_
