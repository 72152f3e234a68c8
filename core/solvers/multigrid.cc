#include "elastimate/core/solvers/multigrid.h"

#include <atomic>
#include <cassert>
#include <cstdlib>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "elastimate/core/mesh/node_order.h"
#include "elastimate/core/package/dynamic_module.h"
#include "elastimate/core/solvers/multigrid_solver.h"
#include "elastimate/core/solvers/node_blocks.h"
#include "elastimate/core/solvers/petsc_spaces.h"

namespace elastimate {
namespace {

std::atomic<void (*)()> start_of_petsc = nullptr;

struct Module {
  decltype(elastimate_find_multigrid_spaces)* find_spaces = nullptr;
  decltype(elastimate_is_petsc_running)* is_running = nullptr;
  const Ranks* (*ranks)() = nullptr;
  std::string why_not;

  Module() {
#ifdef ELASTIMATE_MULTIGRID_MODULE
    find_spaces = FindInModule<decltype(elastimate_find_multigrid_spaces)>(
        ELASTIMATE_MULTIGRID_MODULE, "elastimate_find_multigrid_spaces",
        why_not);
    if (find_spaces != nullptr) {
      is_running = FindInModule<decltype(elastimate_is_petsc_running)>(
          ELASTIMATE_MULTIGRID_MODULE, "elastimate_is_petsc_running", why_not);
      ranks = FindInModule<const Ranks*()>(ELASTIMATE_MULTIGRID_MODULE,
                                           "elastimate_ranks", why_not);
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

bool FindSpaces(MultigridRows& rows, MultigridSpaces& spaces) {
  return TheModule().find_spaces(rows, spaces);
}

// The ranks that share the solves.  It is null where one process solves alone.
const Ranks* ranks_of_solves = nullptr;

// While this is true, each of them solves alone (WorkApart).
bool are_apart = false;

const Ranks* RanksThatSolveTogether() {
  return are_apart ? nullptr : ranks_of_solves;
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
  NodeBlocks blocks(
      assembly.Graph(), degrees_of_freedom,
      HasLocality(mesh) ? std::vector<int>() : OrderForLocality(mesh).places);
  const Ranks* const ranks = RanksThatSolveTogether();
  return ranks == nullptr
             ? MakeMultigridOfOneRank(mesh, std::move(blocks), FindSpaces)
             : MakeMultigridOfRanks(mesh, std::move(blocks), FindSpaces,
                                    *ranks);
}

bool ShareSolves(const std::function<void()>& apart) {
  const Module& module = TheModule();
  const Ranks* const ranks = module.ranks == nullptr ? nullptr : module.ranks();
  if (ranks == nullptr) {
    return true;
  }
  ranks_of_solves = ranks;
  std::atexit(EndSharedSolves);
  if (ranks->Rank() > 0) {
    ServeSolves(FindSpaces, *ranks, [&apart] {
      are_apart = true;
      apart();
      are_apart = false;
    });
    ranks_of_solves = nullptr;
    return false;
  }
  return true;
}

void EndSharedSolves() {
  if (ranks_of_solves != nullptr) {
    EndService(*ranks_of_solves);
    ranks_of_solves = nullptr;
  }
}

int NumRanksOfSolves() {
  const Ranks* const ranks = RanksThatSolveTogether();
  return ranks == nullptr ? 1 : ranks->Size();
}

const Ranks* RanksOfSolves() { return ranks_of_solves; }

void WorkApart(const std::function<void()>& work) {
  if (are_apart) {
    return work();
  }
  are_apart = true;
  try {
    WorkApart(*ranks_of_solves, work);
  } catch (...) {
    are_apart = false;
    throw;
  }
  are_apart = false;
}

}  // namespace elastimate
