#ifndef ELASTIMATE_CORE_SOLVERS_MULTIGRID_SPACES_H_
#define ELASTIMATE_CORE_SOLVERS_MULTIGRID_SPACES_H_

#include <vector>

#include "elastimate/core/mesh/mesh.h"
#include "elastimate/core/scene/degrees_of_freedom.h"
#include "elastimate/core/solvers/block_matrix.h"

namespace elastimate {

/// A matrix in the spaces of a multigrid method, from coarse to fine.
struct MultigridSpaces {
  /// The last one has its `rest`.
  std::vector<BlockMatrix> matrices;
  /// From each space to the next finer one: one fewer than matrices.
  std::vector<BlockMatrix> interpolations;
  /// The row of the finest matrix for each free degree of freedom.  That matrix
  /// has all components of each node that has a free one; where a component is
  /// held, its row has only a diagonal entry.
  std::vector<int> row_of_free;
};

/// Orders the rows of the finest space so that nodes that share an element are
/// near each other in memory, where they are not (HasLocality).  Products with
/// matrices of meshes as Gmsh numbers them otherwise take 1.5 times as long.
/// Precondition: `spaces` are those of a stiffness matrix of the mesh.
void OrderFinest(const Mesh& mesh, const DegreesOfFreedom& degrees_of_freedom,
                 MultigridSpaces& spaces);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_SOLVERS_MULTIGRID_SPACES_H_
