#ifndef ELASTIMATE_ESTIMATORS_MAPS_ELEMENT_FACTOR_H_
#define ELASTIMATE_ESTIMATORS_MAPS_ELEMENT_FACTOR_H_

#include <Eigen/CholmodSupport>
#include <Eigen/Core>
#include <Eigen/SparseCore>

namespace elastimate {

/// The Cholesky factors of positive definite matrices that couple each element
/// with its neighbours, by CHOLMOD in the order of nested dissection.  Throws
/// std::bad_alloc where memory is missing.
class ElementFactor {
 public:
  /// Orders and analyses the pattern of a matrix, and factorises it.
  explicit ElementFactor(const Eigen::SparseMatrix<double>& matrix);

  /// Factorises another matrix of the same pattern.
  void Factorize(const Eigen::SparseMatrix<double>& matrix);

  /// Returns the solution for each column of B; num_elements x n.
  Eigen::MatrixXd Solve(const Eigen::MatrixXd& b) const;

 private:
  void CheckFactor() const;

  Eigen::PermutationMatrix<Eigen::Dynamic> order_;  ///< From rows to places.
  Eigen::CholmodSupernodalLLT<Eigen::SparseMatrix<double>> inverse_;
};

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_MAPS_ELEMENT_FACTOR_H_
