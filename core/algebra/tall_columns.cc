#include "elastimate/core/algebra/tall_columns.h"

#include <algorithm>

namespace elastimate {
namespace {

// Starting a thread takes about as long as the work on this many rows.
constexpr Eigen::Index kRows = 20000;

Eigen::Index NumBlocks(Eigen::Index num_rows) {
  return (num_rows + kRows - 1) / kRows;
}

// Adds up sum(first, count), a row with a value for each column, over all
// blocks of rows.
template <class Sum>
Eigen::RowVectorXd SumOverRowBlocks(Eigen::Index num_rows,
                                    Eigen::Index num_columns, const Sum& sum) {
  Eigen::MatrixXd of_blocks(NumBlocks(num_rows), num_columns);
  ForRowBlocks(num_rows, [&](Eigen::Index first, Eigen::Index count) {
    of_blocks.row(first / kRows) = sum(first, count);
  });
  return of_blocks.colwise().sum();
}

}  // namespace

void ForRowBlocks(
    Eigen::Index num_rows,
    const std::function<void(Eigen::Index first, Eigen::Index count)>& work) {
  const Eigen::Index num_blocks = NumBlocks(num_rows);
#pragma omp parallel for schedule(static) if (num_blocks > 1)
  for (Eigen::Index i = 0; i < num_blocks; ++i) {
    const Eigen::Index first = kRows * i;
    work(first, std::min(kRows, num_rows - first));
  }
}

Eigen::RowVectorXd ColumnProducts(const Eigen::MatrixXd& a,
                                  const Eigen::MatrixXd& b) {
  return SumOverRowBlocks(a.rows(), a.cols(),
                          [&](Eigen::Index first, Eigen::Index count) {
                            return a.middleRows(first, count)
                                .cwiseProduct(b.middleRows(first, count))
                                .colwise()
                                .sum()
                                .eval();
                          });
}

Eigen::RowVectorXd ColumnMagnitudes(const Eigen::MatrixXd& a) {
  return SumOverRowBlocks(
      a.rows(), a.cols(), [&](Eigen::Index first, Eigen::Index count) {
        return a.middleRows(first, count).cwiseAbs().colwise().sum().eval();
      });
}

void AddTo(Eigen::MatrixXd& sum, const Eigen::MatrixXd& a) {
  ForRowBlocks(sum.rows(), [&](Eigen::Index first, Eigen::Index count) {
    sum.middleRows(first, count) += a.middleRows(first, count);
  });
}

void AddTo(Eigen::MatrixXd& sum, const Eigen::MatrixXd& a,
           const Eigen::RowVectorXd& factors) {
  ForRowBlocks(sum.rows(), [&](Eigen::Index first, Eigen::Index count) {
    sum.middleRows(first, count).noalias() +=
        a.middleRows(first, count) * factors.asDiagonal();
  });
}

void Scale(Eigen::MatrixXd& columns, const Eigen::RowVectorXd& factors) {
  ForRowBlocks(columns.rows(), [&](Eigen::Index first, Eigen::Index count) {
    columns.middleRows(first, count).array().rowwise() *= factors.array();
  });
}

}  // namespace elastimate
