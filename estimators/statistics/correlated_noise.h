#ifndef ELASTIMATE_ESTIMATORS_STATISTICS_CORRELATED_NOISE_H_
#define ELASTIMATE_ESTIMATORS_STATISTICS_CORRELATED_NOISE_H_

#include <Eigen/Core>

#include "elastimate/core/scene/observed_displacements.h"
#include "elastimate/core/scene/scene.h"

namespace elastimate {

/// How the residuals of one component at points of one load case are alike:
/// rho(d) = E[e_i e_j] / E[e_i^2] for points at a distance of d.
struct Autocorrelation {
  double step = 0;  ///< [length]
  /// At distances in [k step, (k + 1) step); the first is that of neighbours.
  /// Ends where it is no longer significant; empty for independent residuals.
  Eigen::VectorXd values;

  /// Beyond the last step, 0.
  double At(double distance) const {
    const double k = distance / step;
    return k < static_cast<double>(values.size()) ? values(Eigen::Index(k)) : 0;
  }
  /// The integral of rho, 0 for independent residuals [length].
  double Length() const { return step * values.sum(); }
};

/// Of the rows of `residual`, in steps of the median distance of a point to its
/// nearest neighbour, up to where it first is less than three of its standard
/// deviations for independent residuals.  `scene` is that of `observed`.
/// O(n^2) for up to 20 000 points in a load case, of which there are no more:
/// of others, every second, third and so on is looked at.
Autocorrelation CorrelateResiduals(const Scene& scene,
                                   const ObservedDisplacements& observed,
                                   const Eigen::VectorXd& residual);

/// By how much the covariance of least squares is more than that of independent
/// noise of variance 1, (S^T S)^-1, when rows are correlated like this,
///
///   (S^T S)^-1 (sum over rows i != j of rho(|x_i - x_j|) s_i s_j^T)
///   (S^T S)^-1,
///
/// where S are the sensitivities of the rows of `observed` [White 1980;
/// Conley 1999, with rho of all pairs in place of each product of residuals].
/// It may have negative eigenvalues.  O(n^2), as CorrelateResiduals.
Eigen::MatrixXd CovarianceOfCorrelation(const Scene& scene,
                                        const ObservedDisplacements& observed,
                                        const Eigen::MatrixXd& sensitivities,
                                        const Eigen::MatrixXd& inverse,
                                        const Autocorrelation& correlation);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_STATISTICS_CORRELATED_NOISE_H_
