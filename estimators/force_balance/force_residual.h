#ifndef ELASTIMATE_ESTIMATORS_FORCE_BALANCE_FORCE_RESIDUAL_H_
#define ELASTIMATE_ESTIMATORS_FORCE_BALANCE_FORCE_RESIDUAL_H_

#include <Eigen/Core>
#include <vector>

#include "elastimate/core/mechanics/internal_forces.h"
#include "elastimate/core/scene/degrees_of_freedom.h"
#include "elastimate/core/scene/scene.h"
#include "elastimate/core/solvers/stiffness_solver.h"

namespace elastimate {

/// What the force residual of a scene has before anything is measured, for a
/// scene that is measured again and again.
class ForceScene {
 public:
  /// One element pass.  Refers to the mesh of the scene.
  explicit ForceScene(const Scene& scene);

  const InternalForces& Forces() const { return forces_; }
  const DegreesOfFreedom& Dofs() const { return dofs_; }
  /// The weighted loads in the free rows, zero in the held ones.
  const Eigen::MatrixXd& Loads() const { return loads_; }
  /// T, with T_kl = tr(K_k K_l) over the free degrees of freedom of all load
  /// cases: independent noise of variance sigma^2 in q adds sigma^2 T to the
  /// expectation of F^T F (stiffness_traces.h).
  const Eigen::MatrixXd& Traces() const { return traces_; }
  /// The mean stiffness s = w.theta: the first modulus of each material,
  /// weighted by its share of the volume.
  const Eigen::VectorXd& Weights() const { return weights_; }

 private:
  InternalForces forces_;
  DegreesOfFreedom dofs_;
  Eigen::MatrixXd loads_;
  Eigen::MatrixXd traces_;
  Eigen::VectorXd weights_;
};

/// The force residual F theta - f of a measurement, F = [f_1(q) ... f_m(q)], of
/// the moduli theta of any materials, over the free degrees of freedom of all
/// load cases, compressed to the triangle of a QR factorisation of [F f].  Load
/// cases are weighted: each is divided by its noise_sd where that is given.
class ForceResidual {
 public:
  /// One element pass.  `prepared` is of this scene, and outlives this object.
  /// Preconditions: what Estimator::Run checks, and every free component is
  /// observed.
  ForceResidual(const ForceScene& prepared, const Scene& scene);

  const ForceScene& Prepared() const { return prepared_; }
  /// ||Columns() theta - Loads()|| is the norm of the residual: (m + 1) rows.
  const Eigen::MatrixXd& Columns() const { return columns_; }
  const Eigen::VectorXd& Loads() const { return loads_; }
  /// f_k(q) of all load cases, num_dofs x num_load_cases, for each modulus.
  const std::vector<Eigen::MatrixXd>& Products() const { return products_; }
  /// The norm of the weighted displacements in the free rows.
  double DisplacementNorm() const { return displacement_norm_; }
  /// The free degrees of freedom times the load cases.
  double NumEquations() const { return num_equations_; }

  /// (K(theta) X)^T (K(theta) X) over the free rows, with X = [F f] B for some
  /// combinations B, (m + 1) x n.  One element pass.
  Eigen::MatrixXd StiffenedGram(const Eigen::VectorXd& moduli,
                                const Eigen::MatrixXd& combinations);

  /// With that of the prepared scene.
  const Work& WorkDone() const { return work_; }

 private:
  const ForceScene& prepared_;
  double displacement_norm_;
  std::vector<Eigen::MatrixXd> products_;
  Eigen::MatrixXd columns_;
  Eigen::VectorXd loads_;
  double num_equations_;
  Work work_;
};

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_FORCE_BALANCE_FORCE_RESIDUAL_H_
