#ifndef ELASTIMATE_ESTIMATORS_REDUCED_MODEL_REDUCED_EQUILIBRIUM_H_
#define ELASTIMATE_ESTIMATORS_REDUCED_MODEL_REDUCED_EQUILIBRIUM_H_

#include <Eigen/Core>
#include <vector>

#include "elastimate/core/equilibrium/equilibrium.h"
#include "elastimate/core/mechanics/internal_forces.h"
#include "elastimate/core/scene/observed_displacements.h"

namespace elastimate {

/// Equilibrium of any materials in a few displacements of each load case: of
/// u = u_held + V y Galerkin's, with K(theta) = sum_k theta_k K_k,
///
///   A(theta) y = V^T f - sum_k theta_k V^T K_k u_held,
///   A(theta) = sum_k theta_k V^T K_k V.
///
/// Where V holds u - u_held and its derivatives at some theta, displacements
/// are exact there to first order [Prud'homme et al. 2002].  Where it holds u
/// and the adjoint lambda = K^-1 P^T r of a residual r = P u - q as well, so
/// are ||r||^2 and its gradient -2 lambda^T f_k(u) for every modulus.
class ReducedEquilibrium {
 public:
  /// Takes loads, supports and materials of `full`, which outlives it, as does
  /// `observed`.  An element pass for each load case of displaced supports.
  ReducedEquilibrium(const Equilibrium& full,
                     const ObservedDisplacements& observed);

  /// Adds what the bases lack of some displacements, zero in the held rows, n
  /// of each load case side by side, and makes it orthonormal in the energy at
  /// these moduli.  For each load case n + 5 element passes and O(num_dofs
  /// (num_moduli n m + m^2)) for m vectors in all.
  void Extend(const Eigen::VectorXd& moduli, Eigen::MatrixXd displacements);

  /// Solves for u.  False where A(theta) is not positive definite to working
  /// precision.  O(m^2 (num_moduli + m)) for each load case, as all below.
  bool Solve(const Eigen::VectorXd& moduli);

  // What follows is that of the last Solve, which returned true:

  /// P u - q, turned into few rows of the same inner products: at most
  /// sum (m + 1) over the load cases.
  Eigen::VectorXd Residual() const;
  /// P du/dp in these rows, for directions d theta / d p (num_moduli x n).
  Eigen::MatrixXd Sensitivities(const Eigen::MatrixXd& directions);
  Eigen::Index NumRows() const;

  /// u, num_dofs x num_load_cases, and du/dp of each load case side by side.
  /// O(num_dofs m) for each.
  Eigen::MatrixXd Displacement() const;
  Eigen::MatrixXd DisplacementSensitivities(const Eigen::MatrixXd& directions);
  /// The adjoint of Residual, V A^-1 V^T P^T (P u - q).
  Eigen::MatrixXd Adjoint();

  /// sum over the load cases of (dv/dp)^T K (dv/dp) for v = du/dp: n x n.
  Eigen::MatrixXd EnergyOfSensitivities(const Eigen::MatrixXd& directions);
  /// The largest ||P v|| / ||v||, in the energy norm, over the bases.
  double ComplianceNorm() const;

  /// Gives back the memory of the bases, which are empty then, as before the
  /// first Extend.
  void ForgetBases();

  int ElementPasses() const { return element_passes_; }

 private:
  struct LoadCase {
    Eigen::VectorXd held;          ///< u_held; empty where that is zero.
    Eigen::MatrixXd held_columns;  ///< f_k(u_held), likewise.
    Eigen::MatrixXd basis;         ///< V, num_dofs x m.
    Eigen::MatrixXd of_moduli;     ///< V^T K_k V side by side, m x (m k).
    Eigen::VectorXd load;          ///< V^T f.
    Eigen::MatrixXd held_load;     ///< V^T f_k(u_held), m x num_moduli.
    Eigen::MatrixXd rows;          ///< R of the QR of [P V, q].
    Eigen::MatrixXd stiffness;     ///< A(theta) of the last Solve,
    Eigen::MatrixXd factor;        ///< its Cholesky factor L,
    Eigen::VectorXd y;             ///< and its solution.
  };

  Eigen::Index NumModuli() const { return forces_.Parameters().NumModuli(); }
  Eigen::MatrixXd StiffnessOf(const LoadCase& load_case,
                              const Eigen::VectorXd& moduli) const;
  /// What the basis lacks of the columns, orthonormal in the energy.
  Eigen::MatrixXd NewVectors(const Eigen::VectorXd& moduli,
                             const LoadCase& load_case,
                             Eigen::MatrixXd columns);
  void Append(Eigen::Index k, Eigen::MatrixXd vectors, LoadCase& load_case);
  /// A^-1 of some columns.
  static Eigen::MatrixXd SolveIn(const LoadCase& load_case,
                                 const Eigen::MatrixXd& columns);
  /// dy / dp.
  Eigen::MatrixXd Derivatives(const LoadCase& load_case,
                              const Eigen::MatrixXd& directions) const;

  const InternalForces& forces_;
  const Eigen::MatrixXd& load_;
  const ObservedDisplacements& observed_;
  std::vector<LoadCase> cases_;
  int element_passes_ = 0;
};

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_REDUCED_MODEL_REDUCED_EQUILIBRIUM_H_
