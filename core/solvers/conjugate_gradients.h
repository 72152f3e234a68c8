#ifndef ELASTIMATE_CORE_SOLVERS_CONJUGATE_GRADIENTS_H_
#define ELASTIMATE_CORE_SOLVERS_CONJUGATE_GRADIENTS_H_

#include <Eigen/Core>
#include <functional>

#include "elastimate/core/parallel/ranks.h"

namespace elastimate {

/// A matrix or a preconditioner, which maps columns to columns: size x n.
using ColumnOperator = std::function<Eigen::MatrixXd(const Eigen::MatrixXd&)>;

struct ConjugateGradientOptions {
  /// The relative error, in the energy norm, at which a column is done.
  double tolerance = 1e-8;
  int most_iterations = 200;
  /// A first guess of the smallest eigenvalue of M A, which is 1 for M = A^-1.
  double smallest_eigenvalue = 1;
  /// The ranks among which the rows are divided; each calls with its own rows.
  /// Null for one process.
  const Ranks* ranks = nullptr;
};

struct ConjugateGradientResult {
  Eigen::MatrixXd solution;  ///< As far as it was found: size x n.
  /// b - A x where not all columns have converged, size x n; zero in those that
  /// have.
  Eigen::MatrixXd residual;
  bool has_converged = false;  ///< Whether all columns have converged.
  int iterations = 0;          ///< The sum over all columns.
  int products = 0;            ///< Products with A, of any columns each.
  int columns = 0;             ///< Those with a force.
  /// The extreme eigenvalues of M A as the iterations see them (Ritz values).
  /// Without any iteration they are the guess and 0.
  double smallest_eigenvalue = 1;
  double largest_eigenvalue = 0;
};

/// Solves A x = b for each column b of `right_hand_sides` by conjugate
/// gradients that are preconditioned by M [Saad, Iterative Methods for Sparse
/// Linear Systems, algorithm 9.1].
///
/// All columns that are not done share the calls of `multiply` (A) and
/// `precondition` (M).  Both have to be symmetric and positive definite, and M
/// close to A^-1.  A column is done when r^T M r tells that the error is small
/// enough: it is at least the smallest eigenvalue of M A times the squared
/// energy of the error.
///
/// `start` is empty or has a guess of each column, which is first scaled to
/// have the least error; a guess that is not finite is ignored.  The result has
/// not converged where A or M is not positive definite in the directions that
/// were met, where a number is not finite, or after too many iterations.
ConjugateGradientResult SolveByConjugateGradients(
    const ColumnOperator& multiply, const ColumnOperator& precondition,
    Eigen::MatrixXd right_hand_sides, Eigen::MatrixXd start,
    const ConjugateGradientOptions& options);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_SOLVERS_CONJUGATE_GRADIENTS_H_
