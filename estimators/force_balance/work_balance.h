#ifndef ELASTIMATE_ESTIMATORS_FORCE_BALANCE_WORK_BALANCE_H_
#define ELASTIMATE_ESTIMATORS_FORCE_BALANCE_WORK_BALANCE_H_

#include <Eigen/Core>
#include <vector>

#include "elastimate/core/solvers/stiffness_solver.h"
#include "elastimate/estimators/force_balance/force_residual.h"
#include "elastimate/estimators/force_balance/virtual_work.h"

namespace elastimate {

/// The balance of virtual work of a measurement, of the moduli theta of any
/// materials and the fields V of `work`, in all load cases below each other:
///
///   z = L^-1 r,   r = V^T (F theta - f),   L L^T = G = M^T M,
///   M = K(theta) V on the free rows.
///
/// Independent noise of variance sigma^2 in q gives r the covariance sigma^2 G,
/// and ||z|| is the size of the smallest correction M lambda of the
/// displacements, lambda = G^-1 r, that brings the work into balance.
///
/// At large strains, K(theta) is the tangent at the measured q of each load
/// case, which noise changes to first order by, and f_k(q - M lambda) is f_k(q)
/// - K_k(q) M lambda.  M and L are then those of each load case.  The forces
/// must be linear in the moduli (ForceScene::AreNonlinearInModuli).
///
/// For one isotropic material of small strains, M is the combination of H V and
/// J V, which VirtualWork keeps as a triangle: an evaluation then takes no pass
/// over the elements, which on 200 000 tetrahedra makes an estimate nine times
/// as fast.
class WorkBalance {
 public:
  /// `work` has the fields of the scene of `forces`; both outlive this object.
  WorkBalance(const VirtualWork& work, const ForceResidual& forces);

  Eigen::Index NumEquations() const { return work_of_loads_.size(); }
  const Work& WorkDone() const { return work_done_; }
  /// Whether the loads do work on the fields at all, beyond rounding.
  bool DoLoadsWork() const;

  /// z, and where it is asked for its derivative along directions of theta
  /// (num_moduli x n), taken as L^-1 V^T f_k(q - M lambda), which makes that of
  /// ||z||^2 exact.  False where M is singular.  At moduli other than the last
  /// ones, a pass of as many columns as there are fields, and their QR
  /// factorisation, at large strains for each load case; for derivatives two
  /// passes for each load case, at large strains one for each modulus.
  bool Evaluate(const Eigen::VectorXd& moduli,
                const Eigen::MatrixXd& directions, Eigen::VectorXd* residual,
                Eigen::MatrixXd* jacobian);

  /// The part of jacobian^T jacobian of the last evaluation that noise of
  /// variance 1 makes in the mean, along directions of theta:
  ///
  ///   N_kl = sum over load cases of tr(L^-1 (K_k V)^T (I - P) (K_l V) L^-T),
  ///
  /// P = M G^-1 M^T.  For other materials than one isotropic one by random
  /// probes of the fields: a pass of as many columns.
  Eigen::MatrixXd NoiseOfInformation(const Eigen::MatrixXd& directions);

  /// The factor on all moduli that balances the work of all fields best.
  double BestScale(const Eigen::VectorXd& moduli) const;
  /// The moduli that balance the work of all fields best, unweighted.
  Eigen::VectorXd LeastSquares() const;

 private:
  /// What weighs the work in a load case, or in all of them.
  struct Weight {
    Eigen::MatrixXd stiffened;  ///< M, or rows of the same products.
    Eigen::MatrixXd factor;     ///< L^T.
  };

  const Weight& WeightOf(std::size_t load_case) const {
    return weights_.size() == 1 ? weights_[0] : weights_[load_case];
  }
  /// Sets the weights at these moduli; false where M is singular.
  bool SetWeights(const Eigen::VectorXd& moduli);
  Eigen::MatrixXd Stiffened(const Eigen::VectorXd& moduli,
                            std::size_t load_case) const;
  /// Returns K_k X of each modulus, for displacements X (num_dofs x n).
  std::vector<Eigen::MatrixXd> Products(std::size_t load_case,
                                        const Eigen::MatrixXd& displacements);
  /// V^T f_k(M lambda), k x num_moduli.
  Eigen::MatrixXd WorkOfCorrection(std::size_t load_case,
                                   const Eigen::VectorXd& multipliers);
  /// Returns the part of a load case in N.
  Eigen::MatrixXd NoiseOfInformation(std::size_t load_case,
                                     const Eigen::MatrixXd& directions);

  const VirtualWork& work_;
  const ForceResidual& forces_;
  bool has_triangle_;
  Eigen::MatrixXd fields_;  ///< Empty where there is a triangle.
  /// V^T f_k(q) for each load case, k x num_moduli; V^T f.
  std::vector<Eigen::MatrixXd> work_of_columns_;
  Eigen::MatrixXd work_of_loads_;
  Eigen::VectorXd moduli_;  ///< Those of the last evaluation, and of weights_.
  std::vector<Weight> weights_;
  Work work_done_;
};

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_FORCE_BALANCE_WORK_BALANCE_H_
