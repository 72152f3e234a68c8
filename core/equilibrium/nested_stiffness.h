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

/// Tells whether RefinedStiffness takes these scenes, from coarse to fine:
/// there are two or more, all elements have straight edges, those of the finer
/// scenes are quadratic, and the first nodes of each scene are
/// those of the one before, as FinerScene has them.  O(num_nodes).
[[nodiscard]] bool AreNested(const std::vector<const Scene*>& spaces);

/// The stiffness K(theta) of one specimen in some spaces that contain each
/// other, from coarse to fine, at the same moduli, as far as it does not depend
/// on supports.  It can be assembled from blocks, and multiplies columns.
class NestedStiffness {
 public:
  /// Refers to the scenes, which have to stay as they are.
  /// Precondition: one scene, or AreNested(spaces).
  explicit NestedStiffness(const std::vector<const Scene*>& spaces);
  NestedStiffness(const NestedStiffness&) = delete;
  NestedStiffness& operator=(const NestedStiffness&) = delete;

  /// Takes about ten element passes for each space but the coarsest.
  void SetModuli(const Eigen::VectorXd& moduli);

  std::size_t NumSpaces() const { return forces_.size(); }
  /// Returns the internal forces in a space.
  const InternalForces& Forces(std::size_t space) const {
    return forces_[space];
  }
  /// Returns the transfer between a space and the next finer one.
  const FinerNodes& NodesAfter(std::size_t space) const {
    return nodes_after_[space];
  }

  /// Returns InternalForces::Blocks of a space, whose graph is given.  One
  /// element pass.
  Eigen::MatrixXd Blocks(std::size_t space, const NodeGraph& graph) const {
    num_passes_ += space + 1 == NumSpaces() ? 1 : 0;
    return forces_[space].Blocks(moduli_, graph);
  }

  /// Returns K V in a space.  One element pass.
  Eigen::MatrixXd Multiply(std::size_t space,
                           const Eigen::MatrixXd& columns) const {
    return forces_[space].Multiply(moduli_, columns);
  }
  /// Returns the inverses of InternalForces::DiagonalBlocks of a finer space,
  /// until they are forgotten.
  const Eigen::MatrixXf& InverseBlocks(std::size_t space) const {
    return finer_[space - 1].inverse_blocks;
  }
  /// Gives back their memory, which only RefinedStiffness::Factorize needs.
  void ForgetInverseBlocks() {
    for (Finer& finer : finer_) {
      finer.inverse_blocks.resize(0, 0);
    }
  }
  /// Returns LargestEigenvalue of a finer space without supports.  Supports do
  /// not make the eigenvalues larger.
  double LargestEigenvalue(std::size_t space) const {
    return finer_[space - 1].largest_eigenvalue;
  }

  /// Element passes of the finest space that were made here.
  int NumPasses() const { return num_passes_; }

 private:
  struct Finer {
    Eigen::MatrixXf inverse_blocks;
    double largest_eigenvalue = 0;
  };

  std::deque<InternalForces> forces_;  ///< A deque does not move them.
  std::vector<FinerNodes> nodes_after_;
  Eigen::VectorXd moduli_;
  std::vector<Finer> finer_;
  mutable int num_passes_ = 0;
};

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_EQUILIBRIUM_NESTED_STIFFNESS_H_
