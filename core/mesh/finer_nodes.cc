#include "elastimate/core/mesh/finer_nodes.h"

#include <algorithm>
#include <vector>

#include "elastimate/core/mesh/mesh_points.h"
#include "elastimate/core/mesh/shape_functions.h"

namespace elastimate {
namespace {

using Entries = std::vector<Eigen::Triplet<double, Eigen::Index>>;

// Of the nodes of an element in the middle between two of them.
void AddWeights(const Mesh& mesh, Eigen::Index element, int a, int b,
                Eigen::Index row, Entries& weights) {
  if (mesh.Order() == 1) {
    weights.emplace_back(row, a, 0.5);
    weights.emplace_back(row, b, 0.5);
    return;
  }
  const auto nodes = mesh.elements.col(element);
  const Eigen::MatrixXd reference = ReferenceNodes(mesh.kind);
  const auto reference_of = [&](int node) {
    return reference.col(std::find(nodes.begin(), nodes.end(), node) -
                         nodes.begin());
  };
  const Eigen::VectorXd values =
      ShapeFunctionsOf(mesh, {Eigen::VectorXi::Constant(1, int(element)),
                              0.5 * (reference_of(a) + reference_of(b))});
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    if (values(i) != 0) {
      weights.emplace_back(row, nodes(i), values(i));
    }
  }
}

}  // namespace

FinerNodes::FinerNodes(const Mesh& mesh, const Mesh& finer)
    : dimension_(mesh.Dimension()),
      weights_(finer.NumNodes() - mesh.NumNodes(), mesh.NumNodes()) {
  const ElementTopology& topology = finer.Topology();
  const Eigen::Index num_cuts = finer.NumElements() / mesh.NumElements();
  std::vector<bool> is_known(std::size_t(weights_.rows()), false);
  Entries weights;
  for (Eigen::Index e = 0; e < finer.NumElements(); ++e) {
    for (int i = topology.num_vertices; i < topology.num_nodes; ++i) {
      const Eigen::Index row = finer.elements(i, e) - mesh.NumNodes();
      if (!is_known[row]) {
        is_known[row] = true;
        const auto& [a, b] = topology.edges[i - topology.num_vertices];
        AddWeights(mesh, e / num_cuts, finer.elements(a, e),
                   finer.elements(b, e), row, weights);
      }
    }
  }
  weights_.setFromTriplets(weights.begin(), weights.end());
}

// By rows rather than as products of matrices, which Eigen spreads over threads
// that wait for each other longer than they work.

Eigen::MatrixXd FinerNodes::Interpolate(const Eigen::MatrixXd& at_nodes) const {
  Eigen::MatrixXd all(dimension_ * (NumNodes() + NumMidEdges()),
                      at_nodes.cols());
  all << at_nodes,
      Eigen::MatrixXd::Zero(dimension_ * NumMidEdges(), at_nodes.cols());
  for (Eigen::Index row = 0; row < NumMidEdges(); ++row) {
    auto of_row = all.middleRows(dimension_ * (NumNodes() + row), dimension_);
    for (Weights::InnerIterator weight(weights_, row); weight; ++weight) {
      of_row += weight.value() *
                at_nodes.middleRows(dimension_ * weight.col(), dimension_);
    }
  }
  return all;
}

Eigen::MatrixXd FinerNodes::Restrict(const Eigen::MatrixXd& forces) const {
  Eigen::MatrixXd on_nodes = forces.topRows(dimension_ * NumNodes());
  for (Eigen::Index row = 0; row < NumMidEdges(); ++row) {
    const auto of_row =
        forces.middleRows(dimension_ * (NumNodes() + row), dimension_);
    for (Weights::InnerIterator weight(weights_, row); weight; ++weight) {
      on_nodes.middleRows(dimension_ * weight.col(), dimension_) +=
          weight.value() * of_row;
    }
  }
  return on_nodes;
}

}  // namespace elastimate
