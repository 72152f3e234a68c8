#include "apps/result_fields.h"

#include "elastimate/core/equilibrium/forward_model.h"
#include "elastimate/core/mechanics/stiffness_product.h"
#include "elastimate/core/mechanics/strain_energy.h"
#include "elastimate/core/scene/loads.h"
#include "elastimate/core/scene/quadratic_scene.h"
#include "elastimate/core/scene/rigid_motion.h"
#include "elastimate/estimators/interface/estimator.h"

namespace elastimate {
namespace {

std::string CaseSuffix(Eigen::Index load_case) {
  return load_case == 0 ? "" : "_" + std::to_string(load_case + 1);
}

// K u - f, where u is num_dofs x num_load_cases.
Eigen::MatrixXd Imbalance(const Scene& scene,
                          const IsotropicElasticity& elasticity,
                          const Eigen::MatrixXd& displacement,
                          const Eigen::MatrixXd& force) {
  const StiffnessProducts products =
      MultiplyStiffnessBasis(scene.mesh, displacement);
  return elasticity.StiffnessScale(scene.mesh.section.model) *
             (products.h + elasticity.poisson_ratio * products.j) -
         force;
}

class FieldCollector {
 public:
  // Shows the first nodes, which are those of `shown`.
  FieldCollector(const Mesh& shown, Fields& fields)
      : shown_(shown), fields_(fields) {}

  void AddPoint(const std::string& name, Eigen::Index load_case,
                const Eigen::MatrixXd& all) {
    fields_.point.push_back(
        {name + CaseSuffix(load_case),
         all.col(load_case)
             .head(shown_.NumDofs())
             .reshaped(shown_.Dimension(), shown_.NumNodes())});
  }

  void AddStrainEnergy(const Mesh& mesh, const IsotropicElasticity& elasticity,
                       Eigen::Index load_case, const Eigen::MatrixXd& all) {
    fields_.cell.push_back(
        {"strain_energy_density" + CaseSuffix(load_case),
         StrainEnergyDensity(
             mesh, elasticity,
             all.col(load_case).reshaped(mesh.Dimension(), mesh.NumNodes()))
             .transpose()});
  }

 private:
  const Mesh& shown_;
  Fields& fields_;
};

Eigen::MatrixXd MeasuredMinus(const Scene& scene,
                              const Eigen::MatrixXd& displacement) {
  Eigen::MatrixXd difference =
      Eigen::MatrixXd::Zero(displacement.rows(), displacement.cols());
  const int dimension = scene.mesh.Dimension();
  for (Eigen::Index k = 0; k < displacement.cols(); ++k) {
    const LoadCase& load_case = scene.load_cases[k];
    for (Eigen::Index dof = 0; dof < displacement.rows(); ++dof) {
      const Eigen::Index node = dof / dimension;
      if (IsObserved(load_case, dof % dimension, node)) {
        difference(dof, k) = load_case.displacement(dof % dimension, node) -
                             displacement(dof, k);
      }
    }
  }
  return difference;
}

}  // namespace

Fields ResultFields(const Scene& scene, const Scene& modelled,
                    const Estimate& estimate, SolverKind solver) {
  Fields fields = SceneFields(scene);
  if (!estimate.elasticity.IsPhysical()) {
    return fields;
  }
  FieldCollector collector(scene.mesh, fields);
  const Eigen::Index num_cases = Eigen::Index(scene.load_cases.size());
  if (!WhyNotHeld(scene.mesh, scene.supports).empty()) {
    const Eigen::MatrixXd force = AssembleLoadCases(scene);
    const Eigen::MatrixXd measured =
        MeasuredMinus(scene, Eigen::MatrixXd::Zero(force.rows(), num_cases));
    const Eigen::MatrixXd residual =
        Imbalance(scene, estimate.elasticity, measured, force);
    for (Eigen::Index k = 0; k < num_cases; ++k) {
      collector.AddPoint("force_residual", k, residual);
      collector.AddStrainEnergy(scene.mesh, estimate.elasticity, k, measured);
    }
    return fields;
  }
  const Eigen::MatrixXd force = AssembleLoadCases(modelled);
  ForwardModel model(modelled.mesh, modelled.supports, force, solver);
  if (!model.SetPoissonRatio(estimate.elasticity.poisson_ratio)) {
    return fields;
  }
  const Eigen::MatrixXd fitted =
      model.Displacement(estimate.elasticity.youngs_modulus);
  const Eigen::MatrixXd difference = MeasuredMinus(modelled, fitted);
  const Eigen::MatrixXd imbalance =
      Imbalance(modelled, estimate.elasticity, fitted, force);
  const Eigen::MatrixXd held_imbalance = modelled.supports.held.reshaped()
                                             .replicate(1, num_cases)
                                             .select(imbalance.array(), 0.0);
  const Eigen::MatrixXd reaction =
      scene.mesh.Order() == 2 ? held_imbalance
                              : VertexForces(modelled.mesh, held_imbalance);
  for (Eigen::Index k = 0; k < num_cases; ++k) {
    collector.AddPoint("fitted_displacement", k, fitted);
    collector.AddPoint("displacement_residual", k, difference);
    collector.AddPoint("reaction_force", k, reaction);
    collector.AddStrainEnergy(modelled.mesh, estimate.elasticity, k, fitted);
  }
  return fields;
}

}  // namespace elastimate
