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
/// Matrices for several load cases hold the columns of the first load case,
/// then those of the second, and so on, the same number for each.  Functions
/// that describe a solution have the precondition that the last Solve returned
/// true.
class ForwardModel {
 public:
  virtual ~ForwardModel() = default;

  /// Finds the equilibrium u at these moduli.  Returns false if none is found
  /// that is stable to working precision.
  [[nodiscard]] virtual bool Solve(const Eigen::VectorXd& moduli) = 0;
  /// Tells the model displacements (num_dofs x num_load_cases) near which the
  /// next Solve is to search, such as those of coarser elements.  A model that
  /// does not iterate ignores them.
  virtual void BeginWith(const Eigen::MatrixXd& /*displacement*/) {}
  /// Says why the last Solve returned false, and what the user can do about it.
  /// Empty if the only known reason is a singular stiffness.
  virtual const std::string& WhyNotSolved() const {
    static const std::string none;
    return none;
  }

  /// u of all load cases, num_dofs x num_load_cases [length].
  virtual const Eigen::MatrixXd& Displacement() const = 0;
  /// Returns the loads F, num_dofs x num_load_cases [force].
  virtual const Eigen::MatrixXd& Load() const = 0;

  /// Returns du/dp = -K^-1 df/dtheta dtheta/dp for the directions dtheta/dp
  /// (num_moduli x n), n columns for each load case.
  virtual Eigen::MatrixXd Sensitivities(const Eigen::MatrixXd& directions) = 0;
  /// Returns K^-1 f on the free rows, zero in the held rows, for n columns of
  /// forces of each load case.
  virtual Eigen::MatrixXd SolveFor(const Eigen::MatrixXd& forces) = 0;
  /// Returns f_k(u) of a displacement (num_dofs) as columns, num_dofs x
  /// num_moduli.
  virtual Eigen::MatrixXd ForceColumns(
      const Eigen::VectorXd& displacement) const = 0;

  /// Returns the change of u, to first order and at constant loads, if the held
  /// degrees of freedom move by `held` (zero in the free rows); n columns for
  /// each load case.  Extend, ExtendTransposed, MoveSupports and the functions
  /// of support forces may be called only if the motion of some supports is
  /// unknown (HasUnknownMotion).
  virtual Eigen::MatrixXd Extend(const Eigen::MatrixXd& held) = 0;
  /// Multiplies by the transpose of Extend; the free rows are zero.
  virtual Eigen::MatrixXd ExtendTransposed(const Eigen::MatrixXd& values) = 0;
  /// Does what Extend does, for load case `k` only: num_dofs x n.
  virtual Eigen::MatrixXd ExtendInCase(Eigen::Index k,
                                       const Eigen::MatrixXd& held) = 0;
  /// Moves the supports of each load case by `held` (num_dofs x
  /// num_load_cases), in addition to the displacement that the scene gives and
  /// to earlier calls since Solve, and finds the new equilibrium.  Returns
  /// false as Solve does.
  [[nodiscard]] virtual bool MoveSupports(const Eigen::MatrixXd& held) = 0;
  /// Finds the equilibrium at these moduli with supports that are moved by
  /// `held`, as Solve and then MoveSupports do.
  [[nodiscard]] virtual bool SolveMoved(const Eigen::VectorXd& moduli,
                                        const Eigen::MatrixXd& held) {
    return Solve(moduli) && MoveSupports(held);
  }
  /// Tells whether u is linear in the motion of supports, so that Extend is
  /// exact.
  virtual bool IsLinear() const = 0;

  /// Returns the product of K and `displacements` in the held rows, and zeros
  /// in the free rows; n columns for each load case.
  virtual Eigen::MatrixXd HeldForces(
      const Eigen::MatrixXd& displacements) const = 0;
  /// Multiplies by the transpose of HeldForces.  Only the held rows of `held`
  /// are used.
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
