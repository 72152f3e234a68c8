#ifndef ELASTIMATE_ESTIMATORS_MAPS_LANCZOS_SUMS_H_
#define ELASTIMATE_ESTIMATORS_MAPS_LANCZOS_SUMS_H_

#include <Eigen/Core>

#include "elastimate/core/solvers/conjugate_gradients.h"

namespace elastimate {

/// The quadratic forms v^T f(H) v of some vectors v and a symmetric positive
/// semidefinite H of which only products with vectors can be computed, for any
/// smooth f.  Lanczos' method gives the nodes and weights of a Gauss
/// quadrature,
///
///   v^T f(H) v ~ sum_i w_i f(theta_i)
///
/// [Golub & Meurant, Matrices, Moments and Quadrature, 2010, section 7].  Its
/// mean over random v with independent components of unit variance is the trace
/// of f(H).
class LanczosSums {
 public:
  /// Takes a column of `vectors` (size x n) for each v.  Costs at most `steps`
  /// products of n columns each.
  LanczosSums(const ColumnOperator& multiply, const Eigen::MatrixXd& vectors,
              int steps);

  /// Returns v^T f(H) v of the vector in this column, for an f that is finite
  /// from 0 on.
  template <class Function>
  double Of(Eigen::Index column, const Function& f) const {
    return weights_.col(column).dot(nodes_.col(column).unaryExpr(f));
  }
  Eigen::Index NumVectors() const { return nodes_.cols(); }

 private:
  Eigen::MatrixXd nodes_;    ///< theta: steps x n, none of them negative.
  Eigen::MatrixXd weights_;  ///< w: steps x n.
};

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_MAPS_LANCZOS_SUMS_H_
