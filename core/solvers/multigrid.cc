#include "elastimate/core/solvers/multigrid.h"

#include <atomic>
#include <cassert>
#include <string>

#include "elastimate/core/package/dynamic_module.h"
#include "elastimate/core/solvers/petsc_multigrid.h"

namespace elastimate {
namespace {

std::atomic<void (*)()> start_of_petsc = nullptr;

struct Module {
  decltype(elastimate_make_multigrid)* make = nullptr;
  decltype(elastimate_is_petsc_running)* is_running = nullptr;
  std::string why_not;

  Module() {
#ifdef ELASTIMATE_MULTIGRID_MODULE
    make = FindInModule<decltype(elastimate_make_multigrid)>(
        ELASTIMATE_MULTIGRID_MODULE, "elastimate_make_multigrid", why_not);
    if (make != nullptr) {
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
  return std::unique_ptr<LinearSolver>(
      TheModule().make(mesh, assembly, degrees_of_freedom));
}

}  // namespace elastimate
