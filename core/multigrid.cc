#include "elastimate/core/multigrid.h"

#include <cassert>
#include <string>

#include "elastimate/core/module.h"

namespace elastimate {
namespace {

using Maker = LinearSolver* (*)(const Mesh&, const StiffnessAssembly&,
                                const DegreesOfFreedom&);

// Null when the module is not there.
Maker FindMaker() {
#ifdef ELASTIMATE_MULTIGRID_MODULE
  std::string why;
  return reinterpret_cast<Maker>(FindInModule(
      ELASTIMATE_MULTIGRID_MODULE, "elastimate_make_multigrid", why));
#else
  return nullptr;
#endif
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
