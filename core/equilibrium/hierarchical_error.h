#ifndef ELASTIMATE_CORE_EQUILIBRIUM_HIERARCHICAL_ERROR_H_
#define ELASTIMATE_CORE_EQUILIBRIUM_HIERARCHICAL_ERROR_H_

#include <Eigen/Core>
#include <optional>

#include "elastimate/core/mechanics/stiffness_product.h"
#include "elastimate/core/mesh/mid_edges.h"
#include "elastimate/core/scene/scene.h"
#include "elastimate/core/solvers/stiffness_solver.h"

namespace elastimate {

/// What linear simplices miss of the displacements of quadratic ones of the
/// same mesh: the error of a response x of A(nu) = H + nu J to the loads (w) or
/// to the held displacements (v),
///
///   e = x_quadratic - x_linear,   A_quadratic e = f - A_quadratic x_linear,
///
/// by conjugate gradients, preconditioned in the hierarchical basis of linear
/// functions at the vertices and quadratic ones in the middle of the edges: by
/// A_linear, which is factorised already, and by the 3 x 3 (2 x 2) blocks of
/// the mid-edge nodes [Deuflhard, Leinen & Yserentant, IMPACT Comput. Sci. Eng.
/// 1 (1989) 3].  The iterations do not grow with the mesh, but next to nu =
/// 1/2.  Quadratic elements are never assembled.
class HierarchicalError {
 public:
  /// Relative, in the energy norm of the error itself.
  static constexpr double kTolerance = 0.03;

  /// `scene` must outlive this object.  Preconditions and exceptions are those
  /// of QuadraticScene.  O(num_elements) time; memory as for ten displacements
  /// of the quadratic mesh.
  explicit HierarchicalError(const Scene& scene);

  /// The error at the vertices of the responses to the load cases (the first
  /// columns of `responses`) and of that to the held displacements (the column
  /// behind them, if there is one), all at nu and num_dofs x n; empty where it
  /// takes too many iterations.
  /// Precondition: `linear` is of the mesh of the scene, or of other elements
  /// of these nodes, whose responses are the given ones then, and its last
  /// factorisation succeeded; the nearer to nu, the fewer iterations.
  /// Cost: for each of some 20 iterations a pass of quadratic elements and a
  /// solve for each response.
  std::optional<Eigen::MatrixXd> Find(double poisson_ratio,
                                      const Eigen::MatrixXd& responses,
                                      StiffnessSolver& linear);

  int NumPasses() const { return num_passes_; }

 private:
  /// A_quadratic x, zero in the held rows.
  Eigen::MatrixXd Multiply(double poisson_ratio, const Eigen::MatrixXd& x);
  Eigen::MatrixXd Precondition(const Eigen::MatrixXd& inverses,
                               const Eigen::MatrixXd& residual,
                               StiffnessSolver& linear) const;
  /// Of the blocks of A_quadratic of the mid-edge nodes, side by side.
  Eigen::MatrixXd InverseBlocks(double poisson_ratio) const;

  Scene quadratic_;
  MidEdges mid_edges_;
  StiffnessOperator stiffness_;
  Eigen::VectorXd is_free_;  ///< 1 or 0 for each degree of freedom.
  Eigen::MatrixXd force_;
  StiffnessProducts products_;
  int num_passes_ = 0;
};

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_EQUILIBRIUM_HIERARCHICAL_ERROR_H_
