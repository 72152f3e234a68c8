#include "elastimate/petsc/start_petsc.h"

#include <functional>
#include <string>

#include "elastimate/core/package/dynamic_module.h"
#include "elastimate/core/solvers/multigrid.h"
#include "elastimate/petsc/petsc_module.h"

namespace elastimate {

#ifdef ELASTIMATE_PETSC_MODULE
namespace {

void Start() {
  std::string
      why_not;  // Code that needs multigrid finds that PETSc does not run.
  static auto* const start = FindInModule<decltype(elastimate_start_petsc)>(
      ELASTIMATE_PETSC_MODULE, "elastimate_start_petsc", why_not);
  if (start != nullptr) {
    start();
  }
}

}  // namespace
#endif

void StartPetscWhenNeeded() {
#ifdef ELASTIMATE_PETSC_MODULE
  SetStartOfPetsc(Start);
#endif
}

bool StartRanks([[maybe_unused]] const std::function<void()>& apart) {
  if (NumStarted().value_or(1) == 1) {
    return true;
  }
#ifdef ELASTIMATE_PETSC_MODULE
  Start();
  if (!ShareSolves(apart)) {
    return false;
  }
#endif
  return NumRanksOfSolves() > 1 ||
         NumberInEnvironment({"OMPI_COMM_WORLD_RANK", "PMI_RANK"}) == 0;
}

}  // namespace elastimate
