#ifndef ELASTIMATE_CORE_EQUILIBRIUM_HIERARCHICAL_ERROR_H_
#define ELASTIMATE_CORE_EQUILIBRIUM_HIERARCHICAL_ERROR_H_

#include <Eigen/Core>
#include <optional>

#include "elastimate/core/mechanics/stiffness_product.h"
#include "elastimate/core/mesh/finer_nodes.h"
#include "elastimate/core/scene/scene.h"
#include "elastimate/core/solvers/stiffness_solver.h"

namespace elastimate {

/// Finds by how much the displacements of a scene differ from those on
/// quadratic simplices of the same nodes (FinerScene).  For quadratic elements,
/// the finer ones have half the size.  A response x of A(nu) = H + nu J to the
/// loads (w) or to the held displacements (v) has the error
///
///   e = x_finer - x,   A_finer e = f - A_finer x.
///
/// Conjugate gradients solve for e.  They are preconditioned in the
/// hierarchical basis, which has the functions of the elements (the finer
/// simplices hold these) and the quadratic functions in the middle of the finer
/// edges.  On the first part the preconditioner is A, which is factorised
/// already; on the second it is the 3 x 3 (2 x 2) blocks of the mid-edge nodes
/// [Deuflhard, Leinen & Yserentant, IMPACT Comput. Sci. Eng. 1 (1989) 3].  The
/// number of iterations does not grow with the mesh, but it grows next to nu =
/// 1/2.  The finer elements are never assembled.  Iterations begin with the
/// error at the last nu, scaled to leave the least energy.
///
/// The basis has to hold the functions of the elements themselves.  If linear
/// functions of half the size replaced quadratic ones, an error e that bends or
/// twists, with large displacements and little energy, would be far from done
/// when its energy is.
class HierarchicalError {
 public:
  /// The relative error of e in the energy norm.
  static constexpr double kTolerance = 0.03;

  /// Preconditions and exceptions are those of QuadraticScene.  O(num_elements)
  /// time, and memory for eleven displacements of the finer mesh.
  explicit HierarchicalError(const Scene& scene);
  HierarchicalError(const HierarchicalError&) = delete;
  HierarchicalError& operator=(const HierarchicalError&) = delete;

  /// Returns the error, at the nodes of the scene, of the responses to the load
  /// cases (the first columns of `responses`) and to the held displacements
  /// (the last column, if there is one), num_dofs x n, all at nu.  Empty where
  /// it takes too many iterations.
  /// Precondition: `solver` is of the mesh of the scene, and its last
  /// factorisation succeeded.  The nearer its nu is to `poisson_ratio`, the
  /// fewer iterations it takes.
  /// Cost: a pass of the finer elements and a solve for each response in each
  /// of some 20 to 30 iterations (45 at nu = 0.45, 80 at 0.49), or in half as
  /// many where an error was found at a nu nearby.
  std::optional<Eigen::MatrixXd> Find(double poisson_ratio,
                                      const Eigen::MatrixXd& responses,
                                      StiffnessSolver& solver);

  int NumPasses() const { return num_passes_; }

 private:
  /// Scales the last error to leave the least energy, subtracts from the
  /// residual what it explains, and returns the energies explained; zeros where
  /// there is no last error.
  Eigen::RowVectorXd BeginWithLast(double poisson_ratio,
                                   Eigen::MatrixXd& residual);
  /// Returns A_finer x, with zeros in the held rows.
  Eigen::MatrixXd Multiply(double poisson_ratio, const Eigen::MatrixXd& x);
  Eigen::MatrixXd Precondition(const Eigen::MatrixXd& inverses,
                               const Eigen::MatrixXd& residual,
                               StiffnessSolver& solver) const;
  /// Returns the inverses of the diagonal blocks of A_finer at the mid-edge
  /// nodes, side by side.
  Eigen::MatrixXd InverseBlocks(double poisson_ratio) const;

  Scene finer_;
  FinerNodes nodes_;
  StiffnessOperator stiffness_;
  Eigen::VectorXd is_free_;  ///< 1 or 0 for each degree of freedom.
  Eigen::VectorXd held_;     ///< Given displacements; zero where free.
  Eigen::MatrixXd force_;
  StiffnessProducts products_;
  /// The error that was found last; empty before the first.
  Eigen::MatrixXd error_;
  int num_passes_ = 0;
};

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_EQUILIBRIUM_HIERARCHICAL_ERROR_H_
