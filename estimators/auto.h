#ifndef ELASTIMATE_ESTIMATORS_AUTO_H_
#define ELASTIMATE_ESTIMATORS_AUTO_H_

#include <memory>

#include "elastimate/estimators/interface/estimator.h"

namespace elastimate {

/// Models no more than the scene needs: climbs
///
///   closed-form, virtual-fields, reduced-fe, iterative-fe
///
/// and stops at the first rung that is usable, has nothing to warn of, and
/// whose standard errors are within 1 % of E and 0.01 in nu.  reduced-fe and
/// iterative-fe are at the statistical limit of the data, so that a larger
/// standard error is no reason to go on: iterative-fe is the last rung, for
/// scenes that reduced-fe does not take and fits that it cannot certify.
///
/// Measured displacements (Origin::kMeasured) begin at reduced-fe, since the
/// rungs below it know no mesh error; finer elements are tried within that rung
/// as far as the mesh error asks for them (FitRefined).  Several materials,
/// unknown motions and supports of load cases are passed over by
/// virtual-fields.
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
