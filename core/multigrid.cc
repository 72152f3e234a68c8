#include "elastimate/core/multigrid.h"

#include <dlfcn.h>

#include <cassert>

namespace elastimate {
namespace {

using Maker = LinearSolver* (*)(const Mesh&, const StiffnessAssembly&,
                                const DegreesOfFreedom&);

// Null when the module is not there.
Maker FindMaker() {
#ifdef ELASTIMATE_MULTIGRID_MODULE
  // Beside the program, then where it was to be installed.
  for (const char* const module :
       {ELASTIMATE_MULTIGRID_MODULE,
        ELASTIMATE_INSTALLED_LIBRARIES "/" ELASTIMATE_MULTIGRID_MODULE}) {
    void* const library = dlopen(module, RTLD_LAZY | RTLD_LOCAL);
    if (library != nullptr) {
      return reinterpret_cast<Maker>(
          dlsym(library, "elastimate_make_multigrid"));
    }
  }
#endif
  return nullptr;
}

Maker TheMaker() {
  static const Maker maker = FindMaker();
  return maker;
}

}  // namespace

bool HasMultigrid() { return TheMaker() != nullptr; }

std::unique_ptr<LinearSolver> MakeMultigrid(
    const Mesh& mesh, const StiffnessAssembly& assembly,
    const DegreesOfFreedom& degrees_of_freedom) {
  assert(HasMultigrid());
  return std::unique_ptr<LinearSolver>(
      TheMaker()(mesh, assembly, degrees_of_freedom));
}

}  // namespace elastimate
