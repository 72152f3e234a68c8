#ifndef ELASTIMATE_ESTIMATORS_DISPLACEMENT_FIT_DISPLACEMENT_MINIMUM_H_
#define ELASTIMATE_ESTIMATORS_DISPLACEMENT_FIT_DISPLACEMENT_MINIMUM_H_

#include <ceres/evaluation_callback.h>
#include <ceres/solver.h>

#include <Eigen/Core>

#include "elastimate/core/materials/elasticity.h"
#include "elastimate/estimators/displacement_fit/displacement_fit.h"
#include "elastimate/estimators/interface/estimator.h"
#include "elastimate/estimators/misfit/observed_model.h"
#include "elastimate/estimators/statistics/bounded_parameter.h"
#include "elastimate/estimators/statistics/node_losses.h"

namespace elastimate {

/// What the first parameter of the fit is; the second is nu.
enum class Scale {
  /// ln of the norm of t w at the observed components.  Its valley in (scale,
  /// nu) is straight where that of (ln E, nu) is curved, and the derivatives
  /// with respect to the two are orthogonal without held displacements.
  kLogResponseNorm,
  /// ln E, for fits with E on a bound.
  kLogYoungsModulus,
};

/// The residual of the displacements at the parameters that Ceres asks for.
class DisplacementResidual : public ceres::EvaluationCallback {
 public:
  /// `model` must outlive this object.
  explicit DisplacementResidual(ObservedModel& model) : model_(model) {}

  /// The parameters that evaluations are asked for at.
  void SetParameters(Scale scale, const BoundedParameter* scale_parameter,
                     const BoundedParameter* poisson_ratio);

  void PrepareForEvaluation(bool evaluate_jacobians,
                            bool new_evaluation_point) override;

  /// At the parameters.  Precondition: the model is at their nu.
  IsotropicElasticity Elasticity() const;

  bool IsValid() const { return is_valid_; }
  ObservedModel& Model() { return model_; }
  const ObservedModel& Model() const { return model_; }
  /// At the last evaluation, with derivatives by (ln E, nu).
  const DisplacementFit& Fit() const { return fit_; }
  /// Derivatives of the residual by the two parameters of the fit.
  const Eigen::Matrix<double, Eigen::Dynamic, 2>& Jacobian() const {
    return jacobian_;
  }

 private:
  /// d ln E / d nu at fixed scale.
  double SlopeAtFixedScale() const;

  ObservedModel& model_;
  Scale scale_ = Scale::kLogResponseNorm;
  const BoundedParameter* scale_parameter_ = nullptr;
  const BoundedParameter* poisson_ratio_ = nullptr;
  bool is_valid_ = false;
  DisplacementFit fit_;
  Eigen::Matrix<double, Eigen::Dynamic, 2> jacobian_;
};

/// A minimum of the cost.
struct Minimum {
  BoundedParameter scale;
  BoundedParameter poisson_ratio;
  Scale meaning;
  Side violated;
  NodeLosses losses;
  ceres::Solver::Summary summary;
  double cost;
};

/// The minimum within the bounds on E that is reached from a start: where the
/// one with a free E lies beyond a bound, that on the bound.
Minimum Descend(const EstimatorOptions& options,
                const IsotropicElasticity& start,
                DisplacementResidual& residual);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_DISPLACEMENT_FIT_DISPLACEMENT_MINIMUM_H_
