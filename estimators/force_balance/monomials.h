#ifndef ELASTIMATE_ESTIMATORS_FORCE_BALANCE_MONOMIALS_H_
#define ELASTIMATE_ESTIMATORS_FORCE_BALANCE_MONOMIALS_H_

#include <Eigen/Core>

namespace elastimate {

/// How many monomials of degree <= `degree` two or three variables have.
constexpr Eigen::Index NumMonomials(Eigen::Index dimension, int degree) {
  const Eigen::Index in_plane = (degree + 1) * (degree + 2) / 2;
  return dimension == 2 ? in_plane : in_plane * (degree + 3) / 3;
}

/// The monomials of degree <= `degree` at some points (dimension x num_points),
/// in coordinates of zero mean and unit covariance: they span the polynomials
/// of that degree, and are well conditioned for slender specimens too.  Points
/// in a plane or on a line leave some of them zero. num_points x NumMonomials.
Eigen::MatrixXd Monomials(const Eigen::MatrixXd& points, int degree);

/// A monomial of which no more than this share is independent of the others is
/// so by rounding only: few points, or points in a plane, make some dependent.
inline constexpr double kDependentMonomial = 1e-10;

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_FORCE_BALANCE_MONOMIALS_H_
