#ifndef ELASTIMATE_ESTIMATORS_DISPLACEMENT_FIT_CORRECTED_FIT_H_
#define ELASTIMATE_ESTIMATORS_DISPLACEMENT_FIT_CORRECTED_FIT_H_

#include <Eigen/Core>
#include <optional>

#include "elastimate/core/materials/elasticity.h"
#include "elastimate/core/scene/scene.h"
#include "elastimate/estimators/displacement_fit/displacement_fit.h"
#include "elastimate/estimators/interface/estimate.h"
#include "elastimate/estimators/interface/estimator.h"
#include "elastimate/estimators/interface/evidence.h"
#include "elastimate/estimators/statistics/profile_likelihood.h"

namespace elastimate {

/// A fit of physical parameters to the displacements, and what follows from it
/// but for the profile likelihood.
struct DescribedFit {
  Estimate estimate;
  Evidence evidence;
  FitStatistics statistics;
  std::optional<Eigen::VectorXd> element_change;
  /// du / d (ln E, nu).
  Eigen::Matrix<double, Eigen::Dynamic, 2> sensitivities;
  /// As of DisplacementFit.
  Eigen::VectorXd taken;
};

/// A fit of E alone at some nu, and what finer elements change there.
struct FitAtRatio {
  IsotropicElasticity elasticity;
  Eigen::VectorXd residual;  ///< u - q.
  /// du / d (ln E, nu).
  Eigen::Matrix<double, Eigen::Dynamic, 2> sensitivities;
  Eigen::VectorXd element_change;
};

/// A method that can fit its measurement without some rows of it, in the rows
/// of ObservedDisplacements; empty where nothing is taken.
class CorrectableFit {
 public:
  virtual ~CorrectableFit() = default;

  /// Whether there is a fit of physical parameters: the best of all, or the one
  /// that is reached from some parameters.
  virtual bool Fit(const Eigen::VectorXd& taken) = 0;
  virtual bool FitNear(const IsotropicElasticity& start,
                       const Eigen::VectorXd& taken) = 0;

  // Of the last of these, which succeeded.

  virtual DescribedFit Describe() = 0;
  /// The outermost fits, as far as they are known, whose square sum exceeds the
  /// least by no more than `excess`.
  virtual Profile RangeWithin(double excess) = 0;

  /// To the whole measurement at this nu; empty where there is none, or the
  /// change is not known.
  virtual std::optional<FitAtRatio> FitAt(double poisson_ratio) = 0;
};

struct CorrectedFit {
  DescribedFit fit;
  /// What the square sum at another nu is uncertain by, since what was taken
  /// from the measurement is what finer elements change at one.
  double doubt = 0;
  /// The outermost fits to a measurement that was corrected as at another nu,
  /// within the 95 % of chi^2 of this fit; empty where there are none.
  std::optional<Profile> rival;

  /// What the square sum of a profile may exceed its least by.
  double ExcessOf(double quantile) const {
    return quantile * fit.statistics.row_variance.value_or(0) + doubt;
  }
  /// Of the profile likelihood of the fit, with those of the rival.
  Profile WithRival(const Profile& profile) const;
};

/// Of a measurement without some rows of it, which are empty where nothing is
/// taken.
Eigen::VectorXd WhatIsLeft(const Eigen::VectorXd& measured,
                           const Eigen::VectorXd& taken);

/// The fit to a measurement without what finer elements explain of it, from the
/// fit to the measurement as it is, which was the last.
///
/// That change e moves the parameters along a line as far as the model is
/// linear.  Therefore alpha e, with alpha as ElementErrors has it, is taken
/// from the measurement, and the parameters are fitted again, until e and alpha
/// ask for no others.  Since e depends on nu, errors of such a fit are as much
/// larger as e takes up what nu changes: with c the parameters that take up e,
/// by (I + alpha (0, dc / dnu))^-1, for which linear elements find e at a
/// second nu.  Where nu is known so little that e may decide between minima,
/// the same begins from a measurement without the e of another nu, as much of
/// it as explains the measurement best; the fit that leaves the smaller
/// residual is the one, the other its rival, with any that leaves as little but
/// for chance.  Of linear elements that is so under much noise only: what shows
/// of e at one nu may be as much as it is, and nothing at another.  Linear
/// elements of which all of e would be too much
/// are too coarse where some u + e of this or of a usual nu, in the linear
/// model of (ln E, nu), leaves no more of the measurement than they do.
///
/// Elements that are too coarse for a correction are left as they are.  The
/// last fit of `fit` is the one that is returned; the residuals of the estimate
/// are those of the measurement as it is.
CorrectedFit FitCorrected(const Scene& scene, const EstimatorOptions& options,
                          CorrectableFit& fit);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_DISPLACEMENT_FIT_CORRECTED_FIT_H_
