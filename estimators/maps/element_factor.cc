#include "elastimate/estimators/maps/element_factor.h"

#include <cstdint>
#include <new>
#include <vector>

#include "elastimate/core/solvers/nested_dissection.h"

namespace elastimate {

ElementFactor::ElementFactor(const Eigen::SparseMatrix<double>& matrix) {
  const Eigen::SparseMatrix<double> lower =
      matrix.triangularView<Eigen::Lower>();
  const std::vector<std::int64_t> order = NestedDissection(
      {lower.outerIndexPtr(), lower.outerIndexPtr() + lower.cols() + 1},
      {lower.innerIndexPtr(), lower.innerIndexPtr() + lower.nonZeros()});
  order_.resize(matrix.rows());
  for (std::size_t i = 0; i < order.size(); ++i) {
    order_.indices()(order[i]) = static_cast<int>(i);
  }
  inverse_.cholmod().nmethods = 1;
  inverse_.cholmod().method[0].ordering = CHOLMOD_NATURAL;
  inverse_.cholmod().postorder = 1;
  Eigen::SparseMatrix<double> permuted;
  permuted = matrix.twistedBy(order_);
  inverse_.compute(permuted);
  CheckFactor();
}

void ElementFactor::Factorize(const Eigen::SparseMatrix<double>& matrix) {
  Eigen::SparseMatrix<double> permuted;
  permuted = matrix.twistedBy(order_);
  inverse_.factorize(permuted);
  CheckFactor();
}

void ElementFactor::CheckFactor() const {
  // The matrices are positive definite, so that only memory can be missing.
  if (inverse_.info() != Eigen::Success) {
    throw std::bad_alloc();
  }
}

Eigen::MatrixXd ElementFactor::Solve(const Eigen::MatrixXd& b) const {
  // CHOLMOD prints an error where there are no columns.
  return b.cols() == 0
             ? b
             : order_.transpose() * Eigen::MatrixXd(inverse_.solve(order_ * b));
}

}  // namespace elastimate
