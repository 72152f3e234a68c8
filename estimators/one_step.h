#ifndef ELASTIMATE_ESTIMATORS_ONE_STEP_H_
#define ELASTIMATE_ESTIMATORS_ONE_STEP_H_

#include "elastimate/estimators/estimator.h"

namespace elastimate {

/// One Gauss-Newton step of the displacement fit, from a start that is close
/// enough for one [Le Cam's one-step estimator: van der Vaart, Asymptotic
/// Statistics, 1998, section 5.7].
///
/// With A0 = H + nu0 J factorised at the nu0 of virtual-fields, w = A0^-1 f,
/// the response v to held displacements, and ' for d / dnu,
///
///   t0 = w.(q - v) / w.w,   S = [w, t0 w' + v'],
///   d = (S^T S)^-1 S^T (q - v - t0 w),   t = t0 + d1,   nu = nu0 + d2.
///
/// What the step misses is of the second order, (nu0 - nu)^2 / (1/2 - nu): the
/// step is repeated, with another factorisation, while that is above half a
/// standard error of nu.
///
/// Needs supports that hold the specimen.  Any observed components will do:
/// where virtual-fields cannot give a start, it is nu0 = 0.3.  Reaches the
/// Cramer-Rao bound as long as the mesh describes the specimen.  A start on the
/// wrong side of two minima stays there; reduced-fe does not have that problem.
/// An estimate of nu whose standard error is above a tenth of the distance to
/// the nearer of -1 and 1/2 is not usable: the model is not linear that far.
///
/// Cost: virtual-fields, then 1 to 3 factorisations and 2 solves for each load
/// case and factorisation.
class OneStep : public Estimator {
 public:
  std::string_view Name() const override;
  std::string_view Description() const override;
  std::string WhyUnsupported(const Scene& scene,
                             const EstimatorOptions& options) const override;

 protected:
  Estimate DoRun(const Scene& scene,
                 const EstimatorOptions& options) const override;
};

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_ONE_STEP_H_
