#ifndef ELASTIMATE_CORE_SOLVERS_BLOCK_MATRIX_H_
#define ELASTIMATE_CORE_SOLVERS_BLOCK_MATRIX_H_

#include <Eigen/Core>
#include <vector>

namespace elastimate {

/// A sparse matrix of dense blocks, compressed by rows of blocks.  Its entries
/// have single precision, which is enough for a preconditioner: products with
/// it take as long as its entries take to read.  With `rest` the entries have
/// 48 bits, nearly those of double precision.
struct BlockMatrix {
  int block_rows = 1;  ///< Rows of each block: 1, 2, 3 or 6.
  int block_columns = 1;
  Eigen::Index num_columns = 0;     ///< Columns of the matrix.
  std::vector<Eigen::Index> start;  ///< Rows of blocks + 1, from 0.
  std::vector<int> column;          ///< The column of blocks of each block.
  /// The entries of each block by columns, block after block.
  std::vector<float> entries;
  /// What rounding has taken from each entry; or empty.
  std::vector<float> rest;

  Eigen::Index NumBlockRows() const { return Eigen::Index(start.size()) - 1; }
  Eigen::Index NumRows() const { return block_rows * NumBlockRows(); }
};

/// Returns A X, rows x n, for X of num_columns x n.  The sums have double
/// precision.  OpenMP's threads share the rows of large matrices; the bits do
/// not depend on how many there are.  Precondition: blocks of 1 x 1, 2 x 2,
/// 2 x 3, 3 x 3, 3 x 6 or 6 x 6.
[[nodiscard]] Eigen::MatrixXd Multiply(const BlockMatrix& a,
                                       const Eigen::MatrixXd& x);

/// Returns (A + rest) X likewise.  Precondition: `rest` is not empty.
[[nodiscard]] Eigen::MatrixXd MultiplyAccurately(const BlockMatrix& a,
                                                 const Eigen::MatrixXd& x);

/// Returns the rows of blocks from `first` to before `end`, with all columns.
[[nodiscard]] BlockMatrix RowsOf(const BlockMatrix& a, Eigen::Index first,
                                 Eigen::Index end);

/// The places of the blocks of a matrix in the order of their columns, which
/// products with its transpose need.  They take a tenth of the memory of a
/// transpose with blocks of 3 x 6.
struct BlocksByColumn {
  std::vector<Eigen::Index> start;  ///< Columns of blocks + 1, from 0.
  std::vector<int> row;             ///< The row of blocks of each block.
  std::vector<int> block;           ///< The place of each block in the matrix.
};
[[nodiscard]] BlocksByColumn OrderByColumn(const BlockMatrix& a);

/// Returns A^T X, without `rest`, for X of as many rows as A has. Precondition:
/// blocks of 1 x 1, 2 x 3, 3 x 3, 3 x 6 or 6 x 6, as interpolations have.
[[nodiscard]] Eigen::MatrixXd MultiplyTransposed(
    const BlockMatrix& a, const BlocksByColumn& by_column,
    const Eigen::MatrixXd& x);

/// Returns the blocks on the diagonal of a matrix of square blocks, side by
/// side; zero where there is none.
[[nodiscard]] Eigen::MatrixXd DiagonalBlocks(const BlockMatrix& a);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_SOLVERS_BLOCK_MATRIX_H_
