#ifndef ELASTIMATE_CORE_MECHANICS_MEAN_DILATATION_H_
#define ELASTIMATE_CORE_MECHANICS_MEAN_DILATATION_H_

#include <Eigen/Core>
#include <vector>

namespace elastimate {

/// The mean dilatation of an element (LargeStrainForces): Fbar = s F with
/// s = (Theta / J)^(1/3) at its points.
///
/// With the stress Pbar of a law at Fbar, an energy W(Fbar) has
///
///   dW = (s Pbar - pi / 3 F^-T) : dF + pi / (3 Theta) dTheta,
///   pi = s Pbar : F,
///
/// and dTheta is the mean of cof F : dF, so that the pressure
/// p = mean of pi / (3 Theta) acts on cof F at each point.
class MeanDilatation {
 public:
  /// Takes the gradients H = F - I at the points, and their volumes.
  MeanDilatation(const std::vector<Eigen::Matrix3d>& gradients,
                 const Eigen::VectorXd& volumes);

  /// Returns Fbar - I at each point.
  const std::vector<Eigen::Matrix3d>& Gradients() const { return gradients_; }

  /// Returns the stress that does the work on dF, for Pbar at each point.
  std::vector<Eigen::Matrix3d> Stresses(
      const std::vector<Eigen::Matrix3d>& stresses) const;

  /// The second derivative of the energy of the element,
  ///
  ///   sum over the points of v (dF : local : dF + 2 coupling : dF dTheta)
  ///   + dilatation dTheta^2,   dTheta = sum of v cof F : dF / V.
  struct Curvature {
    std::vector<Eigen::Matrix<double, 9, 9>> local;
    std::vector<Eigen::Matrix3d> coupling;
    double dilatation = 0;
  };
  /// Returns it for Pbar and dPbar / dFbar at each point.
  Curvature CurvatureOf(
      const std::vector<Eigen::Matrix3d>& stresses,
      const std::vector<Eigen::Matrix<double, 9, 9>>& tangents) const;

  /// Returns cof F / V at each point, the derivative of Theta over v.
  Eigen::Matrix3d DilatationSlope(std::size_t point) const {
    return cofactors_[point] / total_volume_;
  }

 private:
  double Work(std::size_t point, const Eigen::Matrix3d& stress) const;
  double Pressure(const std::vector<Eigen::Matrix3d>& stresses) const;

  Eigen::VectorXd volumes_;
  double total_volume_;
  double theta_;                            ///< The mean of J.
  std::vector<double> jacobian_;            ///< J.
  std::vector<double> scale_;               ///< s.
  std::vector<Eigen::Matrix3d> f_;          ///< F.
  std::vector<Eigen::Matrix3d> cofactors_;  ///< cof F.
  std::vector<Eigen::Matrix3d> gradients_;
};

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_MECHANICS_MEAN_DILATATION_H_
