#include "elastimate/core/mesh/middle_nodes.h"

#include <vector>

namespace elastimate {

MiddleNodes::MiddleNodes(const Mesh& mesh)
    : dimension_(mesh.Dimension()), num_vertices_(mesh.NumVertices()) {
  const ElementTopology& topology = mesh.Topology();
  // An element that has each node, and the place of the node in it.
  std::vector<Eigen::Index> element(mesh.NumNodes() - num_vertices_);
  std::vector<int> place(element.size());
  for (Eigen::Index e = 0; e < mesh.NumElements(); ++e) {
    for (int i = topology.num_vertices; i < mesh.elements.rows(); ++i) {
      const Eigen::Index node = mesh.elements(i, e) - num_vertices_;
      element[node] = e;
      place[node] = i - topology.num_vertices;
    }
  }
  for (std::size_t i = 0; i < element.size(); ++i) {
    vertices_.Add(mesh.elements(topology.middles[place[i]], element[i]).eval());
  }
}

Eigen::MatrixXd MiddleNodes::Restrict(const Eigen::MatrixXd& forces) const {
  Eigen::MatrixXd at_vertices = forces.topRows(dimension_ * num_vertices_);
  for (Eigen::Index i = 0; i < vertices_.Size(); ++i) {
    const auto vertices = vertices_[i];
    for (const int vertex : vertices) {
      at_vertices.middleRows(dimension_ * Eigen::Index(vertex), dimension_) +=
          forces.middleRows(dimension_ * (num_vertices_ + i), dimension_) /
          double(vertices.size());
    }
  }
  return at_vertices;
}

}  // namespace elastimate
