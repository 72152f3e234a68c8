#ifndef ELASTIMATE_CORE_EQUILIBRIUM_SUPPORTED_STIFFNESS_H_
#define ELASTIMATE_CORE_EQUILIBRIUM_SUPPORTED_STIFFNESS_H_

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include "elastimate/core/mesh/mesh.h"
#include "elastimate/core/scene/supports.h"
#include "elastimate/core/solvers/stiffness_solver.h"

namespace elastimate {

/// A stiffness K on some supports, in blocks of free and held degrees of
/// freedom: K_ff, which is factorised, and the held rows (K_hf, K_hh).
class SupportedStiffness {
 public:
  /// Preconditions and exceptions are those of StiffnessSolver.
  SupportedStiffness(const Mesh& mesh, const Supports& supports,
                     SolverKind solver);

  /// Factorises K of these blocks (StiffnessSolver::FactorizeBlocks), and
  /// assembles the held rows where they are asked for.  False when K_ff is
  /// singular to working precision.
  bool Factorize(const Eigen::MatrixXd& blocks, bool with_held_rows);

  /// K_ff^-1 of the free rows of each column of `all` (num_dofs x n), zero in
  /// the held rows.  Precondition: Factorize returned true, as below.
  Eigen::MatrixXd Solve(const Eigen::MatrixXd& all) {
    return solver_.Solve(all);
  }

  /// u in equilibrium without loads, of displacements of the held degrees of
  /// freedom alone (num_dofs x n, zero in the free rows): n solves.  This, and
  /// what is below, needs the held rows.
  Eigen::MatrixXd Extend(const Eigen::MatrixXd& held);
  /// The transpose of Extend, zero in the free rows: n solves.
  Eigen::MatrixXd ExtendTransposed(const Eigen::MatrixXd& values);
  /// K of the held rows times some columns, zero in the free rows.
  Eigen::MatrixXd HeldForces(const Eigen::MatrixXd& displacements) const {
    return held_rows_ * displacements;
  }
  /// Its transpose, of values in the held rows.
  Eigen::MatrixXd HeldForcesTransposed(const Eigen::MatrixXd& held) const {
    return held_rows_.transpose() * held;
  }

  /// `values` in the held rows, zero in the free.
  Eigen::MatrixXd OfHeld(Eigen::MatrixXd values) const;

  const StiffnessSolver& Solver() const { return solver_; }

 private:
  void AssembleHeldRows(const Eigen::MatrixXd& blocks);

  StiffnessSolver solver_;
  Eigen::SparseMatrix<double, Eigen::RowMajor> held_rows_;
};

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_EQUILIBRIUM_SUPPORTED_STIFFNESS_H_
