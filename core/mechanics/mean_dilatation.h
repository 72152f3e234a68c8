#ifndef ELASTIMATE_CORE_MECHANICS_MEAN_DILATATION_H_
#define ELASTIMATE_CORE_MECHANICS_MEAN_DILATATION_H_

#include <Eigen/Core>
#include <vector>

namespace elastimate {

/// The smoothed dilatation of an element (LargeStrainForces): Fbar = s F with s
/// = (Theta / J)^(1/3) at its points.  Theta is the least-squares fit of J by
/// some polynomials over the element; the fit by the constant 1 alone is the
/// mean of J.
///
/// With the stress Pbar of a law at Fbar, an energy W(Fbar) has
///
///   dW = (s Pbar - pi / 3 F^-T) : dF + pi / (3 Theta) dTheta,
///   pi = s Pbar : F,
///
/// and dTheta is the fit of cof F : dF, so that the pressure p, the fit of
/// pi / (3 Theta), acts on cof F at each point.
class MeanDilatation {
 public:
  /// Takes the gradients H = F - I at the points, their volumes v, and the
  /// values of the polynomials there, num_points x num_polynomials.
  MeanDilatation(const std::vector<Eigen::Matrix3d>& gradients,
                 const Eigen::VectorXd& volumes,
                 const Eigen::MatrixXd& polynomials);

  /// Returns Fbar - I at each point.
  const std::vector<Eigen::Matrix3d>& Gradients() const { return gradients_; }

  /// Returns, for the stresses Pbar of the law at each point, the stresses that
  /// do work on dF.
  std::vector<Eigen::Matrix3d> Stresses(
      const std::vector<Eigen::Matrix3d>& stresses) const;

  /// The second derivative of the energy of the element, the sum over the
  /// points of
  ///
  ///   v (dF : local : dF + 2 coupling : dF dTheta + dilatation dTheta^2).
  struct Curvature {
    std::vector<Eigen::Matrix<double, 9, 9>> local;
    std::vector<Eigen::Matrix3d> coupling;
    Eigen::VectorXd dilatation;
  };
  /// Returns this second derivative, for Pbar and dPbar / dFbar at each point.
  Curvature CurvatureOf(
      const std::vector<Eigen::Matrix3d>& stresses,
      const std::vector<Eigen::Matrix<double, 9, 9>>& tangents) const;

  /// Returns orthonormal polynomials phi_a at the points, num_points x
  /// num_polynomials, with which dTheta = sum_a phi_a dTheta_a, and dTheta_a is
  /// the sum of v phi_a cof F : dF over the points.
  const Eigen::MatrixXd& Polynomials() const { return polynomials_; }
  /// Returns cof F.
  const Eigen::Matrix3d& Cofactors(std::size_t point) const {
    return cofactors_[point];
  }

 private:
  double Work(std::size_t point, const Eigen::Matrix3d& stress) const;
  /// Returns the fit of these values at the points.
  Eigen::VectorXd Fit(const Eigen::VectorXd& values) const;
  /// Returns p at each point.
  Eigen::VectorXd Pressures(const std::vector<Eigen::Matrix3d>& stresses) const;

  Eigen::VectorXd volumes_;
  Eigen::MatrixXd polynomials_;
  Eigen::VectorXd theta_;                   ///< Theta.
  std::vector<double> jacobian_;            ///< J.
  std::vector<double> scale_;               ///< s.
  std::vector<Eigen::Matrix3d> f_;          ///< F.
  std::vector<Eigen::Matrix3d> cofactors_;  ///< cof F.
  std::vector<Eigen::Matrix3d> gradients_;
};

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_MECHANICS_MEAN_DILATATION_H_
