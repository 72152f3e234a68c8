#ifndef ELASTIMATE_ESTIMATORS_REDUCED_MODEL_H_
#define ELASTIMATE_ESTIMATORS_REDUCED_MODEL_H_

#include <Eigen/Core>
#include <string>
#include <vector>

#include "elastimate/core/scene.h"
#include "elastimate/core/stiffness_product.h"
#include "elastimate/core/stiffness_solver.h"

namespace elastimate {

/// A response x(nu) in the modes of its reduced problem, in which it is
/// explicit in nu:
///
///   x = basis * vectors * y,   y_i = (g0_i + nu g1_i) / (1 + (nu - pole)
///   theta_i).
struct ReducedModes {
  double pole;
  Eigen::MatrixXd vectors;  ///< m x m.
  Eigen::VectorXd theta;    ///< m values, and so on.
  Eigen::VectorXd g0;
  Eigen::VectorXd g1;

  /// y.  O(m).
  Eigen::VectorXd At(double poisson_ratio) const;
  /// dy / dnu.  O(m).
  Eigen::VectorXd DerivativeAt(double poisson_ratio) const;
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
/// Each x is sought in a space of its own, spanned by A_p^-1 r for residuals
/// r = g0 + nu g1 - A(nu) x, with the factorisation of A_p = A(pole).  For one
/// pole that is the Krylov space of A_p^-1 J.  x is analytic in nu on (-1,
/// 1/2), so that few vectors do.
class ReducedModel {
 public:
  /// Assembles and analyses; `scene` must outlive this object.
  /// Preconditions and exceptions: those of StiffnessSolver.
  explicit ReducedModel(const Scene& scene,
                        SolverKind solver = SolverKind::kAutomatic);

  /// Factorises A(nu), whose residuals will be solved with from now on.
  /// False when it is singular to working precision.
  bool SetPole(double poisson_ratio);

  /// An upper bound of the error of every response at nu, in the energy norm,
  /// relative to the response:
  ///
  ///   ||x - x_m||_A <= ||r||_{A_p^-1} / sqrt(min((1 - 2 nu) / (1 - 2 pole),
  ///                                              (1 + nu) / (1 + pole))).
  ///
  /// Where it is above `tolerance`, the spaces are enlarged by A_p^-1 r.
  /// The solves may be inexact, for what is appended is taken as it is, and the
  /// residual of the whole is computed anew.  Of the bound, a part of half the
  /// square of their relative error, 1e-3 at most, is missing.
  /// Infinite when a solve failed.
  /// Precondition: SetPole returned true.  Cost: an element pass (two where it
  /// enlarges) and a solve for each response.
  double Refine(double poisson_ratio, double tolerance);

  /// The modes of load case `k`, and for `k` = num_load_cases, where there are
  /// held displacements, of the response to those.
  const ReducedModes& Modes(Eigen::Index k) const {
    return responses_[k].modes;
  }
  /// The basis of response `k`, (3 num_nodes) x m, zero in the held rows.
  const Eigen::MatrixXd& Basis(Eigen::Index k) const {
    return responses_[k].basis;
  }
  Eigen::Index NumLoadCases() const { return num_load_cases_; }
  bool HasSupportResponse() const {
    return Eigen::Index(responses_.size()) > num_load_cases_;
  }
  /// Steps with every change of a basis.
  int Version() const { return version_; }
  const NodeGraph& Graph() const { return solver_.Graph(); }
  Work WorkDone() const;
  /// That of StiffnessSolver.
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
  };

  /// Adds the parts of `correction` = A_pole^-1 `residual` that the bases lack.
  void Append(const Eigen::MatrixXd& residual, Eigen::MatrixXd correction);

  StiffnessOperator stiffness_;
  StiffnessSolver solver_;
  Eigen::Index num_load_cases_;
  std::vector<Response> responses_;
  int element_passes_ = 0;
  int version_ = 0;
};

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_REDUCED_MODEL_H_
