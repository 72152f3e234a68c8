#ifndef ELASTIMATE_CORE_SOLVERS_MULTIGRID_ROWS_H_
#define ELASTIMATE_CORE_SOLVERS_MULTIGRID_ROWS_H_

#include <Eigen/Core>
#include <vector>

#include "elastimate/core/solvers/divided_matrix.h"

namespace elastimate {

/// The rows of the matrices that a multigrid method solves with: those of some
/// nodes, of which this rank has a range.
struct MultigridRows {
  Eigen::MatrixXd positions;   ///< Of the own nodes: dimension x num_nodes.
  bool are_simplices = true;   ///< What the elements are.
  Eigen::Index first_own = 0;  ///< The number of the first own node.
  /// The numbers of the nodes whose values the halo fetches.
  std::vector<int> others;
  const Ranks* ranks = nullptr;  ///< Null where one process has all rows.

  MultigridRows() = default;
  virtual ~MultigridRows() = default;
  MultigridRows(const MultigridRows&) = delete;
  MultigridRows& operator=(const MultigridRows&) = delete;

  /// Returns the present matrix, with its `rest`, and makes it if it is not
  /// there.
  virtual const DividedMatrix& Matrix() = 0;
  /// Frees the memory of the matrix if it can be made again.
  virtual void FreeMatrix() = 0;
};

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_SOLVERS_MULTIGRID_ROWS_H_
