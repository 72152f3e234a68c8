#ifndef ELASTIMATE_ESTIMATORS_INTERFACE_FREE_PARAMETERS_H_
#define ELASTIMATE_ESTIMATORS_INTERFACE_FREE_PARAMETERS_H_

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "elastimate/core/materials/material_parameters.h"
#include "elastimate/core/scene/scene.h"
#include "elastimate/estimators/interface/estimator.h"

namespace elastimate {

/// The parameters of a scene that are not known, as the variables x of a fit.
///
/// Of a material of which something is known or bounded, and of each isotropic
/// one: ln of moduli, ratios as they are, and stiffnesses off the diagonal over
/// the geometric mean of those beside them.  Of others the factors of their
/// stiffness (stiffness_factors.h), which is positive definite by construction.
class FreeParameters {
 public:
  /// Precondition: a valid scene and valid options.
  FreeParameters(const Scene& scene, const EstimatorOptions& options);

  const MaterialParameters& All() const { return all_; }
  Eigen::Index Size() const { return Eigen::Index(all_.Free().size()); }
  /// The parameter of a variable.
  const MaterialParameters::Parameter& Free(Eigen::Index variable) const {
    return all_.All()[all_.Free()[variable]];
  }

  /// The bounds of each variable: as given for its material, else by the
  /// options, and the range of its law.
  const std::vector<Bounds>& VariableBounds() const { return bounds_; }
  /// What the bounds that are given say of the errors of variables: the root
  /// mean square distance of any value between them, their distance over
  /// sqrt(12) from the middle and over sqrt(3) from one of them.  Infinite
  /// where none is given, or on one side of a modulus alone.
  Eigen::VectorXd ErrorsByBounds(const Eigen::VectorXd& variables) const;

  /// All parameters p(x), and x of those that are not known, moved into the
  /// bounds; not numbers where a stiffness is not positive definite.
  Eigen::VectorXd ParametersAt(const Eigen::VectorXd& variables) const;
  Eigen::VectorXd VariablesOf(Eigen::VectorXd parameters) const;
  /// The variables of some moduli; empty where VariablesOf are not numbers.
  std::optional<Eigen::VectorXd> VariablesOfModuli(
      const Eigen::VectorXd& moduli) const;
  /// dp / dx of the free parameters, size x size.
  Eigen::MatrixXd ParameterJacobian(const Eigen::VectorXd& variables) const;
  /// dp / dx in the units of the errors: for moduli it is d ln p / dx.
  Eigen::MatrixXd RelativeJacobian(const Eigen::VectorXd& variables) const;
  /// theta(x), and d theta / dx (num_moduli x size).
  Eigen::VectorXd ModuliAt(const Eigen::VectorXd& variables) const;
  Eigen::MatrixXd ModuliJacobian(const Eigen::VectorXd& variables) const;

 private:
  bool IsOfFactors(Eigen::Index variable) const {
    return has_factors_[Free(variable).material];
  }
  /// The first variable of each material that has factors as variables.
  std::vector<Eigen::Index> FirstOfFactors() const;

  MaterialParameters all_;
  /// Whether the variables of each material are the factors of its stiffness.
  std::vector<bool> has_factors_;
  std::vector<Bounds> bounds_;
  std::vector<bool> are_bounds_given_;
  Eigen::VectorXd known_;  ///< Typical values where none is known.
};

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_INTERFACE_FREE_PARAMETERS_H_
