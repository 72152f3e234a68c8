#ifndef ELASTIMATE_CORE_ALGEBRA_ROW_BLOCK_QR_H_
#define ELASTIMATE_CORE_ALGEBRA_ROW_BLOCK_QR_H_

#include <Eigen/Core>

namespace elastimate {

/// The triangle R of the QR factorisation of a matrix that is given row by row
/// and is too long to be kept: R^T R is its Gram matrix.  Rows are factorised
/// in blocks that stay in the cache.
///
///   RowBlockQr qr(3);
///   for (...) qr.NextRow() << f(i), b(i), a(i);
///   const Eigen::MatrixXd triangle = qr.Triangle();
class RowBlockQr {
 public:
  /// O(num_columns^2) for each row.
  explicit RowBlockQr(Eigen::Index num_columns);

  /// Returns the next row, which has to be filled in before another call.
  Eigen::MatrixXd::RowXpr NextRow() {
    if (num_rows_ == block_.rows()) {
      Factorize();
    }
    return block_.row(num_rows_++);
  }

  /// Returns R of all rows so far, num_columns x num_columns.  Its lower rows
  /// are zero where there were fewer rows than columns.
  Eigen::MatrixXd Triangle();

 private:
  void Factorize();

  /// The triangle of the rows before stands on top, and further rows below it.
  Eigen::MatrixXd block_;
  Eigen::Index num_rows_;
};

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_ALGEBRA_ROW_BLOCK_QR_H_
