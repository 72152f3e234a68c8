#ifndef ELASTIMATE_CORE_SOLVERS_V_CYCLE_H_
#define ELASTIMATE_CORE_SOLVERS_V_CYCLE_H_

#include <Eigen/Core>
#include <vector>

#include "elastimate/core/solvers/conjugate_gradients.h"

namespace elastimate {

/// One space of a V-cycle, with the way to the next coarser space and back.
/// Held rows are zero in all columns and all products.
struct CycleSpace {
  ColumnOperator multiply;  ///< K x.
  /// The inverses of the diagonal blocks of K, zero where a row is held.
  Eigen::MatrixXf inverse_blocks;
  double largest_eigenvalue = 0;  ///< LargestEigenvalue, for these blocks.
  ColumnOperator restrict;        ///< From this space to the next coarser one.
  ColumnOperator interpolate;     ///< Its transpose.
};

/// Runs a V(1,1)-cycle for K x = force from x = 0, from the last of `spaces`
/// down; below the first of them, `solve_coarsest` solves or preconditions.  On
/// each space, two steps of Chebyshev's iteration with the diagonal blocks
/// [Adams, Brezina, Hu & Tuminaro, J. Comput. Phys. 188 (2003) 593] come before
/// and after the correction by the coarser spaces.  As a map of forces it is
/// symmetric, and positive definite where K is.
[[nodiscard]] Eigen::MatrixXd VCycle(const std::vector<CycleSpace>& spaces,
                                     const ColumnOperator& solve_coarsest,
                                     const Eigen::MatrixXd& force);

/// Inverts each of some blocks, which stand side by side, as the inverses do.
/// Single precision is enough for a preconditioner.  Precondition: symmetric
/// blocks of 1, 2 or 3 rows.
[[nodiscard]] Eigen::MatrixXf InverseBlocks(const Eigen::MatrixXd& blocks);

/// Makes each inverse that of its block on the free components, with zeros in
/// the rows and columns of the `held` ones, which are numbered over all blocks.
/// Precondition: positive definite blocks.
void HoldInInverses(const std::vector<Eigen::Index>& held,
                    Eigen::MatrixXf& inverse_blocks);

/// Estimates the largest eigenvalue of D^-1 K for the diagonal blocks D; the
/// estimate may be a tenth too small.  The result is NaN where K is seen not to
/// be positive definite.  Takes 6 products; their number is added to
/// `num_products`.  Where several ranks have the rows, all of them call it.
[[nodiscard]] double LargestEigenvalue(const ColumnOperator& multiply,
                                       const Eigen::MatrixXf& inverse_blocks,
                                       int& num_products,
                                       const Ranks* ranks = nullptr);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_SOLVERS_V_CYCLE_H_
