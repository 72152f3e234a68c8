#ifndef ELASTIMATE_CORE_SOLVERS_ALGEBRAIC_MULTIGRID_H_
#define ELASTIMATE_CORE_SOLVERS_ALGEBRAIC_MULTIGRID_H_

#include <Eigen/Core>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <functional>
#include <optional>
#include <vector>

#include "elastimate/core/solvers/multigrid_rows.h"
#include "elastimate/core/solvers/multigrid_spaces.h"
#include "elastimate/core/solvers/v_cycle.h"

namespace elastimate {

/// Conjugate gradients, preconditioned by a V-cycle over algebraic coarse
/// spaces.  Time and memory grow linearly with the number of nodes; the number
/// of iterations grows as nu nears 1/2, and with bad elements.
///
/// Coarse spaces are kept for the next matrices, scaled by the ratio of the
/// traces, until solves become slow or a caller of Cycle asks for new ones,
/// because finding these takes as long as about a hundred iterations.
///
/// OpenMP spreads the products of an iteration over the cores there are, except
/// within an outer parallel region.  Where several ranks have the rows, all of
/// them call each function, with their own rows of vectors.
class AlgebraicMultigrid {
 public:
  /// Finds the spaces for the present matrix; tells whether it could.
  using FindSpaces = std::function<bool(MultigridRows&, MultigridSpaces&)>;

  /// `rows` must outlive this object.
  AlgebraicMultigrid(MultigridRows& rows, FindSpaces find_spaces);

  /// Prepares the matrix that the rows now have for Solve and Cycle.
  bool Factorize();
  /// Does what LinearSolver::Solve does, for all rows of the blocks.  Held rows
  /// of `right_hand_sides` and `start` are zero.
  std::optional<Eigen::MatrixXd> Solve(const Eigen::MatrixXd& right_hand_sides,
                                       double tolerance,
                                       const Eigen::MatrixXd& start);
  /// Runs the V-cycle that preconditions Solve.
  Eigen::MatrixXd Cycle(const Eigen::MatrixXd& force) const;
  /// Does what LinearSolver::Renew does.
  bool Renew() { return !are_spaces_of_matrix_ && SetUp(); }
  int NumIterations() const { return num_iterations_; }
  int NumSetUps() const { return num_set_ups_; }

 private:
  bool SetUp();
  void MakeHalos();
  bool FactorizeCoarsest();
  bool AddSpace(const DividedMatrix& matrix);
  Eigen::MatrixXd SolveCoarsest(const Eigen::MatrixXd& own) const;
  bool TakeFinest();
  std::optional<Eigen::MatrixXd> SolveOnce(
      const Eigen::MatrixXd& right_hand_sides, double tolerance,
      const Eigen::MatrixXd& start);

  MultigridRows& rows_;
  FindSpaces find_spaces_;
  MultigridSpaces spaces_;
  std::vector<BlocksByColumn> by_column_;  ///< The blocks of interpolations.
  std::vector<CycleSpace> cycle_;
  /// The factor of the whole coarsest matrix, of which each rank has a copy.
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> coarsest_;
  Eigen::Index first_of_coarsest_ = 0;  ///< The first own row of these.
  bool are_spaces_of_matrix_ = false;
  bool are_spaces_slow_ = true;
  double diagonal_of_spaces_ = 0;  ///< The trace of their own matrix.
  double scale_ = 1;               ///< The present diagonal over that one.
  /// The most iterations for each decimal digit and column that a solve took
  /// with spaces of its own matrix; 0 before any.
  double iterations_per_digit_ = 0;
  /// The smallest eigenvalue of the preconditioned matrix that any solution
  /// met, for any matrix and spaces: a solution with a good guess ends before
  /// it meets the smallest one of its own matrix.
  double smallest_eigenvalue_ = 1;
  int num_iterations_ = 0;
  int num_set_ups_ = 0;
};

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_SOLVERS_ALGEBRAIC_MULTIGRID_H_
