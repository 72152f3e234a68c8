#ifndef ELASTIMATE_ESTIMATORS_FORCE_BALANCE_LOCAL_MAP_H_
#define ELASTIMATE_ESTIMATORS_FORCE_BALANCE_LOCAL_MAP_H_

#include <Eigen/Core>

#include "elastimate/core/scene/scene.h"
#include "elastimate/estimators/interface/estimator.h"

namespace elastimate {

/// Young's modulus of each element by the balance of forces of its nodes.
struct LocalMap {
  /// num_elements values [pressure], of any sign.
  Eigen::VectorXd youngs_modulus;
  double poisson_ratio = 0;  ///< One for all, estimated or given.
  /// Whether the equations determine all of these.  In meshes of tetrahedra,
  /// which have more elements than equations of one load case, they do not.
  bool is_determined = false;
  /// ||sum_e E_e f_e - F|| / ||F|| over the free degrees of freedom.
  double force_residual = 0;
};

/// Minimises
///
///   || sum_e E_e K_e(nu) q - F ||^2
///
/// over the free degrees of freedom of all load cases, by sparse QR, the local
/// approach of [Becker & Teschner 2007]: no equilibrium is solved.  nu is given
/// or one unknown of all elements, by Gauss-Newton steps from the best of some
/// values on.
///
/// It is exact without noise.  With noise it is of no use: differentiated noise
/// makes the error of E 1.5 to 7 times as large as the contrast at 1 % noise on
/// meshes of 256 elements, whereas EstimateMap has a tenth of the contrast.
/// Whitened by K^-1 the equations are one Gauss-Newton step of that fit.
///
/// Preconditions are those of Estimator::Run, and the displacement of every
/// free component is measured at nodes.
[[nodiscard]] LocalMap EstimateLocalMap(const Scene& scene,
                                        const EstimatorOptions& options);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_FORCE_BALANCE_LOCAL_MAP_H_
