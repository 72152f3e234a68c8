#ifndef ELASTIMATE_CORE_SOLVERS_LINEAR_SOLVER_H_
#define ELASTIMATE_CORE_SOLVERS_LINEAR_SOLVER_H_

#include <Eigen/Core>
#include <optional>

#include "elastimate/core/algebra/eigen_abi.h"

namespace elastimate {

/// Solves linear systems with the symmetric positive definite matrices that
/// share the pattern of one StiffnessAssembly.
class LinearSolver {
 public:
  LinearSolver() = default;
  virtual ~LinearSolver() = default;
  LinearSolver(const LinearSolver&) = delete;
  LinearSolver& operator=(const LinearSolver&) = delete;

  /// Prepares the matrix of these values (in the order of the pattern) for
  /// Solve and Precondition, which may read them again: they must stay as they
  /// are until the next Factorize.  Returns false when that fails: the matrix
  /// may be singular to working precision.  Throws std::bad_alloc when there is
  /// not enough memory.
  virtual bool Factorize(const Eigen::VectorXd& values) = 0;

  /// Returns the solution x for each column of `right_hand_sides`, size x n.
  /// Its error is at most `tolerance` |x| in the energy norm |x|^2 = x^T A x; a
  /// direct solver does as well as it can.  Iterations begin with `start`,
  /// which is empty or has a guess of each column, scaled in any way.  Empty
  /// when the tolerance was not reached.
  /// Precondition: the last Factorize returned true.
  virtual std::optional<Eigen::MatrixXd> Solve(
      const Eigen::MatrixXd& right_hand_sides, double tolerance,
      const Eigen::MatrixXd& start) = 0;

  /// Returns M x for each column x.  M is symmetric positive definite and close
  /// to A^-1: it is A^-1 in a direct solver, and one cycle in multigrid.
  /// Precondition: as for Solve.
  virtual Eigen::MatrixXd Precondition(const Eigen::MatrixXd& columns) = 0;
  /// Has Precondition serve the present matrix as well as it can, where
  /// Factorize has kept coarse spaces of another one.  Returns whether that
  /// changed anything.  Precondition: as for Solve.
  virtual bool Renew() { return false; }
  /// Gives back the memory that Precondition does not need.  Returns whether
  /// there was any; Solve and Renew then need another Factorize.
  virtual bool KeepPreconditioner() { return false; }

  /// Returns the iterations of all columns until now; 0 for a direct solver.
  virtual int NumIterations() const { return 0; }
  /// Returns how often coarse spaces were set up; 0 for a direct solver.
  virtual int NumSetUps() const { return 0; }
};

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_SOLVERS_LINEAR_SOLVER_H_
