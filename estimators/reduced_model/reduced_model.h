#ifndef ELASTIMATE_ESTIMATORS_REDUCED_MODEL_REDUCED_MODEL_H_
#define ELASTIMATE_ESTIMATORS_REDUCED_MODEL_REDUCED_MODEL_H_

#include <Eigen/Core>
#include <string>
#include <vector>

#include "elastimate/core/laws/elasticity.h"
#include "elastimate/core/mechanics/stiffness_product.h"
#include "elastimate/core/scene/scene.h"
#include "elastimate/core/solvers/stiffness_solver.h"
#include "elastimate/estimators/reduced_model/compliance_norm.h"
#include "elastimate/estimators/reduced_model/krylov_bound.h"

namespace elastimate {

/// A response x(nu) in the modes of its reduced problem, in which it is
/// explicit in nu:
///
///   x = basis * vectors * y,   y_i = (g0_i + nu g1_i) / (1 + (nu - pole)
///   theta_i).
struct ReducedModes {
  double pole = 0;
  Eigen::MatrixXd vectors;  ///< m x m.
  Eigen::VectorXd theta;    ///< m values, and so on.
  Eigen::VectorXd g0;
  Eigen::VectorXd g1;

  /// y.  O(m).
  Eigen::VectorXd At(double poisson_ratio) const;
  /// dy / dnu.  O(m).
  Eigen::VectorXd DerivativeAt(double poisson_ratio) const;
  /// The energy norm of x in A(nu).  O(m).
  double EnergyNorm(double poisson_ratio) const;
};

/// The finite element displacements of a scene for any nu, from a few
/// factorisations.
///
/// With A(nu) = H + nu J on the free degrees of freedom, each load case and the
/// held displacements cause a response x(nu) with A(nu) x = g0 + nu g1:
///
///   u = t w + v,   A w = f,   A v = -(h_c + nu j_c),
///
/// where h_c, j_c are the products of the held displacements with H and J.
/// Each x is sought in a space of its own: the sum of the spaces of KrylovBound
/// at some poles.  x is analytic in nu on (-1, 1/2), so that few vectors do.
/// Since Galerkin's solution is the best of its space in the energy norm of
/// A(nu), the least of the bounds of all poles holds.
class ReducedModel {
 public:
  /// Assembles and analyses; `scene` must outlive this object.
  /// Preconditions and exceptions: those of StiffnessSolver.
  explicit ReducedModel(const Scene& scene,
                        SolverKind solver = SolverKind::kAutomatic);

  /// Factorises A(nu), with which Enlarge will solve from now on, and adds the
  /// responses at nu and their derivatives to the spaces.  False when A(nu) is
  /// singular to working precision, or a solve failed.
  /// Cost: a factorisation, and two element passes and two solves for each
  /// response.
  bool SetPole(double poisson_ratio);

  /// Adds the next vector of the Krylov space at the pole to each response.
  /// False when there is none, or a solve failed.
  /// `tolerance` is that of iterative solves.
  /// Precondition: SetPole returned true.  Cost: an element pass (two where the
  /// solves are inexact) and a solve for each response.
  bool Enlarge(double tolerance = StiffnessSolver::kAccurate);

  /// Gives back the memory of the Krylov vectors and of the solver.  There is
  /// no next vector until the next pole.
  void KeepResponses();

  /// An upper bound of the error of response `k` at nu, in the energy norm of
  /// A(nu).  Infinite before the first pole.  O(m^2) for each pole.
  double ErrorBound(Eigen::Index k, double poisson_ratio) const;
  /// The largest over all responses of ErrorBound over the response's own norm.
  double RelativeErrorBound(double poisson_ratio) const;

  /// ComplianceNorm of the present pole.
  double ComplianceNormAtPole(const Eigen::VectorXd& weights) {
    return ComplianceNorm(weights, solver_);
  }

  /// w of all load cases and, behind them, v where supports are displaced, at
  /// nu: num_dofs x num_responses.  O(num_nodes m).
  Eigen::MatrixXd Responses(double poisson_ratio) const;

  /// Whether solves for the bases were inexact; before there are bases, whether
  /// they will be.
  bool UsesMultigrid() const {
    return uses_multigrid_ || solver_.UsesMultigrid();
  }

  /// What relates t to E.
  SectionModel Section() const { return section_model_; }

  /// nu of the present pole.
  double Pole() const { return solver_.PoissonRatio(); }

  /// The modes of load case `k`, and for `k` = num_load_cases, where there are
  /// held displacements, of the response to those.
  const ReducedModes& Modes(Eigen::Index k) const {
    return responses_[k].modes;
  }
  /// The basis of response `k`, num_dofs x m, zero in the held rows.
  const Eigen::MatrixXd& Basis(Eigen::Index k) const {
    return responses_[k].basis;
  }
  Eigen::Index NumLoadCases() const { return num_load_cases_; }
  Eigen::Index NumResponses() const { return Eigen::Index(responses_.size()); }
  bool HasSupportResponse() const { return NumResponses() > num_load_cases_; }
  /// Steps with every change of a basis.
  int Version() const { return version_; }
  const StiffnessSolver& Solver() const { return solver_; }
  const NodeGraph& Graph() const { return solver_.Graph(); }
  Work WorkDone() const;
  /// What the StiffnessSolver says (StiffnessSolver::Notice).
  const std::string& Notice() const { return solver_.Notice(); }

 private:
  struct Response {
    Eigen::VectorXd g0;
    Eigen::VectorXd g1;
    /// Orthonormal in the energy of the pole at which they were added.
    Eigen::MatrixXd basis;
    Eigen::MatrixXd reduced_h;
    Eigen::MatrixXd reduced_j;
    ReducedModes modes;
    std::vector<KrylovBound> bounds;  ///< One for each pole.
    /// v_1 ... v_{m+1} of the present pole, and J v_{m+1}; no columns where the
    /// space is invariant.
    Eigen::MatrixXd krylov;
    Eigen::VectorXd next_product;
  };

  Eigen::MatrixXd FreeRows(const Eigen::MatrixXd& all) const;
  /// H x and J x in the free rows.
  StiffnessProducts Multiply(const Eigen::MatrixXd& x);
  struct KrylovStep;
  /// Takes off `z` what it has along the Krylov vectors, in the energy of the
  /// pole, and multiplies what is left.
  void Orthogonalize(KrylovStep& step);
  /// Adds the `k`-th vector of the step to its response, unless it is zero up
  /// to rounding; `inexactness` is the relative error of the solves.
  void ExtendKrylov(Eigen::Index k, double inexactness, const KrylovStep& step);
  /// Adds the part of x that the basis of a response lacks; `h` = H x, `j` =
  /// J x.
  void Append(const Eigen::VectorXd& x, const Eigen::VectorXd& h,
              const Eigen::VectorXd& j, Response& response);
  void FindModes(Response& response) const;

  SectionModel section_model_;
  StiffnessOperator stiffness_;
  StiffnessSolver solver_;
  Eigen::Index num_load_cases_;
  std::vector<Response> responses_;
  bool uses_multigrid_ = false;
  int element_passes_ = 0;
  int version_ = 0;
};

/// What a ReducedModel says of (E, nu), without the held displacements, which
/// are zero in it.
struct ReducedSolution {
  Eigen::MatrixXd displacement;           ///< num_dofs x num_load_cases.
  Eigen::MatrixXd by_log_youngs_modulus;  ///< du / d ln E, of that shape.
  Eigen::MatrixXd by_poisson_ratio;       ///< du / d nu.
};

/// u = t w(nu) + v(nu), t = (1 + nu)(1 - 2 nu) / E, and its derivatives.
/// O(num_nodes m).
ReducedSolution SolveReduced(const ReducedModel& model,
                             const IsotropicElasticity& elasticity);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_REDUCED_MODEL_REDUCED_MODEL_H_
