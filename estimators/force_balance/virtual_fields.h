#ifndef ELASTIMATE_ESTIMATORS_FORCE_BALANCE_VIRTUAL_FIELDS_H_
#define ELASTIMATE_ESTIMATORS_FORCE_BALANCE_VIRTUAL_FIELDS_H_

#include "elastimate/estimators/interface/estimator.h"

namespace elastimate {

/// The virtual fields method with continuously updated optimal weights: for k
/// polynomial virtual fields V,
///
///   min over (nu, t) of r^T G(nu)^-1 r,   r = V^T (a + nu b - t f),
///   a = H q,  b = J q,  t = (1 + nu)(1 - 2 nu) / E,
///   G(nu) = ((H + nu J) V)^T ((H + nu J) V),
///
/// where sigma^2 G is the covariance of r under independent displacement noise
/// [weights of least variance: Avril & Pierron, Int. J. Solids Struct. 44
/// (2007) 4978].  t is linear; the global minimum over nu comes from a scan of
/// the whole range and the refinement of every minimum it shows.  Bounds on nu
/// and E are kept.
///
/// Needs the displacement of every free node; needs no supports.  Noise does
/// not bias it to first order in the noise variance, since the weights follow
/// nu, and its level need not be known.  Standard errors are the sandwich of
/// Newey & Windmeijer, Econometrica 77 (2009) 687, eq. 3, which knows that b is
/// noisy.  On blocks they are 1 to 3 times the Cramer-Rao bound, and the
/// higher the degree the smaller; low degrees describe slender and
/// many-limbed shapes poorly, which the standard errors show.  Where that of nu
/// is large (kLargestLinearShare) or nu at the end of its range, the interval
/// of nu is that of the profile of the minimum over t, and the standard errors
/// are widened to it; one that reaches further than 1.96 times 0.15 is not
/// usable.  Nor is an estimate whose bound on E the data contradict, or whose
/// balance needs displacements that differ by more than a fifth.
///
/// The square sum over the noise is chi^2 with k num_load_cases - 2 degrees of
/// freedom when the mesh, the supports and the loads describe the experiment.
/// It is held against the given noise, or against that which the force residual
/// shows, most of which lies in wavelengths far below those of the fields.
///
/// Nothing here sees what the elements miss: of measured displacements
/// (Origin::kMeasured) the errors are those of noise alone, with a warning.
///
/// Cost: one element pass of 12, 30 or 60 columns for the degrees 1, 2 and 3 of
/// EstimatorOptions::virtual_field_degree and a QR factorisation of as many
/// columns twice, which depend on the mesh only, and four passes of one to
/// three columns.
/// Single-threaded, deterministic.
class VirtualFields : public Estimator {
 public:
  /// The degree where none is asked for.
  static constexpr int kDefaultDegree = 2;

  std::string_view Name() const override;
  std::string_view Description() const override;
  Capabilities WhatItTakes() const override;

 protected:
  Estimate DoRun(const Scene& scene,
                 const EstimatorOptions& options) const override;
  std::unique_ptr<Preparation> DoPrepare(
      const Scene& scene, const EstimatorOptions& options) const override;
};

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_FORCE_BALANCE_VIRTUAL_FIELDS_H_
