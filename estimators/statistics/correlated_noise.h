#ifndef ELASTIMATE_ESTIMATORS_STATISTICS_CORRELATED_NOISE_H_
#define ELASTIMATE_ESTIMATORS_STATISTICS_CORRELATED_NOISE_H_

#include <Eigen/Core>
#include <algorithm>

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
  /// rho just beyond a distance of zero, where residuals that are alike are the
  /// same: the share of these, beside what is independent at each point.
  double share = 1;
  /// The integral of exp(-d^2 / 2 X^2), what was smoothed, which falls no
  /// faster than the first two steps do [length]; infinite where noise hides
  /// that they fall.
  double smoothed_length = 0;

  /// Beyond the last step, 0.
  double At(double distance) const {
    const double k = distance / step;
    return k < static_cast<double>(values.size()) ? values(Eigen::Index(k)) : 0;
  }
  /// The integral of rho, 0 for independent residuals [length].
  double Length() const { return step * values.sum(); }
  /// The length over which those are alike that are, as long as it may be.
  double LengthOfAlike() const {
    return std::max(Length() / share, smoothed_length);
  }
};

/// Correlates the rows of `residual`, in steps of the median distance of a
/// point to its nearest neighbour, up to where the correlation is first less
/// than three of its standard deviations for independent residuals.  The share
/// of those that are alike, and the length over which they were smoothed, come
/// from ln rho of the first two steps, which is linear in d^2 where noise was
/// smoothed, the second as large as it may be.  `scene` is that of `observed`.
/// Takes the pairs along the longest axis that are as near as residuals are
/// alike, for up to 20 000 points in a load case; of more points, every second,
/// third and so on is looked at.
Autocorrelation CorrelateResiduals(const Scene& scene,
                                   const ObservedDisplacements& observed,
                                   const Eigen::VectorXd& residual);

/// What noise that is correlated like this adds to the Gram matrix of its
/// sensitivities S, the rows of `observed`, in the covariance of least squares
/// over the variance of a row, (S^T S)^-1 (S^T S + G) (S^T S)^-1:
///
///   G = sum over rows i != j of rho(|x_i - x_j|) s_i s_j^T
///
/// [White 1980; Conley 1999, with rho of all pairs in place of each product of
/// residuals].  It may have negative eigenvalues.  Takes the pairs that
/// CorrelateResiduals takes.
Eigen::MatrixXd GramOfCorrelation(const Scene& scene,
                                  const ObservedDisplacements& observed,
                                  const Eigen::MatrixXd& sensitivities,
                                  const Autocorrelation& correlation);

/// What the correlation of residuals says of where they come from.
struct CorrelatedResiduals {
  double length;  ///< Autocorrelation::Length().
  /// How far a model that is wrong is their cause, rather than noise: by
  /// (8 LengthOfAlike() / size of the mesh)^4, wholly from an eighth on.
  double share_of_model;
  /// GramOfCorrelation without directions of negative eigenvalues: noise whose
  /// neighbours differ by more than chance is taken for independent.
  Eigen::MatrixXd gram;
};

CorrelatedResiduals DescribeCorrelation(const Scene& scene,
                                        const ObservedDisplacements& observed,
                                        const Eigen::VectorXd& residual,
                                        const Eigen::MatrixXd& sensitivities);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_STATISTICS_CORRELATED_NOISE_H_
