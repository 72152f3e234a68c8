#ifndef ELASTIMATE_ESTIMATORS_FORCE_BALANCE_WORK_BALANCE_H_
#define ELASTIMATE_ESTIMATORS_FORCE_BALANCE_WORK_BALANCE_H_

#include <Eigen/Core>
#include <vector>

#include "elastimate/core/mechanics/internal_forces.h"
#include "elastimate/core/scene/degrees_of_freedom.h"
#include "elastimate/core/scene/scene.h"
#include "elastimate/estimators/force_balance/virtual_work.h"
#include "elastimate/estimators/interface/estimate.h"

namespace elastimate {

/// The balance of virtual work of the measurement of a scene of any materials,
/// with the fields V of `work`, in all load cases below each other:
///
///   L^-1 r,   r = V^T (F(q) theta - f),   L L^T = M^T M,
///   M = K(theta) V on the free rows,
///
/// the size of which is that of the displacements that would bring the work
/// into balance, over the noise where that is given.
class WorkBalance {
 public:
  /// Preconditions: every free component is observed; `work` is that of the
  /// scene, and outlives this.  An element pass for each load case.
  WorkBalance(const Scene& scene, const VirtualWork& work);

  Eigen::Index NumEquations() const { return work_of_loads_.size(); }
  const Work& WorkDone() const { return work_done_; }

  /// L^-1 r, and its derivative by theta along directions (num_moduli x n)
  /// where it is asked for.  False where M is singular.  At moduli other than
  /// the last ones, a pass of as many columns as there are fields, and their QR
  /// factorisation; for derivatives two passes for each load case.
  bool Evaluate(const Eigen::VectorXd& moduli,
                const Eigen::MatrixXd& directions, Eigen::VectorXd* residual,
                Eigen::MatrixXd* jacobian);

  /// The factor on all moduli that balances the work of all fields best.
  double BestScale(const Eigen::VectorXd& moduli) const;

  /// The moduli that balance the work of all fields best, unweighted.
  Eigen::VectorXd LeastSquares() const;

  double ForceResidualNorm(const Eigen::VectorXd& moduli) const;
  double LoadNorm() const;
  double DisplacementNorm() const;

 private:
  DegreesOfFreedom dofs_;
  InternalForces forces_;
  const VirtualWork& work_;
  Eigen::MatrixXd fields_;
  Eigen::MatrixXd q_;
  Eigen::MatrixXd f_;  ///< On the free rows.
  std::vector<Eigen::MatrixXd> columns_;
  std::vector<Eigen::MatrixXd> work_of_columns_;
  Eigen::MatrixXd work_of_loads_;
  Eigen::VectorXd moduli_of_noise_;  ///< Of the last evaluation.
  Eigen::MatrixXd noise_;            ///< L^T there.
  Work work_done_;
};

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_FORCE_BALANCE_WORK_BALANCE_H_
