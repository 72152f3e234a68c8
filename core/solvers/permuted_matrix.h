#ifndef ELASTIMATE_CORE_SOLVERS_PERMUTED_MATRIX_H_
#define ELASTIMATE_CORE_SOLVERS_PERMUTED_MATRIX_H_

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "elastimate/core/mechanics/stiffness_assembly.h"

namespace elastimate {

/// The lower triangle of P A P^T for symmetric matrices A of one pattern.  Row
/// i of it is row order[i] of A.
class PermutedMatrix {
 public:
  PermutedMatrix() = default;
  /// `order` has a.Size() numbers.  O(number of values).
  PermutedMatrix(const SymmetricPattern& a, const std::int64_t* order);

  /// The rows of a column are in no order.
  const SymmetricPattern& Pattern() const { return pattern_; }
  /// Permutes the values of A, from the order of its pattern into that of
  /// Pattern().  They are valid until the next call.
  const Eigen::VectorXd& ValuesFrom(const Eigen::VectorXd& values);

 private:
  SymmetricPattern pattern_;
  std::vector<std::int64_t> source_;  ///< The place of each value in A.
  Eigen::VectorXd values_;
};

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_SOLVERS_PERMUTED_MATRIX_H_
