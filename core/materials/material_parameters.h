#ifndef ELASTIMATE_CORE_MATERIALS_MATERIAL_PARAMETERS_H_
#define ELASTIMATE_CORE_MATERIALS_MATERIAL_PARAMETERS_H_

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "elastimate/core/laws/law.h"
#include "elastimate/core/materials/material.h"

namespace elastimate {

/// The parameters p of some materials, one after another, m in all, and the
/// moduli theta(p) of their laws.  This joins the charts of all materials into
/// one.
class MaterialParameters {
 public:
  struct Parameter {
    const LawParameter* law_parameter;
    std::size_t material;         ///< Its place among the materials.
    std::optional<double> known;  ///< Its value, if that is given.
    std::optional<Prior> prior = {};
  };

  /// Precondition: valid materials.  An empty list means one isotropic
  /// material.
  MaterialParameters(const std::vector<Material>& materials,
                     SectionModel model);

  const std::vector<Parameter>& All() const { return parameters_; }
  Eigen::Index NumParameters() const {
    return Eigen::Index(parameters_.size());
  }
  /// Returns the law of a material.
  const Law& LawOf(std::size_t material) const { return *laws_[material]; }
  std::size_t NumMaterials() const { return laws_.size(); }
  /// Returns where the moduli of a material begin in theta.
  Eigen::Index FirstModulus(std::size_t material) const {
    return first_modulus_[material];
  }
  Eigen::Index NumModuli() const { return first_modulus_.back(); }
  /// Returns where the parameters of a material begin in p.
  Eigen::Index FirstParameter(std::size_t material) const {
    return first_parameter_[material];
  }
  SectionModel Model() const { return model_; }
  /// Returns the places of the parameters that are not known.
  const std::vector<Eigen::Index>& Free() const { return free_; }

  /// The first modulus among the known parameters, which sets the scale of the
  /// others; empty when none is known.
  std::optional<double> KnownModulus() const;

  /// Returns the known values, and typical ones for the others, with typical
  /// stiffnesses multiplied by `scale`.
  Eigen::VectorXd Typical(double scale) const;

  /// Returns the unit in which an error of each parameter is measured: its own
  /// value for a modulus, the geometric mean of the diagonal stiffnesses beside
  /// it for a stiffness off the diagonal, and 1 for a ratio.
  Eigen::VectorXd UnitsOfErrors(const Eigen::VectorXd& parameters) const;

  /// These are theta(p), its Jacobian (num_moduli x num_parameters), and
  /// p(theta).
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

/// Tells whether one of the materials has a law of large strains.
[[nodiscard]] bool HasLargeStrainLaw(const std::vector<Material>& materials);

/// Says why small strains are not enough for one of the laws, and what mends
/// it; empty when all laws are of small strains.
[[nodiscard]] std::string WhyNotSmallStrains(
    const MaterialParameters& parameters);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_MATERIALS_MATERIAL_PARAMETERS_H_
