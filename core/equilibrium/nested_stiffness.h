#ifndef ELASTIMATE_CORE_EQUILIBRIUM_NESTED_STIFFNESS_H_
#define ELASTIMATE_CORE_EQUILIBRIUM_NESTED_STIFFNESS_H_

#include <Eigen/Core>
#include <deque>
#include <vector>

#include "elastimate/core/mechanics/internal_forces.h"
#include "elastimate/core/mesh/finer_nodes.h"
#include "elastimate/core/mesh/node_graph.h"
#include "elastimate/core/scene/scene.h"

namespace elastimate {

/// Whether scenes, from coarse to fine, are spaces that contain each other,
/// which RefinedStiffness takes: there are two or more of them, the elements
/// are simplices with straight edges, and each scene is FinerScene of the one
/// before.
bool AreNested(const std::vector<const Scene*>& spaces);

/// The stiffness K(theta) of one specimen in some spaces that contain each
/// other, from coarse to fine, at the same moduli: what it has whatever the
/// supports are.  The coarsest is there as blocks to be assembled, the finer
/// ones as products with columns.
class NestedStiffness {
 public:
  /// Refers to the scenes, which have to stay as they are.
  /// Precondition: one scene, or AreNested(spaces).
  explicit NestedStiffness(const std::vector<const Scene*>& spaces);
  NestedStiffness(const NestedStiffness&) = delete;
  NestedStiffness& operator=(const NestedStiffness&) = delete;

  /// `graph` is of the coarsest mesh.  One element pass, and for each finer
  /// space about ten.
  void SetModuli(const Eigen::VectorXd& moduli, const NodeGraph& graph);

  std::size_t NumSpaces() const { return forces_.size(); }
  /// In a space.
  const InternalForces& Forces(std::size_t space) const {
    return forces_[space];
  }
  /// Between a space and the next finer one.
  const FinerNodes& NodesAfter(std::size_t space) const {
    return nodes_after_[space];
  }

  /// InternalForces::Blocks of the coarsest space.
  const Eigen::MatrixXd& CoarsestBlocks() const { return blocks_; }

  /// K V in a space.  One element pass.
  Eigen::MatrixXd Multiply(std::size_t space,
                           const Eigen::MatrixXd& columns) const {
    return forces_[space].Multiply(moduli_, columns);
  }
  /// InternalForces::DiagonalBlocks of a finer space.
  const Eigen::MatrixXd& DiagonalBlocks(std::size_t space) const {
    return finer_[space - 1].diagonal_blocks;
  }
  /// The largest eigenvalue of D^-1 K for the diagonal blocks D of a finer
  /// space, or up to a tenth less, without supports; with any, the eigenvalues
  /// are not larger.
  /// NaN where K is not positive definite.
  double LargestEigenvalue(std::size_t space) const {
    return finer_[space - 1].largest_eigenvalue;
  }

  /// Element passes of the finest space that were made here.
  int NumPasses() const { return num_passes_; }

 private:
  struct Finer {
    Eigen::MatrixXd diagonal_blocks;
    double largest_eigenvalue = 0;
  };

  std::deque<InternalForces> forces_;  ///< Which do not move.
  std::vector<FinerNodes> nodes_after_;
  Eigen::VectorXd moduli_;
  Eigen::MatrixXd blocks_;
  std::vector<Finer> finer_;
  int num_passes_ = 0;
};

/// The inverse of each block of DiagonalBlocks, on its free components: zero in
/// the rows and columns of the others.  `is_free` is 1 or 0 for each degree of
/// freedom.  Side by side as the blocks are.
Eigen::MatrixXd InverseBlocks(const Eigen::MatrixXd& blocks,
                              const Eigen::VectorXd& is_free);

/// Blocks of DiagonalBlocks times the rows of their nodes: num_dofs x n.
Eigen::MatrixXd MultiplyBlocks(const Eigen::MatrixXd& blocks,
                               const Eigen::MatrixXd& columns);

/// x = keep x + scale B (a - b) for such blocks B, in one pass over memory.
void AddBlockProducts(const Eigen::MatrixXd& blocks, const Eigen::MatrixXd& a,
                      const Eigen::MatrixXd& b, double keep, double scale,
                      Eigen::MatrixXd& x);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_EQUILIBRIUM_NESTED_STIFFNESS_H_
