#ifndef ELASTIMATE_CORE_EQUILIBRIUM_EQUILIBRIUM_H_
#define ELASTIMATE_CORE_EQUILIBRIUM_EQUILIBRIUM_H_

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <string>

#include "elastimate/core/mechanics/internal_forces.h"
#include "elastimate/core/scene/scene.h"
#include "elastimate/core/solvers/stiffness_solver.h"

namespace elastimate {

/// Equilibrium of small strains of the materials of a scene,
///
///   K(theta) u = f on the free degrees of freedom, u given on the held ones,
///
/// and its sensitivities du / d theta_k = -K^-1 K_k u.  ForwardModel is faster
/// for one isotropic material.
class Equilibrium {
 public:
  /// Assembles the pattern and analyses it.  Preconditions and exceptions are
  /// those of StiffnessSolver.
  Equilibrium(const Scene& scene, SolverKind solver);

  /// Solves for u at these moduli: an element pass, a factorisation and a solve
  /// for each load case (one more with held displacements).  False when the
  /// stiffness is not positive definite to working precision; there is no u
  /// then.
  bool Solve(const Eigen::VectorXd& moduli);

  /// u of all load cases, num_dofs x num_load_cases [length].
  const Eigen::MatrixXd& Displacement() const { return displacement_; }

  /// The part of u that the held displacements cause, which does not change
  /// when all moduli are multiplied by a factor: num_dofs values.
  const Eigen::VectorXd& SupportResponse() const { return support_response_; }

  /// du / dp for directions d theta / d p (num_moduli x n): one num_dofs x
  /// n matrix for each load case, side by side.  A pass and n solves for each
  /// load case.  Precondition: Solve returned true.
  Eigen::MatrixXd Sensitivities(const Eigen::MatrixXd& directions);

  /// u in equilibrium without loads, of displacements of the held degrees of
  /// freedom alone (num_dofs x n, zero in the free rows): n solves.  This, its
  /// transpose and forces of supports are there for a scene of unknown motion
  /// (HasUnknownMotion).  Precondition: Solve returned true.
  Eigen::MatrixXd Extend(const Eigen::MatrixXd& held);
  /// The transpose of Extend, zero in the free rows: n solves.
  Eigen::MatrixXd ExtendTransposed(const Eigen::MatrixXd& values);
  /// Adds displacements of each load case that Extend returned.
  void Superpose(const Eigen::MatrixXd& displacement);

  /// K of the held rows times some columns, zero in the free rows.
  Eigen::MatrixXd HeldForces(const Eigen::MatrixXd& displacements) const;
  /// Its transpose, of values in the held rows.
  Eigen::MatrixXd HeldForcesTransposed(const Eigen::MatrixXd& held) const;
  /// The forces that the supports exert in each load case, K u - f in the held
  /// rows, zero in the free ones: num_dofs x num_load_cases [force].
  Eigen::MatrixXd SupportForces() const;
  /// Their derivatives along the directions whose Sensitivities are given, in
  /// the same order.  A pass for each load case.
  Eigen::MatrixXd SupportForceSensitivities(
      const Eigen::MatrixXd& directions, const Eigen::MatrixXd& sensitivities);

  const InternalForces& Forces() const { return forces_; }
  const NodeGraph& Graph() const { return solver_.Graph(); }
  Work WorkDone() const;
  /// That of StiffnessSolver.
  const std::string& Notice() const { return solver_.Notice(); }

 private:
  bool IsHeld(Eigen::Index dof) const { return solver_.Dofs().place[dof] < 0; }
  /// The held rows of the stiffness of these blocks.
  void AssembleHeldRows(const Eigen::MatrixXd& blocks);
  /// `values` in the held rows, zero in the free.
  Eigen::MatrixXd OfHeld(Eigen::MatrixXd values) const;

  InternalForces forces_;
  StiffnessSolver solver_;
  Eigen::MatrixXd load_;
  Eigen::VectorXd held_displacement_;
  /// f_k of the held displacements alone; empty where they are zero.
  Eigen::MatrixXd held_forces_;
  Eigen::MatrixXd displacement_;
  Eigen::VectorXd support_response_;
  double scale_ = 1;  ///< Of the moduli over those of the factor.
  /// The held rows of the factor's stiffness, where motions are unknown.
  bool has_unknown_motion_;
  Eigen::SparseMatrix<double, Eigen::RowMajor> held_rows_;
  int element_passes_ = 0;
};

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_EQUILIBRIUM_EQUILIBRIUM_H_
