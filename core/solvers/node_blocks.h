#ifndef ELASTIMATE_CORE_SOLVERS_NODE_BLOCKS_H_
#define ELASTIMATE_CORE_SOLVERS_NODE_BLOCKS_H_

#include <Eigen/Core>
#include <algorithm>
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
  /// The blocks by their rows, compressed.  The columns of a row ascend by
  /// node, so by number only without an order.
  const std::vector<Eigen::Index>& Start() const { return start_; }
  const std::vector<int>& Columns() const { return column_; }

  /// Calls visit(block, i, j, value) for each entry.  `block` is the place of
  /// its block in Columns(), and (i, j) is its place in the block.  `values`
  /// are in the order of a StiffnessAssembly.
  template <class Visitor>
  void VisitEntries(const Eigen::VectorXd& values, const Visitor& visit) const;

  /// Returns the matrix of these values, with its `rest`.
  [[nodiscard]] BlockMatrix MatrixOf(const Eigen::VectorXd& values) const;

 private:
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

template <class Visitor>
void NodeBlocks::VisitEntries(const Eigen::VectorXd& values,
                              const Visitor& visit) const {
  std::vector<Eigen::Index> next(start_.begin(), start_.end() - 1);
  const double* value = values.data();
  for (Eigen::Index node = 0; node < Eigen::Index(of_node_.size()); ++node) {
    const int a = of_node_[node];
    if (a < 0) {
      continue;
    }
    const Eigen::Index diagonal = next[a];
    double scale = 0;
    for (int j = 0; j < Dimension(); ++j) {
      if (!IsFree(node, j)) {
        continue;
      }
      Eigen::Index own = diagonal;
      for (Eigen::Index k = graph_.start[node]; k < graph_.start[node + 1];
           ++k) {
        const int row = graph_.row[k];
        const int b = of_node_[row];
        if (b < 0) {
          continue;
        }
        for (int i = b == a ? j : 0; i < Dimension(); ++i) {
          if (!IsFree(row, i)) {
            continue;
          }
          visit(own, j, i, *value);
          if (b != a) {
            visit(next[b], i, j, *value);
          } else if (i != j) {
            visit(own, i, j, *value);
          } else {
            scale = std::max(scale, *value);
          }
          ++value;
        }
        ++own;
      }
    }
    for (int j = 0; j < Dimension(); ++j) {
      if (!IsFree(node, j)) {
        visit(diagonal, j, j, scale);
      }
    }
    for (Eigen::Index k = graph_.start[node]; k < graph_.start[node + 1]; ++k) {
      const int b = of_node_[graph_.row[k]];
      if (b >= 0 && b != a) {
        ++next[b];
      }
    }
  }
}

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_SOLVERS_NODE_BLOCKS_H_
