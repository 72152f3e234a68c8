#ifndef ELASTIMATE_CORE_EQUILIBRIUM_HIERARCHICAL_ERROR_H_
#define ELASTIMATE_CORE_EQUILIBRIUM_HIERARCHICAL_ERROR_H_

#include <Eigen/Core>
#include <optional>

#include "elastimate/core/mechanics/stiffness_product.h"
#include "elastimate/core/mesh/finer_nodes.h"
#include "elastimate/core/scene/scene.h"
#include "elastimate/core/solvers/stiffness_solver.h"

namespace elastimate {

/// What elements miss of the displacements of quadratic simplices of their
/// nodes (FinerScene), which for quadratic elements are of half the size:
/// the error of a response x of A(nu) = H + nu J to the loads (w) or to the
/// held displacements (v),
///
///   e = x_finer - x,   A_finer e = f - A_finer x,
///
/// by conjugate gradients, preconditioned in the hierarchical basis of the
/// functions of the elements, which those of the finer simplices hold, and
/// quadratic ones in the middle of the finer edges: by A, which is factorised
/// already, and by the 3 x 3 (2 x 2) blocks of the mid-edge nodes [Deuflhard,
/// Leinen & Yserentant, IMPACT Comput. Sci. Eng. 1 (1989) 3].  The iterations
/// do not grow with the mesh, but next to nu = 1/2.  The finer elements are
/// never assembled.  They begin with the error at the last nu, of the
/// size that leaves the least energy.
///
/// The functions have to be those of the elements themselves: were quadratic
/// ones replaced by linear ones of half the size, a bent or twisted e, of large
/// displacements and little energy, would be far from done where its energy is.
class HierarchicalError {
 public:
  /// Relative, in the energy norm of the error itself.
  static constexpr double kTolerance = 0.03;

  /// Preconditions and exceptions are those of QuadraticScene.  O(num_elements)
  /// time; memory as for eleven
  /// displacements of the finer mesh.
  explicit HierarchicalError(const Scene& scene);
  HierarchicalError(const HierarchicalError&) = delete;
  HierarchicalError& operator=(const HierarchicalError&) = delete;

  /// The error at the nodes of the responses to the load cases (the first
  /// columns of `responses`) and of that to the held displacements (the column
  /// behind them, if there is one), all at nu and num_dofs x n; empty where it
  /// takes too many iterations.
  /// Precondition: `solver` is of the mesh of the scene, and its last
  /// factorisation succeeded; the nearer to nu, the fewer iterations.
  /// Cost: for each of some 20 to 30 iterations (45 at nu = 0.45, 80 at 0.49),
  /// and half as many where one was found at a nu nearby, a pass of the finer
  /// elements and a solve for each response.
  std::optional<Eigen::MatrixXd> Find(double poisson_ratio,
                                      const Eigen::MatrixXd& responses,
                                      StiffnessSolver& solver);

  int NumPasses() const { return num_passes_; }

 private:
  /// Takes what is explained by the last error, which is scaled for that, from
  /// the residual of none, and returns its energies; zeros where there is none.
  Eigen::RowVectorXd BeginWithLast(double poisson_ratio,
                                   Eigen::MatrixXd& residual);
  /// A_finer x, zero in the held rows.
  Eigen::MatrixXd Multiply(double poisson_ratio, const Eigen::MatrixXd& x);
  Eigen::MatrixXd Precondition(const Eigen::MatrixXd& inverses,
                               const Eigen::MatrixXd& residual,
                               StiffnessSolver& solver) const;
  /// Inverts the blocks of A_finer of the mid-edge nodes, side by side.
  Eigen::MatrixXd InverseBlocks(double poisson_ratio) const;

  Scene finer_;
  FinerNodes nodes_;
  StiffnessOperator stiffness_;
  Eigen::VectorXd is_free_;  ///< 1 or 0 for each degree of freedom.
  Eigen::VectorXd held_;     ///< Displacement; zero where it is free.
  Eigen::MatrixXd force_;
  StiffnessProducts products_;
  /// What was found last; empty before.
  Eigen::MatrixXd error_;
  int num_passes_ = 0;
};

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_EQUILIBRIUM_HIERARCHICAL_ERROR_H_
