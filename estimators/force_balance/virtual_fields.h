#ifndef ELASTIMATE_ESTIMATORS_FORCE_BALANCE_VIRTUAL_FIELDS_H_
#define ELASTIMATE_ESTIMATORS_FORCE_BALANCE_VIRTUAL_FIELDS_H_

#include "elastimate/estimators/interface/estimator.h"

namespace elastimate {

/// The virtual fields method with continuously updated optimal weights, for the
/// moduli theta of any materials and k polynomial virtual fields V:
///
///   min over theta of r^T G^-1 r,   r = V^T (F(q) theta - f),
///   G = (K(theta) V)^T (K(theta) V),
///
/// where sigma^2 G is the covariance of r under independent displacement noise
/// [weights of least variance: Avril & Pierron, Int. J. Solids Struct. 44
/// (2007) 4978].  The fields are those of FieldsOfMaterials; the minimum is the
/// best that Ceres finds from several starts, within the bounds.
///
/// Needs the displacement of every free node; needs no supports.  Noise does
/// not bias it to first order in the noise variance, since the weights follow
/// theta, and its level need not be known.  Standard errors are the sandwich of
/// Newey & Windmeijer, Econometrica 77 (2009) 687, eq. 3, which knows that F is
/// noisy; parameters of which noise alone may make all information are not
/// determined.  On blocks they are 1 to 3 times the Cramer-Rao bound, and the
/// higher the degree the smaller; low degrees describe slender and
/// many-limbed shapes poorly, which the standard errors show.  An estimate is
/// not usable where its bound on a modulus is contradicted by the data, or
/// where its balance needs displacements that differ by more than a fifth.
///
/// The square sum over the noise is chi^2 with k num_load_cases less the
/// parameters as degrees of freedom when the mesh, the supports and the loads
/// describe the experiment.  It is held against the given noise, or against
/// that which the force residual shows, most of which lies in wavelengths far
/// below those of the fields.
///
/// For laws of large strains, F has the columns at the measured q, and the
/// covariance has the tangent there (WorkBalance), so that noise biases the
/// estimate to second order.  The forces of such a law must be linear in the
/// moduli, which excludes plane stress.  Throws std::invalid_argument where a
/// displacement turns an element inside out.
///
/// Nothing here sees what the elements miss, or whether regions are right: of
/// measured displacements (Origin::kMeasured) the errors are those of noise
/// alone, with a warning.
///
/// Cost: that of VirtualWork, which depends on the mesh only, two passes of one
/// to three columns, and for other materials than one isotropic one a pass of
/// as many columns as there are fields in each step (WorkBalance).
/// Single-threaded, deterministic.
class VirtualFields : public Estimator {
 public:
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
