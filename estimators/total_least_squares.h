#ifndef ELASTIMATE_ESTIMATORS_TOTAL_LEAST_SQUARES_H_
#define ELASTIMATE_ESTIMATORS_TOTAL_LEAST_SQUARES_H_

#include "elastimate/estimators/estimator.h"

namespace elastimate {

/// closed-form without its noise bias, by errors in variables.  With a~ and b~
/// the parts of a = H q and b = J q that are orthogonal to the loads,
///
///   M = [a~ b~]^T [a~ b~],   E M = M0 + sigma^2 T,
///
/// where T, the traces of the products of H and J without the loads, depends on
/// the mesh only.  The smaller root s of det(M - s T) = 0 estimates sigma^2
/// (which is used instead when it is given), and
///
///   (M_12 - s T_12) + nu (M_22 - s T_22) = 0,
///   t = f.(a + nu b) / f.f  [Becker & Teschner 2007, eq. 20],
///   E = (1 + nu)(1 - 2 nu) / t.
///
/// Needs what closed-form needs; keeps no bounds.  This removes the bias, not
/// the variance: expect standard errors of 3 to 35 times the Cramer-Rao bound
/// on meshes of up to 500 nodes, and of 30 to 120 times on one of 9000, at 0.1
/// to 1 % noise.  They are sigma ||d(E, nu) / dq||, and at most sqrt(2) too
/// large where the estimate is no longer linear in the noise.  The force
/// residual cannot tell errors of the mesh, the supports and the loads from
/// noise, so that the estimate is held against virtual-fields of degree 1.
///
/// Cost: five element passes of one to three columns per load case, and that of
/// virtual-fields of degree 1; no factorisation.  Single-threaded,
/// deterministic.
class TotalLeastSquares : public Estimator {
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

#endif  // ELASTIMATE_ESTIMATORS_TOTAL_LEAST_SQUARES_H_
