#include "elastimate/core/algebra/row_block_qr.h"

#include "elastimate/core/algebra/dense_algebra.h"

namespace elastimate {
namespace {

constexpr Eigen::Index kBlockRows = 512;

}  // namespace

RowBlockQr::RowBlockQr(Eigen::Index num_columns)
    : block_(Eigen::MatrixXd::Zero(num_columns + kBlockRows, num_columns)),
      num_rows_(num_columns) {}

void RowBlockQr::Factorize() {
  const Eigen::Index num_columns = block_.cols();
  block_.topRows(num_columns) = TriangularFactor(block_.topRows(num_rows_));
  num_rows_ = num_columns;
}

Eigen::MatrixXd RowBlockQr::Triangle() {
  Factorize();
  return block_.topRows(block_.cols());
}

}  // namespace elastimate
