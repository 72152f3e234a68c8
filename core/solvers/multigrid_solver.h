#ifndef ELASTIMATE_CORE_SOLVERS_MULTIGRID_SOLVER_H_
#define ELASTIMATE_CORE_SOLVERS_MULTIGRID_SOLVER_H_

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "elastimate/core/mesh/mesh.h"
#include "elastimate/core/parallel/ranks.h"
#include "elastimate/core/solvers/algebraic_multigrid.h"
#include "elastimate/core/solvers/linear_solver.h"
#include "elastimate/core/solvers/node_blocks.h"

namespace elastimate {

/// Makes the AlgebraicMultigrid of a mesh on this rank alone.  The mesh is not
/// needed afterwards.
[[nodiscard]] std::unique_ptr<LinearSolver> MakeMultigridOfOneRank(
    const Mesh& mesh, NodeBlocks blocks,
    AlgebraicMultigrid::FindSpaces find_spaces);

/// Makes one on rank 0 whose rows all ranks share, while each of the others is
/// in ServeSolves.  Rank 0 sends each its rows of matrices and right-hand sides
/// and takes their rows of the solution.  A mesh with fewer nodes than there
/// are ranks stays on rank 0.
[[nodiscard]] std::unique_ptr<LinearSolver> MakeMultigridOfRanks(
    const Mesh& mesh, NodeBlocks blocks,
    AlgebraicMultigrid::FindSpaces find_spaces, const Ranks& ranks);

/// Serves rank 0 until it calls EndService.  Each other rank calls it, and
/// calls `apart` where rank 0 calls WorkApart.
void ServeSolves(const AlgebraicMultigrid::FindSpaces& find_spaces,
                 const Ranks& ranks, const std::function<void()>& apart);
/// Does `work` on rank 0 while each of the others does what it gave
/// ServeSolves.  Meanwhile no rank may use a solver that several ranks share.
void WorkApart(const Ranks& ranks, const std::function<void()>& work);
/// Lets the other ranks return from ServeSolves.  Each rank calls it before it
/// exits: within a step that all take together, it ends all of them.
void EndService(const Ranks& ranks);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_SOLVERS_MULTIGRID_SOLVER_H_
