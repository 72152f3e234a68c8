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
  /// Assembles the values.  Precondition: a valid mesh, which has to outlive
  /// this object.  O(num_elements) time and memory; it forms no triplets.
  StiffnessAssembly(const Mesh& mesh,
                    const DegreesOfFreedom& degrees_of_freedom);

  /// Returns, in the pattern, the values of a matrix whose blocks are given for
  /// each pair of the graph, side by side: dimension x (dimension num_pairs).
  Eigen::VectorXd ValuesOf(const Eigen::MatrixXd& blocks) const;

  const NodeGraph& Graph() const { return graph_; }
  /// Returns the pattern, which is made when it is first asked for.  Multigrid
  /// does not need it, and it takes as much memory as the values.
  const SymmetricPattern& Pattern() const;
  const Eigen::VectorXd& H() const { return h_; }
  const Eigen::VectorXd& J() const { return j_; }

  /// Returns the values of H + nu J.
  Eigen::VectorXd Combine(double poisson_ratio) const {
    Eigen::VectorXd values;
    Combine(poisson_ratio, values);
    return values;
  }
  /// Sets `values` to those of H + nu J.  Memory that is used again takes half
  /// the time.
  void Combine(double poisson_ratio, Eigen::VectorXd& values) const;

  /// Gives back the memory of H, J and the pattern.  Combine then takes an
  /// element pass.
  void ForgetBases();
  bool HasBases() const { return h_.size() > 0; }

 private:
  /// Calls visit(node, k, component, i) for each value, in order.  Its column
  /// is `component` of `node`, and its row is component i of the row node of
  /// pair k.
  template <class Visitor>
  void VisitValues(const Visitor& visit) const;
  /// Returns the values of a H + b J for the coefficients a, b.
  Eigen::VectorXd Assemble(const Eigen::Vector2d& coefficients) const;

  const Mesh& mesh_;
  NodeGraph graph_;
  mutable SymmetricPattern pattern_;
  Eigen::Index num_values_ = 0;
  int dimension_;
  /// The free components of each node, as bits.
  std::vector<unsigned char> free_components_;
  Eigen::VectorXd h_;
  Eigen::VectorXd j_;
};

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_MECHANICS_STIFFNESS_ASSEMBLY_H_
