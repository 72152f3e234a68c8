#ifndef ELASTIMATE_ESTIMATORS_DISPLACEMENT_FIT_DISPLACEMENT_PROFILE_H_
#define ELASTIMATE_ESTIMATORS_DISPLACEMENT_FIT_DISPLACEMENT_PROFILE_H_

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "elastimate/core/materials/elasticity.h"
#include "elastimate/estimators/interface/estimator.h"
#include "elastimate/estimators/misfit/observed_model.h"

namespace elastimate {

/// The best fit at one nu.
struct ProfilePoint {
  IsotropicElasticity elasticity;
  /// The sum of squares; with a loss that of absolute deviations, so that
  /// outliers do not choose the start.
  double cost;
  /// Its derivative by nu.
  double slope = 0;
  /// Without bounds on E.
  IsotropicElasticity unbounded = elasticity;
  double unbounded_cost = cost;
};

/// That of ProfilePoint::cost.
double CostOf(Loss loss, const Eigen::VectorXd& residual);

/// At the nu of the model, with the best E within its bounds.
ProfilePoint EvaluateProfile(const EstimatorOptions& options,
                             ObservedModel& model, double nu);
/// The same of least squares of rows that are multiplied by these numbers.
ProfilePoint EvaluateWeightedProfile(const EstimatorOptions& options,
                                     const Eigen::VectorXd& row_weights,
                                     ObservedModel& model, double nu);

/// The profile likelihood without bounds on E, as far as it has been evaluated:
/// the starts, and the fit itself as the best.
class EvaluatedProfile {
 public:
  EvaluatedProfile(std::vector<ProfilePoint> points, const ProfilePoint& best)
      : points_(std::move(points)), best_(best) {}

  void Add(const ProfilePoint& point) { points_.push_back(point); }

  /// The outermost fit where, towards `limit`, the cost exceeds the least by
  /// `excess`: between two points the root of what it exceeds by is taken as
  /// linear, and so is E.  At the limit where the last point does not exceed
  /// it.
  IsotropicElasticity EndTowards(double limit, double excess) const;

 private:
  std::vector<ProfilePoint> points_;
  ProfilePoint best_;
};

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_DISPLACEMENT_FIT_DISPLACEMENT_PROFILE_H_
