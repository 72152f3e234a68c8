#ifndef ELASTIMATE_CORE_EQUILIBRIUM_FORWARD_MODEL_H_
#define ELASTIMATE_CORE_EQUILIBRIUM_FORWARD_MODEL_H_

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "elastimate/core/materials/material_parameters.h"
#include "elastimate/core/mesh/node_graph.h"
#include "elastimate/core/scene/scene.h"
#include "elastimate/core/solvers/stiffness_solver.h"

namespace elastimate {

/// The displacements of a specimen in equilibrium as a function of its moduli,
///
///   f(u; theta) = sum_k theta_k f_k(u) = F on the free degrees of freedom,
///   u given on the held ones,
///
/// in each load case, with the tangent K = df / du there.  At small strains
/// f_k(u) = K_k u, and K does not depend on u (Equilibrium); at large strains
/// Newton's method finds u (LargeStrainModel).
///
/// Columns of several load cases stand side by side, the same number of each.
/// All functions but Solve have the precondition that it returned true.
class ForwardModel {
 public:
  virtual ~ForwardModel() = default;

  /// Finds u at these moduli.  False when there is none that is stable to
  /// working precision.
  [[nodiscard]] virtual bool Solve(const Eigen::VectorXd& moduli) = 0;
  /// Gives displacements (num_dofs x num_load_cases) that are near those of the
  /// first Solve, such as those of coarser elements.  A model that does not
  /// iterate has no use for them.
  virtual void BeginWith(const Eigen::MatrixXd& /*displacement*/) {}
  /// Says why the last Solve returned false, and what mends it; empty where
  /// there is nothing more to say than that the stiffness is singular.
  virtual const std::string& WhyNotSolved() const {
    static const std::string none;
    return none;
  }

  /// u of all load cases, num_dofs x num_load_cases [length].
  virtual const Eigen::MatrixXd& Displacement() const = 0;
  /// Returns the loads F, num_dofs x num_load_cases [force].
  virtual const Eigen::MatrixXd& Load() const = 0;

  /// du / dp = -K^-1 df/dtheta dtheta/dp for directions d theta / d p
  /// (num_moduli x n): n columns of each load case.
  virtual Eigen::MatrixXd Sensitivities(const Eigen::MatrixXd& directions) = 0;
  /// Returns K^-1 f on the free rows, zero in the held rows, for n columns of
  /// forces of each load case.
  virtual Eigen::MatrixXd SolveFor(const Eigen::MatrixXd& forces) = 0;
  /// Returns f_k(u) of a displacement (num_dofs) as columns, num_dofs x
  /// num_moduli.
  virtual Eigen::MatrixXd ForceColumns(
      const Eigen::VectorXd& displacement) const = 0;

  /// Returns the change of u without a change of loads where the held degrees
  /// of freedom move by `held` (zero in the free rows), to first order; n
  /// columns of each load case.  Extend, ExtendTransposed, MoveSupports and the
  /// forces of supports are there only for a scene of unknown motion
  /// (HasUnknownMotion).
  virtual Eigen::MatrixXd Extend(const Eigen::MatrixXd& held) = 0;
  /// Multiplies by the transpose of Extend; the free rows are zero.
  virtual Eigen::MatrixXd ExtendTransposed(const Eigen::MatrixXd& values) = 0;
  /// Does what Extend does for num_dofs x n displacements of load case `k`.
  virtual Eigen::MatrixXd ExtendInCase(Eigen::Index k,
                                       const Eigen::MatrixXd& held) = 0;
  /// Moves the supports of each load case by `held` (num_dofs x
  /// num_load_cases), beside what the scene gives and former calls moved since
  /// Solve.  False as Solve.
  [[nodiscard]] virtual bool MoveSupports(const Eigen::MatrixXd& held) = 0;
  /// Does what Solve and then MoveSupports do.
  [[nodiscard]] virtual bool SolveMoved(const Eigen::VectorXd& moduli,
                                        const Eigen::MatrixXd& held) {
    return Solve(moduli) && MoveSupports(held);
  }
  /// Tells whether u is linear in the motion of supports, so that Extend is
  /// exact.
  virtual bool IsLinear() const = 0;

  /// Returns the held rows of K times the columns, n of each load case, and
  /// zeros in the free rows.
  virtual Eigen::MatrixXd HeldForces(
      const Eigen::MatrixXd& displacements) const = 0;
  /// Multiplies by the transpose of HeldForces; `held` counts in the held rows.
  virtual Eigen::MatrixXd HeldForcesTransposed(
      const Eigen::MatrixXd& held) const = 0;
  /// Does what HeldForces does for num_dofs x n columns of load case `k`.
  virtual Eigen::MatrixXd HeldForcesInCase(
      Eigen::Index k, const Eigen::MatrixXd& displacements) const = 0;
  /// Returns the forces that the supports exert in each load case, f(u) - F in
  /// the held rows and zero in the free ones: num_dofs x num_load_cases
  /// [force].
  virtual Eigen::MatrixXd SupportForces() const = 0;
  /// Returns the derivatives of SupportForces along the directions whose
  /// Sensitivities are given, in the same order.  A pass for each load case.
  virtual Eigen::MatrixXd SupportForceSensitivities(
      const Eigen::MatrixXd& directions,
      const Eigen::MatrixXd& sensitivities) = 0;

  virtual const MaterialParameters& Parameters() const = 0;
  virtual const NodeGraph& Graph() const = 0;
  virtual Work WorkDone() const = 0;
  /// Returns the first StiffnessSolver::Notice that is not empty.
  virtual const std::string& Notice() const = 0;
};

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_EQUILIBRIUM_FORWARD_MODEL_H_
