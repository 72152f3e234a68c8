#ifndef ELASTIMATE_ESTIMATORS_REDUCED_MODEL_KRYLOV_BOUND_H_
#define ELASTIMATE_ESTIMATORS_REDUCED_MODEL_KRYLOV_BOUND_H_

#include <Eigen/Core>

#include "elastimate/core/mesh/mesh.h"

namespace elastimate {

/// (A(nu) x, x) >= SmallestEnergyRatio(nu, pole) (A(pole) x, x) for every x: of
/// A(nu) = H + nu J, the ratio of (J x, x) to (H x, x) lies between those of
/// strains without and with nothing but a change of volume, -2 and 1, in plane
/// strain -2 and 0, in plane stress -1 and 1.
double SmallestEnergyRatio(double poisson_ratio, double pole,
                           SectionModel model);

/// An upper bound, for every nu, of the error of the solution that the Krylov
/// space of one right-hand side holds.
///
/// At a pole p, a response with A(nu) x(nu) = g0 + nu g1, A(nu) = H + nu J, is
///
///   x(nu) = x(p) + (nu - p) d(nu),   A(nu) d(nu) = g1 - J x(p),
///
/// and d is sought in the span of v_1 ... v_m, orthonormal in the energy of p,
/// which Lanczos' method makes of A_p^-1 (g1 - J x(p)) and A_p^-1 J:
///
///   A_p^-1 J V = V T + beta v_{m+1} e_m^T,   (I + (nu - p) T) y = beta_0 e_1.
///
/// The residual of d = V y is then (nu - p) beta y_m A_p v_{m+1} for every nu,
/// and what its energy amounts to at nu is bounded by the Gauss-Radau rule with
/// the node SmallestEnergyRatio(nu, p) [Golub & Meurant 2010, section 12.2]:
/// the sharpest bound that the numbers T, beta and beta_0 allow.
///
/// Errors of the solves themselves (of an iterative solver, or of rounding)
/// leave further residuals, of which the energies are added.
class KrylovBound {
 public:
  /// Before the first vector of V.  `start_norm` is beta_0; `start_error`
  /// bounds the errors of x(p) and `direction_error` that of A_p^-1 (g1 - J
  /// x(p)), in the energy norm of the pole, as all norms here.
  KrylovBound(SectionModel model, double pole, double start_norm,
              double start_error, double direction_error);

  /// Another vector of V: the last column of T (without beta), an upper bound
  /// of the error of A_p^-1 J v_m, and beta, zero where the space is invariant.
  void Extend(const Eigen::VectorXd& column, double solve_error,
              double remainder_norm);

  /// Bounds the error of x(p) + (nu - p) V y in the energy norm of A(nu).
  /// O(m^2) for m vectors.
  double At(double poisson_ratio) const;

 private:
  SectionModel section_model_;
  double pole_;
  double start_norm_;
  double start_error_;
  double direction_error_;
  double remainder_norm_;
  Eigen::VectorXd solve_errors_;
  Eigen::MatrixXd t_;
  /// Eigenvalues and eigenvectors of T.
  Eigen::VectorXd theta_;
  Eigen::MatrixXd modes_;
};

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_REDUCED_MODEL_KRYLOV_BOUND_H_
