#ifndef ELASTIMATE_CORE_ALGEBRA_TALL_COLUMNS_H_
#define ELASTIMATE_CORE_ALGEBRA_TALL_COLUMNS_H_

#include <Eigen/Core>
#include <functional>

namespace elastimate {

// Operations on a few columns with a row for each degree of freedom.  Two
// arguments have the same size, and there is a factor for each column.
// OpenMP's threads share blocks of rows, and no operation needs memory of the
// size of a column.  The bits do not depend on the number of threads.

/// Calls work(first, count) for blocks of rows that cover all of them once.
/// `work` must not write outside of its rows.
void ForRowBlocks(
    Eigen::Index num_rows,
    const std::function<void(Eigen::Index first, Eigen::Index count)>& work);

/// Returns the inner product of each column of `a` with that of `b`.
[[nodiscard]] Eigen::RowVectorXd ColumnProducts(const Eigen::MatrixXd& a,
                                                const Eigen::MatrixXd& b);

/// Returns the sum of the absolute values in each column.
[[nodiscard]] Eigen::RowVectorXd ColumnMagnitudes(const Eigen::MatrixXd& a);

/// Adds each column of `a` to that of `sum`.
void AddTo(Eigen::MatrixXd& sum, const Eigen::MatrixXd& a);
/// Adds each column of `a` times its factor to that of `sum`.
void AddTo(Eigen::MatrixXd& sum, const Eigen::MatrixXd& a,
           const Eigen::RowVectorXd& factors);

/// Multiplies each column by its factor.
void Scale(Eigen::MatrixXd& columns, const Eigen::RowVectorXd& factors);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_ALGEBRA_TALL_COLUMNS_H_
