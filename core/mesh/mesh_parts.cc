#include "elastimate/core/mesh/mesh_parts.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace elastimate {

Eigen::MatrixXd MeshParts::Gather(const Eigen::MatrixXd& whole) const {
  const Eigen::Index dimension = mesh.Dimension();
  Eigen::MatrixXd gathered(mesh.NumDofs(), whole.cols());
  for (Eigen::Index column = 0; column < whole.cols(); ++column) {
    for (std::size_t copy = 0; copy < node.size(); ++copy) {
      gathered.col(column).segment(dimension * Eigen::Index(copy), dimension) =
          whole.col(column).segment(dimension * Eigen::Index(node[copy]),
                                    dimension);
    }
  }
  return gathered;
}

MeshParts SplitMesh(const Mesh& mesh, const std::vector<int>& part_of_element) {
  using NodeAndPart = std::pair<int, int>;
  // The nodes are visited in ascending order, so that copies of vertices stay
  // before those of other nodes.
  std::vector<NodeAndPart> copies;
  copies.reserve(mesh.elements.size());
  for (Eigen::Index e = 0; e < mesh.NumElements(); ++e) {
    for (const int node : mesh.elements.col(e)) {
      copies.emplace_back(node, part_of_element[e]);
    }
  }
  std::sort(copies.begin(), copies.end());
  copies.erase(std::unique(copies.begin(), copies.end()), copies.end());

  MeshParts parts;
  parts.mesh.kind = mesh.kind;
  parts.mesh.section = mesh.section;
  parts.mesh.elements.resizeLike(mesh.elements);
  parts.mesh.nodes.resize(mesh.Dimension(), Eigen::Index(copies.size()));
  std::vector<Eigen::Index> first_copy(mesh.NumNodes(), -1);
  for (const auto& [node, part] : copies) {
    const Eigen::Index copy = Eigen::Index(parts.node.size());
    if (first_copy[node] < 0) {
      first_copy[node] = copy;
    }
    parts.mesh.nodes.col(copy) = mesh.nodes.col(node);
    parts.node.push_back(node);
    parts.part.push_back(part);
  }
  for (Eigen::Index e = 0; e < mesh.NumElements(); ++e) {
    for (Eigen::Index i = 0; i < mesh.elements.rows(); ++i) {
      Eigen::Index copy = first_copy[mesh.elements(i, e)];
      while (parts.part[copy] != part_of_element[e]) {
        ++copy;
      }
      parts.mesh.elements(i, e) = static_cast<int>(copy);
    }
  }
  return parts;
}

MeshParts SplitIntoElements(const Mesh& mesh) {
  std::vector<int> part(std::size_t(mesh.NumElements()));
  std::iota(part.begin(), part.end(), 0);
  return SplitMesh(mesh, part);
}

}  // namespace elastimate
