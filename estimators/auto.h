#ifndef ELASTIMATE_ESTIMATORS_AUTO_H_
#define ELASTIMATE_ESTIMATORS_AUTO_H_

#include <memory>

#include "elastimate/estimators/interface/estimator.h"

namespace elastimate {

/// Models no more than the scene needs: climbs
///
///   closed-form, virtual-fields, reduced-fe, reduced-fe with quadratic
///   elements
///
/// and stops at the first rung that is usable, has nothing to warn of, and
/// whose standard errors are within 1 % of E and 0.01 in nu.  reduced-fe is at
/// the statistical limit of the data, so that there a larger standard error is
/// no reason to climb: what sends it to quadratic elements is a residual that
/// is no noise, or a disagreement with virtual-fields that noise does not
/// explain (Hausman), where it matters by more than these tolerances; or a
/// discretisation error above 1 % (0.01 in nu) and half a standard error.
/// Quadratic elements then have to explain the displacements far better than
/// linear ones to be taken; after a notable discretisation error it is the
/// linear ones that have to be likelier than 95 %, as they are for
/// displacements that were computed with them.  Quadratic ones hold in their
/// errors what the linear ones say as far as that is likely (OrderComparison).
///
/// Of several materials, it climbs from closed-form to reduced-fe, and to
/// iterative-fe where that is not certified; of unknown motions and supports of
/// load cases, to iterative-fe.
///
/// A rung that does not support the scene or the options is passed over.  The
/// estimate is that of the last rung, with the work of all of them;
/// Estimate::rungs says why each went on or stopped.
///
/// Needs and cost: those of the rungs it climbs.
class Auto : public Estimator {
 public:
  std::string_view Name() const override;
  std::string_view Description() const override;
  /// It needs what reduced-fe or what virtual-fields needs.
  Capabilities WhatItTakes() const override;
  std::string WhyUnsupported(const Scene& scene,
                             const EstimatorOptions& options) const override;

 protected:
  Estimate DoRun(const Scene& scene,
                 const EstimatorOptions& options) const override;
  std::unique_ptr<Preparation> DoPrepare(
      const Scene& scene, const EstimatorOptions& options) const override;
};

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_AUTO_H_
