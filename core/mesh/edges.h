#ifndef ELASTIMATE_CORE_MESH_EDGES_H_
#define ELASTIMATE_CORE_MESH_EDGES_H_

#include <Eigen/Core>

#include "elastimate/core/mesh/mesh.h"
#include "elastimate/core/mesh/node_graph.h"

namespace elastimate {

/// The edges of a linear mesh of simplices: the pairs of different nodes of its
/// graph, in the same order.
class Edges {
 public:
  /// Precondition: a valid mesh of simplices.  O(num_elements).
  explicit Edges(const Mesh& mesh);

  Eigen::Index Size() const { return ends_.cols(); }
  /// 2 x num_edges nodes, the lower one first.
  const Eigen::Matrix2Xi& Ends() const { return ends_; }

  /// Returns the edge between two nodes, or -1 when there is none.  O(log of
  /// the number of edges of a node).
  Eigen::Index Find(int a, int b) const;

 private:
  NodeGraph graph_;
  Eigen::Matrix2Xi ends_;
};

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_MESH_EDGES_H_
