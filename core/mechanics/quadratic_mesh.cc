#include "elastimate/core/mechanics/quadratic_mesh.h"

#include <cassert>
#include <utility>

#include "elastimate/core/mesh/node_order.h"

namespace elastimate {
namespace {

// The records of so many nodes fit into the cache of a core.
constexpr Eigen::Index kNodesOfSmallestBlock = 8192;
// With fewer blocks, threads would wait for each other.
constexpr Eigen::Index kFewestBlocks = 4;

}  // namespace

QuadraticMesh::QuadraticMesh(const Mesh& mesh) : mesh_(mesh) {
  assert(HasQuadraticPass(mesh.kind));
  blocks_.blocks = {{0, mesh.NumElements(), {0, mesh.NumNodes()}}};
  blocks_.most_nodes = mesh.NumNodes();
}

QuadraticMesh QuadraticMesh::InBlocks(const Mesh& mesh) {
  QuadraticMesh quadratic(mesh);
  if (mesh.NumNodes() < kFewestBlocks * kNodesOfSmallestBlock) {
    return quadratic;
  }
  OrderedMesh ordered = OrderForLocality(mesh);
  quadratic.blocks_ = ChooseElementBlocks(
      ordered.mesh,
      kNodesOfSmallestBlock * mesh.NumElements() / mesh.NumNodes());
  quadratic.elements_ = std::move(ordered.mesh.elements);
  quadratic.positions_.setZero(mesh.Dimension(), mesh.NumNodes() + 1);
  quadratic.positions_.leftCols(mesh.NumNodes()) = ordered.mesh.nodes;
  quadratic.nodes_ = std::move(ordered.places);
  quadratic.element_of_mesh_ = std::move(ordered.element_places);
  return quadratic;
}

}  // namespace elastimate
