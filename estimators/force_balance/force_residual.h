#ifndef ELASTIMATE_ESTIMATORS_FORCE_BALANCE_FORCE_RESIDUAL_H_
#define ELASTIMATE_ESTIMATORS_FORCE_BALANCE_FORCE_RESIDUAL_H_

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "elastimate/core/mechanics/internal_forces.h"
#include "elastimate/core/mechanics/large_strain_forces.h"
#include "elastimate/core/scene/degrees_of_freedom.h"
#include "elastimate/core/scene/scene.h"
#include "elastimate/core/solvers/stiffness_solver.h"

namespace elastimate {

/// What the force residual of a scene has before anything is measured, for a
/// scene that is measured again and again.
class ForceScene {
 public:
  /// One element pass.  Refers to the mesh of the scene.  Throws
  /// std::invalid_argument where only some of the laws are of large strains.
  explicit ForceScene(const Scene& scene);

  /// The forces of small strains.  Precondition: no law is of large strains.
  const InternalForces& Forces() const { return *forces_; }
  /// The forces of large strains; null where the laws are of small strains.
  const LargeStrainForces* LargeForces() const { return large_forces_.get(); }
  /// Whether the forces are not linear in the moduli: those of large strains in
  /// plane stress are not, since the moduli determine the stretch across the
  /// plate.
  bool AreNonlinearInModuli() const {
    return large_forces_ != nullptr &&
           large_forces_->Parameters().Model() == SectionModel::kPlaneStress;
  }
  const DegreesOfFreedom& Dofs() const { return dofs_; }
  /// The weighted loads in the free rows, zero in the held ones.
  const Eigen::MatrixXd& Loads() const { return loads_; }
  /// T, with T_kl = tr(K_k K_l) over the free degrees of freedom of all load
  /// cases: independent noise of variance sigma^2 in q adds sigma^2 T to the
  /// expectation of F^T F (stiffness_traces.h).  Empty for laws of large
  /// strains, whose traces depend on what is measured (ForceResidual::Traces).
  const Eigen::MatrixXd& Traces() const { return traces_; }
  /// The mean stiffness s = w.theta: the first modulus of each material, or the
  /// shear modulus at rest of a law of large strains, weighted by its share of
  /// the volume.
  const Eigen::VectorXd& Weights() const { return weights_; }

 private:
  std::unique_ptr<const InternalForces> forces_;
  std::unique_ptr<const LargeStrainForces> large_forces_;
  DegreesOfFreedom dofs_;
  Eigen::MatrixXd loads_;
  Eigen::MatrixXd traces_;
  Eigen::VectorXd weights_;
};

/// The force residual F theta - f of a measurement, F = [f_1(q) ... f_m(q)], of
/// the moduli theta of any materials, over the free degrees of freedom of all
/// load cases, compressed to the triangle of a QR factorisation of [F f].  Load
/// cases are weighted: each is divided by its noise_sd where that is given.
///
/// For small strains, noise n in q adds K(theta) n to the residual.  For large
/// strains it does so to first order, with the tangent K(theta) = sum_k theta_k
/// K_k at the measured q of each load case.
///
/// Where forces are not linear in the moduli, F has their derivatives df /
/// dtheta_k at some moduli, and K_k those of the tangent.  F theta is f(q;
/// theta) at these moduli, since forces grow as a factor on all moduli.
class ForceResidual {
 public:
  /// One element pass; for large strains one for each load case, and one more
  /// for each of its moduli.  `prepared` is of this scene, and outlives this
  /// object.  The moduli count only where forces are not linear in them. Throws
  /// std::invalid_argument where a displacement turns an element inside out,
  /// and the law is of large strains. Preconditions: what Estimator::Run
  /// checks, and every free component is observed.
  ForceResidual(const ForceScene& prepared, const Scene& scene,
                const Eigen::VectorXd& moduli = {});

  const ForceScene& Prepared() const { return prepared_; }
  /// ||Columns() theta - Loads()|| is the norm of the residual: (m + 1) rows.
  const Eigen::MatrixXd& Columns() const { return columns_; }
  const Eigen::VectorXd& Loads() const { return loads_; }
  /// The weighted loads in the free rows, zero in the held ones: those of the
  /// prepared scene, but for pressures that follow the surface, which act on
  /// the measured one.  What noise makes of these is left out.
  const Eigen::MatrixXd& NodalLoads() const {
    return nodal_loads_.size() != 0 ? nodal_loads_ : prepared_.Loads();
  }
  /// f_k(q) of all load cases, num_dofs x num_load_cases, for each modulus.
  const std::vector<Eigen::MatrixXd>& Products() const { return products_; }
  /// The displacements of laws of large strains without weights, num_dofs x
  /// num_load_cases; empty for small strains.
  const Eigen::MatrixXd& LargeDisplacements() const {
    return large_displacements_;
  }
  /// T of ForceScene, with the tangents at the measured q for large strains.
  const Eigen::MatrixXd& Traces() const {
    return traces_.size() != 0 ? traces_ : prepared_.Traces();
  }
  /// The norm of the weighted displacements in the free rows.
  double DisplacementNorm() const { return displacement_norm_; }
  /// The free degrees of freedom times the load cases.
  double NumEquations() const { return num_equations_; }

  /// (K(theta) X)^T (K(theta) X) over the free rows, with X = [F f] B for some
  /// combinations B, (m + 1) x n.  One element pass; for large strains one for
  /// each load case.
  Eigen::MatrixXd StiffenedGram(const Eigen::VectorXd& moduli,
                                const Eigen::MatrixXd& combinations);

  /// With that of the prepared scene.
  const Work& WorkDone() const { return work_; }

 private:
  /// Sets the products, the traces and the loads of laws of large strains at
  /// the weighted displacements `q`.
  void SetLargeStrains(const Scene& scene, const Eigen::MatrixXd& q,
                       const Eigen::VectorXd& moduli);
  /// Returns K(theta) X for the load cases of each combination side by side.
  Eigen::MatrixXd Stiffen(const Eigen::VectorXd& moduli,
                          const Eigen::MatrixXd& x) const;

  const ForceScene& prepared_;
  double displacement_norm_;
  /// These are empty for small strains.
  Eigen::MatrixXd large_displacements_;
  Eigen::MatrixXd traces_;
  Eigen::MatrixXd nodal_loads_;
  std::vector<Eigen::MatrixXd> products_;
  Eigen::MatrixXd columns_;
  Eigen::VectorXd loads_;
  double num_equations_;
  Work work_;
};

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_FORCE_BALANCE_FORCE_RESIDUAL_H_
