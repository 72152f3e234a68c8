#ifndef ELASTIMATE_ESTIMATORS_ELEMENT_ORDER_H_
#define ELASTIMATE_ESTIMATORS_ELEMENT_ORDER_H_

#include "elastimate/core/materials/elasticity.h"
#include "elastimate/core/scene/scene.h"
#include "elastimate/estimators/interface/estimate.h"
#include "elastimate/estimators/interface/estimator.h"

namespace elastimate {

/// What the residuals of fits of one isotropic material with linear and with
/// quadratic elements say of where the displacements come from: computed with
/// these linear elements, or of a specimen, for which the quadratic ones stand.
///
/// Twice the logarithm of the ratio of their likelihoods is the gain
///
///   (|r_1|^2 - |r_2|^2) / sd^2, or 2 m ln(|r_1| / |r_2|)
///
/// where the noise is given, or not, for m rows beside those that fix the
/// parameters.  Outliers, which neither explains, decide nothing; rows that
/// neighbours share count as ElementErrors counts them.  Both are as likely
/// before that.
///
/// Precondition: both estimates are of the displacements of the scene, and
/// have a residual (Estimate::bounded_residual) unless they failed.
class OrderComparison {
 public:
  OrderComparison(const Scene& scene, const EstimatorOptions& options,
                  const Estimate& linear, const Estimate& quadratic);

  /// By more than noise lets it, and by far where its residual is no noise.
  bool IsLinearFarBetter() const { return is_linear_far_better_; }
  bool IsQuadraticFarBetter() const { return is_quadratic_far_better_; }

  /// With a probability of 95 %.
  bool IsLinearLikely() const;
  bool IsQuadraticLikely() const;

  /// What linear elements alone say, without what they are corrected by as
  /// those of a specimen.
  const IsotropicElasticity& ByLinear() const { return by_linear_; }

  /// Adds to the errors of the quadratic elements, as a part of those of
  /// discretisation, what they are off by if the linear ones made the
  /// displacements: p (d_1 - d_2)^2, with the probability p of that.
  void HoldLinear(Estimate& quadratic) const;

 private:
  bool is_linear_far_better_;
  bool is_quadratic_far_better_;
  double probability_of_linear_;
  IsotropicElasticity by_linear_;
};

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_ELEMENT_ORDER_H_
