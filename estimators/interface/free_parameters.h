#ifndef ELASTIMATE_ESTIMATORS_INTERFACE_FREE_PARAMETERS_H_
#define ELASTIMATE_ESTIMATORS_INTERFACE_FREE_PARAMETERS_H_

#include <Eigen/Core>
#include <vector>

#include "elastimate/core/materials/material_parameters.h"
#include "elastimate/core/scene/scene.h"
#include "elastimate/estimators/interface/estimator.h"

namespace elastimate {

/// The parameters of a scene that are not known, as the variables x of a fit:
/// ln of moduli, ratios as they are.
class FreeParameters {
 public:
  /// Precondition: a valid scene and valid options.
  FreeParameters(const Scene& scene, const EstimatorOptions& options);

  const MaterialParameters& All() const { return all_; }
  Eigen::Index Size() const { return Eigen::Index(all_.Free().size()); }

  /// The bounds of each variable: as given for its material, else by the
  /// options, and the range of its law.
  const std::vector<Bounds>& VariableBounds() const { return bounds_; }

  /// All parameters p(x), and x of them, moved into the bounds.
  Eigen::VectorXd ParametersAt(const Eigen::VectorXd& variables) const;
  Eigen::VectorXd VariablesOf(const Eigen::VectorXd& parameters) const;
  /// dp_i / dx_i of the free parameters.
  Eigen::VectorXd Slopes(const Eigen::VectorXd& variables) const;
  /// theta(x), and d theta / dx (num_moduli x size).
  Eigen::VectorXd ModuliAt(const Eigen::VectorXd& variables) const;
  Eigen::MatrixXd ModuliJacobian(const Eigen::VectorXd& variables) const;

 private:
  const LawParameter& LawParameterOf(Eigen::Index variable) const {
    return *all_.All()[all_.Free()[variable]].law_parameter;
  }

  MaterialParameters all_;
  std::vector<Bounds> bounds_;
  Eigen::VectorXd known_;  ///< Typical values where none is known.
};

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_INTERFACE_FREE_PARAMETERS_H_
