#ifndef ELASTIMATE_CORE_EQUILIBRIUM_FORWARD_MODEL_H_
#define ELASTIMATE_CORE_EQUILIBRIUM_FORWARD_MODEL_H_

#include <Eigen/Core>
#include <string>

#include "elastimate/core/materials/elasticity.h"
#include "elastimate/core/scene/scene.h"
#include "elastimate/core/solvers/stiffness_solver.h"

namespace elastimate {

/// Derivatives of the displacement, num_dofs x num_load_cases each.
struct DisplacementSensitivities {
  Eigen::MatrixXd log_youngs_modulus;  ///< du / d ln E at fixed nu [length].
  Eigen::MatrixXd poisson_ratio;       ///< du / d nu at fixed E [length].
};

/// The finite element model of a scene: displacements from E and nu.
///
/// With A(nu) = H + nu J on the free degrees of freedom, loads f, held
/// displacements u_c and t = (1 + nu)(1 - 2 nu) / E,
///
///   u = t w + v,   A w = f,   A v = -(A_fc u_c),
///   du/dnu|_t = -A^-1 (J u)_f,
///
/// so one factorisation serves every E and all load cases, and the
/// derivatives cost one more solve per load case.
///
///   ForwardModel model(scene.mesh, scene.supports, AssembleLoadCases(scene));
///   if (model.SetPoissonRatio(0.3)) {
///     Eigen::MatrixXd u = model.Displacement(50e3);
///   }
class ForwardModel {
 public:
  /// Assembles and analyses.  `force` is num_dofs x num_load_cases
  /// [force]; its rows at held degrees of freedom have no effect.
  /// `mesh` must outlive this object; a temporary one does not compile.
  /// Preconditions: a valid scene; HasMultigrid() for kMultigrid.
  /// Throws std::invalid_argument with the sentence of WhyNotHeld when the
  /// supports do not hold the specimen, and std::bad_alloc when the factor does
  /// not fit into memory.
  ForwardModel(const Mesh& mesh, const Supports& supports,
               const Eigen::MatrixXd& force,
               SolverKind solver = SolverKind::kAutomatic);
  ForwardModel(const Mesh&&, const Supports&, const Eigen::MatrixXd&,
               SolverKind = SolverKind::kAutomatic) = delete;

  /// Factorises A(nu) and solves for w and v; does nothing when nu is the
  /// present one.  False when A(nu) is singular to working precision (nu at or
  /// beyond -1 or 1/2, or an extremely ill-conditioned mesh).
  bool SetPoissonRatio(double poisson_ratio);

  /// u for all load cases, num_dofs x num_load_cases.  Costs no solve.
  /// Precondition: SetPoissonRatio returned true.
  Eigen::MatrixXd Displacement(double youngs_modulus) const;

  /// The part t w of u that the loads cause, for t = 1 [length * pressure].
  const Eigen::MatrixXd& UnitLoadResponse() const { return load_response_; }
  /// Returns dw/dnu.  Precondition: Sensitivities was called at the present nu.
  const Eigen::MatrixXd& UnitLoadResponseDerivative() const {
    return load_response_derivative_;
  }
  /// The part v of u that the held displacements cause, one column [length].
  const Eigen::VectorXd& SupportResponse() const { return support_response_; }

  /// Returns w of all load cases and, where supports are displaced, v as the
  /// last column: num_dofs x num_responses.
  Eigen::MatrixXd Responses() const;

  /// Returns the derivatives at the present nu.  The first call at a nu costs
  /// an element pass and num_load_cases solves (one more with held
  /// displacements).
  DisplacementSensitivities Sensitivities(double youngs_modulus);

  /// Returns nu of the present factorisation, or NaN when there is none.
  double PoissonRatio() const { return solver_.PoissonRatio(); }
  const DegreesOfFreedom& Dofs() const { return solver_.Dofs(); }
  /// Returns the solver, which is factorised at the present nu.
  StiffnessSolver& Solver() { return solver_; }
  const NodeGraph& Graph() const { return solver_.Graph(); }
  Work WorkDone() const;
  /// Returns StiffnessSolver::Notice.
  const std::string& Notice() const { return solver_.Notice(); }

 private:
  const Mesh& mesh_;
  StiffnessSolver solver_;
  Eigen::MatrixXd force_;
  Eigen::VectorXd held_displacement_;
  bool has_held_displacement_;
  /// The products (H u_c, J u_c) for the held displacements alone.
  Eigen::VectorXd held_h_;
  Eigen::VectorXd held_j_;
  bool has_derivatives_ = false;
  Eigen::MatrixXd load_response_;
  Eigen::VectorXd support_response_;
  Eigen::MatrixXd load_response_derivative_;
  Eigen::VectorXd support_response_derivative_;
  int element_passes_ = 0;
};

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_EQUILIBRIUM_FORWARD_MODEL_H_
