#ifndef ELASTIMATE_CORE_SOLVERS_ALGEBRAIC_MULTIGRID_H_
#define ELASTIMATE_CORE_SOLVERS_ALGEBRAIC_MULTIGRID_H_

#include <Eigen/Core>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <functional>
#include <optional>
#include <vector>

#include "elastimate/core/solvers/linear_solver.h"
#include "elastimate/core/solvers/multigrid_spaces.h"
#include "elastimate/core/solvers/v_cycle.h"

namespace elastimate {

/// Conjugate gradients, preconditioned by a V-cycle over algebraic coarse
/// spaces.  Time and memory grow linearly with the number of nodes; the number
/// of iterations grows as nu nears 1/2, and with bad elements.
///
/// The products of an iteration take the cores there are, by OpenMP, and so do
/// not those that an outer parallel region shares.
class AlgebraicMultigrid : public LinearSolver {
 public:
  /// Finds the spaces for a matrix of these values in the pattern; tells
  /// whether it could.
  using FindSpaces =
      std::function<bool(const Eigen::VectorXd& values, MultigridSpaces&)>;

  explicit AlgebraicMultigrid(FindSpaces find_spaces);

  bool Factorize(const Eigen::VectorXd& values) override;
  std::optional<Eigen::MatrixXd> Solve(const Eigen::MatrixXd& right_hand_sides,
                                       double tolerance) override;
  int NumIterations() const override { return num_iterations_; }

 private:
  bool SetUpCycle();
  bool FactorizeCoarsest();

  FindSpaces find_spaces_;
  MultigridSpaces spaces_;
  std::vector<BlockMatrix> restrictions_;  ///< The interpolations, transposed.
  std::vector<CycleSpace> cycle_;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> coarsest_;
  /// The smallest eigenvalue of the preconditioned matrix that any solution
  /// met so far.
  double smallest_eigenvalue_ = 1;
  int num_iterations_ = 0;
};

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_SOLVERS_ALGEBRAIC_MULTIGRID_H_
