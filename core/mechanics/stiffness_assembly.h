#ifndef ELASTIMATE_CORE_MECHANICS_STIFFNESS_ASSEMBLY_H_
#define ELASTIMATE_CORE_MECHANICS_STIFFNESS_ASSEMBLY_H_

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "elastimate/core/mesh/mesh.h"
#include "elastimate/core/mesh/node_graph.h"
#include "elastimate/core/scene/degrees_of_freedom.h"

namespace elastimate {

/// The pattern of the lower triangle of a sparse symmetric matrix, compressed
/// by columns, rows ascending.
struct SymmetricPattern {
  std::vector<std::int64_t> column_start;  ///< size + 1.
  std::vector<std::int64_t> row;           ///< num_values.

  std::int64_t Size() const {
    return static_cast<std::int64_t>(column_start.size()) - 1;
  }
};

/// The stiffness bases H and J of the free degrees of freedom, assembled into
/// one fixed sparse pattern, so that A(nu) = H + nu J is one axpy.
class StiffnessAssembly {
 public:
  /// Assembles the pattern and the values.  Precondition: a valid mesh.
  /// O(num_elements) time and memory; it forms no triplets.
  StiffnessAssembly(const Mesh& mesh,
                    const DegreesOfFreedom& degrees_of_freedom);

  /// Assembles the values of H and J again, for moved nodes of the same mesh.
  /// Cost: one element pass, in memory for the pairs of a front of nodes: 96
  /// byte for each (3 MB for a million tetrahedra of good numbering, 135 MB of
  /// a random one), so that most of it stays in the cache.
  void Assemble(const Mesh& mesh);

  /// Returns, in the pattern, the values of a matrix whose blocks are given for
  /// each pair of the graph, side by side: dimension x (dimension num_pairs).
  Eigen::VectorXd ValuesOf(const Eigen::MatrixXd& blocks) const;

  const NodeGraph& Graph() const { return graph_; }
  const SymmetricPattern& Pattern() const { return pattern_; }
  const Eigen::VectorXd& H() const { return h_; }
  const Eigen::VectorXd& J() const { return j_; }

  /// Returns the values of H + nu J.
  Eigen::VectorXd Combine(double poisson_ratio) const {
    return h_ + poisson_ratio * j_;
  }
  /// Sets `values` to those of H + nu J.  Memory that is used again takes half
  /// the time.
  void Combine(double poisson_ratio, Eigen::VectorXd& values) const {
    values = h_ + poisson_ratio * j_;
  }

 private:
  /// No element after the first `end_element` ones has any of the first
  /// `num_complete_nodes` nodes.
  struct Stage {
    Eigen::Index end_element;
    Eigen::Index num_complete_nodes;
  };

  void PlanStages(const Mesh& mesh);
  template <int kDimension>
  void AssembleOfDimension(const Mesh& mesh);
  /// Writes the values of the pairs of a node.
  template <int kDimension>
  void WriteColumns(Eigen::Index node, double shear_share);
  void BuildPattern(const DegreesOfFreedom& degrees_of_freedom);

  NodeGraph graph_;
  SymmetricPattern pattern_;
  /// The free components of each node, as bits.
  std::vector<unsigned char> free_components_;
  /// For each pair of nodes and each component of its column node, this says
  /// where the rows of its row node begin in the values; -1 when held.
  std::vector<std::int64_t> pair_values_;
  std::vector<Stage> stages_;
  /// The mask for AddGradientProducts, and the pairs at work, which are zero
  /// between assemblies.
  Eigen::Index pair_mask_;
  Eigen::MatrixXd products_;
  Eigen::VectorXd h_;
  Eigen::VectorXd j_;
};

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_MECHANICS_STIFFNESS_ASSEMBLY_H_
