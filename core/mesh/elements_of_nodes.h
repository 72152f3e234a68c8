#ifndef ELASTIMATE_CORE_MESH_ELEMENTS_OF_NODES_H_
#define ELASTIMATE_CORE_MESH_ELEMENTS_OF_NODES_H_

#include <Eigen/Core>
#include <vector>

#include "elastimate/core/mesh/mesh.h"

namespace elastimate {

/// The elements around each node: those of node n are
/// element[start[n]] .. element[start[n + 1] - 1].
struct ElementsOfNodes {
  std::vector<Eigen::Index> start;
  std::vector<Eigen::Index> element;

  explicit ElementsOfNodes(const Mesh& mesh)
      : start(mesh.NumNodes() + 1, 0), element(mesh.elements.size()) {
    for (const int node : mesh.elements.reshaped()) {
      ++start[node + 1];
    }
    for (Eigen::Index node = 0; node < mesh.NumNodes(); ++node) {
      start[node + 1] += start[node];
    }
    std::vector<Eigen::Index> next(start.begin(), start.end() - 1);
    for (Eigen::Index e = 0; e < mesh.NumElements(); ++e) {
      for (const int node : mesh.elements.col(e)) {
        element[next[node]++] = e;
      }
    }
  }
};

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_MESH_ELEMENTS_OF_NODES_H_
