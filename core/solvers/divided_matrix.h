#ifndef ELASTIMATE_CORE_SOLVERS_DIVIDED_MATRIX_H_
#define ELASTIMATE_CORE_SOLVERS_DIVIDED_MATRIX_H_

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "elastimate/core/parallel/ranks.h"
#include "elastimate/core/solvers/block_matrix.h"

namespace elastimate {

/// The rows of a matrix that this rank has.  Its columns are the own ones and
/// then those of other ranks, which the halo knows.  One rank alone has all
/// rows, and no halo.
struct DividedMatrix {
  BlockMatrix rows;
  std::shared_ptr<const Halo> halo;
};

/// Numbers the columns of blocks again: those that had the `num_own` numbers
/// from `first_own` on from 0, and the others behind them, in ascending order
/// of their old numbers, which are returned.
std::vector<int> NumberOwnColumnsFirst(Eigen::Index first_own,
                                       Eigen::Index num_own, BlockMatrix& rows);

/// Numbers the columns likewise and makes the halo, by all ranks.
void MakeHalo(Eigen::Index first_own, Eigen::Index num_own, const Ranks& ranks,
              DividedMatrix& a);

/// The rows of A X, A^T X and, with the `rest` of A, (A + rest) X.
[[nodiscard]] Eigen::MatrixXd Multiply(const DividedMatrix& a,
                                       const Eigen::MatrixXd& x);
[[nodiscard]] Eigen::MatrixXd MultiplyTransposed(
    const DividedMatrix& a, const BlocksByColumn& by_column,
    const Eigen::MatrixXd& x);
[[nodiscard]] Eigen::MatrixXd MultiplyAccurately(const DividedMatrix& a,
                                                 const Eigen::MatrixXd& x);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_SOLVERS_DIVIDED_MATRIX_H_
