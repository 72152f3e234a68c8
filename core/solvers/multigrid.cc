#include "elastimate/core/solvers/multigrid.h"

#include <cassert>
#include <string>

#include "elastimate/core/package/dynamic_module.h"
#include "elastimate/core/solvers/petsc_multigrid.h"

namespace elastimate {
namespace {

struct Module {
  decltype(elastimate_make_multigrid)* make = nullptr;
  std::string why_not;

  Module() {
#ifdef ELASTIMATE_MULTIGRID_MODULE
    make = FindInModule<decltype(elastimate_make_multigrid)>(
        ELASTIMATE_MULTIGRID_MODULE, "elastimate_make_multigrid", why_not);
#else
    why_not = "it needs a build with PETSc";
#endif
  }
};

const Module& TheModule() {
  static const Module module;
  return module;
}

}  // namespace

const std::string& WhyNoMultigrid() { return TheModule().why_not; }

std::unique_ptr<LinearSolver> MakeMultigrid(
    const Mesh& mesh, const StiffnessAssembly& assembly,
    const DegreesOfFreedom& degrees_of_freedom) {
  assert(HasMultigrid());
  return std::unique_ptr<LinearSolver>(
      TheModule().make(mesh, assembly, degrees_of_freedom));
}

}  // namespace elastimate
