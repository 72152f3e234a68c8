#include "elastimate/core/equilibrium/nested_stiffness.h"

#include "elastimate/core/solvers/v_cycle.h"

namespace elastimate {
namespace {

bool BeginsWithNodesOf(const Mesh& coarse, const Mesh& fine) {
  return coarse.Dimension() == fine.Dimension() &&
         coarse.NumNodes() < fine.NumNodes() &&
         fine.NumElements() % coarse.NumElements() == 0 &&
         fine.nodes.leftCols(coarse.NumNodes()) == coarse.nodes;
}

}  // namespace

bool AreNested(const std::vector<const Scene*>& spaces) {
  if (spaces.size() < 2) {
    return false;
  }
  for (std::size_t i = 0; i < spaces.size(); ++i) {
    const Mesh& mesh = spaces[i]->mesh;
    if (IsCurved(mesh.kind) || (i > 0 && mesh.Order() != 2)) {
      return false;
    }
    if (i > 0 && !BeginsWithNodesOf(spaces[i - 1]->mesh, mesh)) {
      return false;
    }
  }
  return true;
}

NestedStiffness::NestedStiffness(const std::vector<const Scene*>& spaces)
    : finer_(spaces.size() - 1) {
  for (std::size_t i = 0; i < spaces.size(); ++i) {
    forces_.emplace_back(spaces[i]->mesh, spaces[i]->materials);
    if (i > 0) {
      nodes_after_.emplace_back(spaces[i - 1]->mesh, spaces[i]->mesh);
    }
  }
}

void NestedStiffness::SetModuli(const Eigen::VectorXd& moduli) {
  moduli_ = moduli;
  for (std::size_t space = 1; space < NumSpaces(); ++space) {
    Finer& finer = finer_[space - 1];
    finer.inverse_blocks =
        elastimate::InverseBlocks(forces_[space].DiagonalBlocks(moduli));
    int num_products = 0;
    finer.largest_eigenvalue = elastimate::LargestEigenvalue(
        [&](const Eigen::MatrixXd& x) { return Multiply(space, x); },
        finer.inverse_blocks, num_products);
    if (space + 1 == NumSpaces()) {
      num_passes_ += num_products;
    }
  }
}

}  // namespace elastimate
