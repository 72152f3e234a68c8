#ifndef ELASTIMATE_CORE_SOLVERS_NODE_BLOCKS_H_
#define ELASTIMATE_CORE_SOLVERS_NODE_BLOCKS_H_

#include <Eigen/Core>
#include <vector>

#include "elastimate/core/mesh/node_graph.h"
#include "elastimate/core/scene/degrees_of_freedom.h"
#include "elastimate/core/solvers/block_matrix.h"

namespace elastimate {

/// The pattern of a stiffness matrix in square blocks, one for each pair of
/// coupled nodes.  Multigrid needs blocks of equal size, so each node with a
/// free component has rows for all its components.  The row of a held component
/// has only a diagonal entry, as large as the largest of its node.
class NodeBlocks {
 public:
  /// The i-th row of blocks belongs to node order[i]; without an order, rows
  /// follow the nodes.  Nodes without a free component are skipped.  The graph
  /// lists the pair of each node with itself first.  Refers to the first two
  /// arguments, which have to outlive this object.  Throws std::bad_alloc.
  NodeBlocks(const NodeGraph& graph, const DegreesOfFreedom& degrees_of_freedom,
             const std::vector<int>& order);

  int Dimension() const { return degrees_of_freedom_.dimension; }
  int NumBlocks() const { return int(start_.size()) - 1; }
  /// Returns the row of blocks of each node, -1 where it has no free component.
  const std::vector<int>& OfNodes() const { return of_node_; }
  /// Returns the row of the matrix for each free degree of freedom.
  std::vector<int> RowsOfFree() const;
  /// Returns the matrix of these values, which are in the order of a
  /// StiffnessAssembly, with its `rest`.  The columns of a row ascend by node;
  /// they ascend by number only if there is no order.
  [[nodiscard]] BlockMatrix MatrixOf(const Eigen::VectorXd& values) const;

 private:
  /// Calls visit(block, i, j, value) for each entry.  `block` is the place of
  /// its block in column_, and (i, j) is its place in the block.
  template <class Visitor>
  void VisitEntries(const Eigen::VectorXd& values, const Visitor& visit) const;
  /// Calls visit(a, b) for the rows of blocks of each pair of the graph.
  template <class Visitor>
  void VisitPairs(const Visitor& visit) const;
  bool IsFree(Eigen::Index node, int component) const {
    return degrees_of_freedom_.place[Dimension() * node + component] >= 0;
  }

  const NodeGraph& graph_;
  const DegreesOfFreedom& degrees_of_freedom_;
  std::vector<int> of_node_;
  std::vector<Eigen::Index> start_;
  std::vector<int> column_;
};

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_SOLVERS_NODE_BLOCKS_H_
