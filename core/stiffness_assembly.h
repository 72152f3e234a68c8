#ifndef ELASTIMATE_CORE_STIFFNESS_ASSEMBLY_H_
#define ELASTIMATE_CORE_STIFFNESS_ASSEMBLY_H_

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "elastimate/core/degrees_of_freedom.h"
#include "elastimate/core/mesh.h"
#include "elastimate/core/node_graph.h"

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
  /// Pattern and values.  Precondition: a valid mesh.
  /// O(num_elements) time and memory; no triplets.
  StiffnessAssembly(const Mesh& mesh,
                    const DegreesOfFreedom& degrees_of_freedom);

  /// Assembles the values of H and J again, for moved nodes of the same mesh.
  /// Cost: one element pass.  Keeps 72 byte for each pair of nodes (100 MB for
  /// a million tetrahedra), so that no new memory has to be mapped.
  void Assemble(const Mesh& mesh);

  const NodeGraph& Graph() const { return graph_; }
  const SymmetricPattern& Pattern() const { return pattern_; }
  const Eigen::VectorXd& H() const { return h_; }
  const Eigen::VectorXd& J() const { return j_; }

  /// The values of H + nu J.
  Eigen::VectorXd Combine(double poisson_ratio) const {
    return h_ + poisson_ratio * j_;
  }
  /// The same into memory that is used again, which takes half the time.
  void Combine(double poisson_ratio, Eigen::VectorXd& values) const {
    values = h_ + poisson_ratio * j_;
  }

 private:
  void BuildPattern(const DegreesOfFreedom& degrees_of_freedom);

  NodeGraph graph_;
  SymmetricPattern pattern_;
  /// Free components of each node, as bits.
  std::vector<unsigned char> free_components_;
  /// For each pair of nodes and each of the three components of its column
  /// node: where the rows of its row node begin in the values, -1 when held.
  std::vector<std::int64_t> pair_values_;
  /// Memory for GradientProducts, empty until values are assembled again.
  Eigen::Matrix3Xd products_;
  Eigen::VectorXd h_;
  Eigen::VectorXd j_;
};

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_STIFFNESS_ASSEMBLY_H_
