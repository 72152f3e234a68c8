#ifndef ELASTIMATE_ESTIMATORS_MAPS_CURVATURE_MODES_H_
#define ELASTIMATE_ESTIMATORS_MAPS_CURVATURE_MODES_H_

#include <Eigen/Core>

#include "elastimate/core/solvers/conjugate_gradients.h"

namespace elastimate {

/// The leading part of a symmetric positive semidefinite H of which only
/// products are there,
///
///   H ~ U diag(lambda) U^T,
///
/// from its products with random orthonormal columns (Nystroem's approximation
/// [Frangella, Tropp & Udell, SIAM J. Matrix Anal. Appl. 44 (2023) 718]), and
/// the trace of what that leaves out.  What 1 / k + H asks for follows from it:
/// traces, a determinant, and a preconditioner by which conjugate gradients
/// need a few iterations.
class CurvatureModes {
 public:
  /// Without modes: H ~ 0.
  explicit CurvatureModes(Eigen::Index size)
      : basis_(size, 0), products_(size, 0), vectors_(size, 0), values_(0) {}

  /// Returns all modes of H = G G^T with n x r G.  O(n r^2).
  [[nodiscard]] static CurvatureModes OfRoot(const Eigen::MatrixXd& g);

  /// Enlarges the number of modes until the least lambda is below `least`, or
  /// there are all or as many as memory is for (1 GB).  `multiply` is H.  Costs
  /// a product for each mode, many columns at once, and O(n r^2) for r modes.
  void AddUntil(double least, const ColumnOperator& multiply);
  /// Takes another H from now on, with as many modes.  Costs as above.
  void Renew(const ColumnOperator& multiply);

  Eigen::Index Size() const { return vectors_.cols(); }
  const Eigen::MatrixXd& Vectors() const { return vectors_; }
  /// Descending.
  const Eigen::VectorXd& Values() const { return values_; }

  /// Returns ln det(I + k H), where the trace that the modes leave out counts
  /// as that of further modes of the least lambda.
  double LogDeterminant(double k) const;
  /// Returns tr(k H (I + k H)^-1), likewise.
  double EffectiveNumber(double k) const;
  /// Returns (I / k + H)^-1 B where H ~ 0 beside the modes; n x num_columns.
  Eigen::MatrixXd Solve(double k, const Eigen::MatrixXd& b) const;
  /// Returns (I / k + H)^-1 B by conjugate gradients with the above for a
  /// preconditioner; `multiply` is H.
  Eigen::MatrixXd SolveFor(double k, const ColumnOperator& multiply,
                           const Eigen::MatrixXd& b,
                           const ConjugateGradientOptions& options) const;

 private:
  void Decompose(const ColumnOperator& multiply);
  // Takes the modes of G G^T - shift.
  void TakeModesOf(const Eigen::MatrixXd& g, double shift);
  double LeastValue() const { return values_(Size() - 1); }
  /// How many modes of the least lambda have the trace that is left out.
  double NumLeft() const {
    return trace_left_ > 0 ? trace_left_ / LeastValue() : 0;
  }

  Eigen::MatrixXd basis_;     ///< Random orthonormal columns.
  Eigen::MatrixXd products_;  ///< H times these.
  Eigen::MatrixXd vectors_;
  Eigen::VectorXd values_;
  double trace_left_ = 0;
};

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_MAPS_CURVATURE_MODES_H_
