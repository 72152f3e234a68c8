#include "elastimate/core/mechanics/quadratic_mesh.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include "elastimate/core/mesh/node_order.h"

namespace elastimate {
namespace {

// A thread works on the records of so many nodes in the cache of its core.
// Blocks of wide bodies are larger, as they reach over some fronts of nodes.
constexpr Eigen::Index kLeastNodesOfBlock = 8192;
// A mesh of fewer nodes than this many smallest blocks is not worth dividing.
constexpr Eigen::Index kFewestBlocks = 4;

}  // namespace

QuadraticMesh::QuadraticMesh(const Mesh& mesh) : mesh_(mesh) {
  assert(HasQuadraticPass(mesh.kind));
  blocks_.blocks = {{0, mesh.NumElements(), {0, mesh.NumNodes()}}};
  blocks_.most_nodes = mesh.NumNodes();
}

QuadraticMesh QuadraticMesh::InBlocks(const Mesh& mesh) {
  QuadraticMesh quadratic(mesh);
  if (mesh.NumNodes() < kFewestBlocks * kLeastNodesOfBlock) {
    return quadratic;
  }
  OrderedMesh ordered = OrderForLocality(mesh);
  ElementBlocks blocks = ChooseElementBlocks(
      ordered.mesh,
      std::max<Eigen::Index>(
          1, kLeastNodesOfBlock * mesh.NumElements() / mesh.NumNodes()));
  if (blocks.blocks.size() == 1) {
    return quadratic;
  }
  quadratic.blocks_ = std::move(blocks);
  quadratic.elements_ = std::move(ordered.mesh.elements);
  quadratic.positions_.setZero(mesh.Dimension(), mesh.NumNodes() + 1);
  quadratic.positions_.leftCols(mesh.NumNodes()) = ordered.mesh.nodes;
  quadratic.node_of_mesh_ = std::move(ordered.places);
  quadratic.element_of_mesh_ = std::move(ordered.element_places);
  return quadratic;
}

}  // namespace elastimate
