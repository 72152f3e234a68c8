#include "elastimate/core/mesh/mid_edges.h"

namespace elastimate {

MidEdges::MidEdges(const Mesh& mesh)
    : dimension_(mesh.Dimension()),
      num_vertices_(mesh.NumVertices()),
      ends_(2, mesh.NumNodes() - num_vertices_) {
  const ElementTopology& topology = mesh.Topology();
  for (Eigen::Index e = 0; e < mesh.NumElements(); ++e) {
    for (Eigen::Index i = topology.num_vertices; i < mesh.elements.rows();
         ++i) {
      const auto& edge = topology.edges[i - topology.num_vertices];
      ends_.col(mesh.elements(i, e) - num_vertices_)
          << mesh.elements(edge[0], e),
          mesh.elements(edge[1], e);
    }
  }
}

Eigen::MatrixXd MidEdges::Restrict(const Eigen::MatrixXd& forces) const {
  Eigen::MatrixXd at_vertices = forces.topRows(dimension_ * num_vertices_);
  for (Eigen::Index i = 0; i < ends_.cols(); ++i) {
    for (const int end : {0, 1}) {
      at_vertices.middleRows(dimension_ * Eigen::Index(ends_(end, i)),
                             dimension_) +=
          0.5 * forces.middleRows(dimension_ * (num_vertices_ + i), dimension_);
    }
  }
  return at_vertices;
}

}  // namespace elastimate
