#ifndef ELASTIMATE_ESTIMATORS_MAPS_CURVATURE_MODES_H_
#define ELASTIMATE_ESTIMATORS_MAPS_CURVATURE_MODES_H_

#include <Eigen/Core>
#include <optional>

#include "elastimate/core/solvers/conjugate_gradients.h"
#include "elastimate/estimators/maps/lanczos_sums.h"

namespace elastimate {

/// The leading part of a symmetric positive semidefinite H of which only
/// products are there,
///
///   H ~ U diag(lambda) U^T,
///
/// from its products with random orthonormal columns (Nystroem's approximation
/// [Frangella, Tropp & Udell, SIAM J. Matrix Anal. Appl. 44 (2023) 718]), and
/// LanczosSums of random vectors beside these modes.  Both together give the
/// traces and determinants of I / k + H, and the modes a preconditioner with
/// which conjugate gradients need a few iterations.
class CurvatureModes {
 public:
  /// Without modes: H ~ 0.
  explicit CurvatureModes(Eigen::Index size)
      : basis_(size, 0), products_(size, 0), vectors_(size, 0), values_(0) {}

  /// Returns all modes of H = G G^T with n x r G.  O(n r^2).
  [[nodiscard]] static CurvatureModes OfRoot(const Eigen::MatrixXd& g);

  /// Enlarges the number of modes until the least lambda is below `least`, or
  /// there are all or as many as memory is for (0.8 GB).  `multiply` is H.
  /// Costs a product for each mode and 160 to 640 for what is beside them, many
  /// columns at once, and O(n r^2) for r modes.
  void AddUntil(double least, const ColumnOperator& multiply);
  /// Takes another H from now on, with as many modes.  Costs as above.
  void Renew(const ColumnOperator& multiply);

  Eigen::Index Size() const { return vectors_.cols(); }
  /// Returns the modes that are accurate: all where H has no others, else the
  /// larger half.  Functions of H are summed over these, and by LanczosSums
  /// over the rest.  All modes together are the preconditioner.
  auto Vectors() const { return vectors_.leftCols(num_accurate_); }
  /// Descending.
  auto Values() const { return values_.head(num_accurate_); }
  /// Whether nothing is beside the accurate modes.
  bool HasAll() const { return !rest_; }

  /// Returns the LanczosSums of the components of the vectors that are
  /// orthogonal to the accurate modes.  Costs 20 products of n columns.
  LanczosSums BesideModes(const ColumnOperator& multiply,
                          const Eigen::MatrixXd& vectors) const;
  /// Returns ln det(I + k H).  The part beside the accurate modes is a mean
  /// over n = 8 to 32 random vectors, with a standard deviation of about
  /// (2 sum f^2 / n)^(1/2) for the values f that are added.
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
  void Decompose();
  // Tells whether there are no more modes: the last ones were rounding, or the
  // basis is the whole space.
  bool HasWholeSpan() const {
    return basis_.cols() == basis_.rows() || Size() < basis_.cols();
  }
  void MeasureRest(const ColumnOperator& multiply);
  Eigen::MatrixXd WithoutModes(const Eigen::MatrixXd& columns) const;
  // Takes the modes of G G^T - shift.
  void TakeModesOf(const Eigen::MatrixXd& g, double shift);
  // Returns the sum of f over the eigenvalues beside the modes.
  template <class Function>
  double SumOverRest(const Function& f) const {
    double sum = 0;
    for (Eigen::Index i = 0; rest_ && i < rest_->NumVectors(); ++i) {
      sum += rest_->Of(i, f) / double(rest_->NumVectors());
    }
    return sum;
  }

  Eigen::MatrixXd basis_;     ///< Random orthonormal columns.
  Eigen::MatrixXd products_;  ///< H times these.
  Eigen::MatrixXd vectors_;
  Eigen::VectorXd values_;
  Eigen::Index num_accurate_ = 0;
  std::optional<LanczosSums> rest_;  ///< None where there are no others.
};

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_MAPS_CURVATURE_MODES_H_
