#include "elastimate/core/solvers/multigrid.h"

#include <atomic>
#include <cassert>
#include <string>
#include <vector>

#include "elastimate/core/mesh/node_order.h"
#include "elastimate/core/package/dynamic_module.h"
#include "elastimate/core/solvers/algebraic_multigrid.h"
#include "elastimate/core/solvers/petsc_spaces.h"

namespace elastimate {
namespace {

std::atomic<void (*)()> start_of_petsc = nullptr;

struct Module {
  decltype(elastimate_find_multigrid_spaces)* find_spaces = nullptr;
  decltype(elastimate_is_petsc_running)* is_running = nullptr;
  std::string why_not;

  Module() {
#ifdef ELASTIMATE_MULTIGRID_MODULE
    find_spaces = FindInModule<decltype(elastimate_find_multigrid_spaces)>(
        ELASTIMATE_MULTIGRID_MODULE, "elastimate_find_multigrid_spaces",
        why_not);
    if (find_spaces != nullptr) {
      is_running = FindInModule<decltype(elastimate_is_petsc_running)>(
          ELASTIMATE_MULTIGRID_MODULE, "elastimate_is_petsc_running", why_not);
    }
#else
    why_not = "the program was built without PETSc";
#endif
  }
};

const Module& TheModule() {
  static const Module module;
  return module;
}

// Returns the rows of blocks in this order of the nodes.
std::vector<int> RowsIn(const std::vector<int>& order,
                        const NodeBlocks& blocks) {
  std::vector<int> rows;
  for (const int node : order) {
    if (blocks.OfNodes()[node] >= 0) {
      rows.push_back(blocks.OfNodes()[node]);
    }
  }
  return rows;
}

}  // namespace

void SetStartOfPetsc(void (*start)()) { start_of_petsc = start; }

std::string WhyNoMultigrid() {
  const Module& module = TheModule();
  if (!module.why_not.empty()) {
    return module.why_not;
  }
  return start_of_petsc != nullptr || module.is_running()
             ? ""
             : "the program has not started PETSc";
}

std::unique_ptr<LinearSolver> MakeMultigrid(
    const Mesh& mesh, const StiffnessAssembly& assembly,
    const DegreesOfFreedom& degrees_of_freedom) {
  assert(HasMultigrid());
  if (void (*const start)() = start_of_petsc) {
    start();
  }
  // In Gmsh's numbering, products would take 1.5 times as long.
  const std::vector<int> order =
      HasLocality(mesh) ? std::vector<int>() : OrderForLocality(mesh).places;
  return std::make_unique<AlgebraicMultigrid>(
      NodeBlocks(assembly.Graph(), degrees_of_freedom, order),
      [&, order](const Eigen::VectorXd& values, MultigridSpaces& spaces) {
        // PETSc needs ascending columns, so it gets blocks in the order of the
        // nodes.
        const NodeBlocks blocks(assembly.Graph(), degrees_of_freedom, {});
        if (!TheModule().find_spaces(mesh, blocks, values, spaces)) {
          return false;
        }
        if (!order.empty() && !spaces.interpolations.empty()) {
          spaces.interpolations.back() =
              Ordered(spaces.interpolations.back(), RowsIn(order, blocks), {});
        }
        return true;
      });
}

}  // namespace elastimate
