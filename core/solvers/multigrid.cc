#include "elastimate/core/solvers/multigrid.h"

#include <atomic>
#include <cassert>
#include <string>

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
  return std::make_unique<AlgebraicMultigrid>(
      [&](const Eigen::VectorXd& values, MultigridSpaces& spaces) {
        if (!TheModule().find_spaces(mesh, assembly, degrees_of_freedom, values,
                                     spaces)) {
          return false;
        }
        OrderFinest(mesh, degrees_of_freedom, spaces);
        return true;
      });
}

}  // namespace elastimate
