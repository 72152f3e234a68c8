#include "elastimate/petsc/start_petsc.h"

#include <string>

#include "elastimate/core/package/dynamic_module.h"
#include "elastimate/core/solvers/multigrid.h"
#include "elastimate/petsc/petsc_module.h"

namespace elastimate {

void StartPetscWhenNeeded() {
#ifdef ELASTIMATE_PETSC_MODULE
  SetStartOfPetsc([] {
    std::string why_not;  // What wants multigrid finds that it has not started.
    static auto* const start = FindInModule<decltype(elastimate_start_petsc)>(
        ELASTIMATE_PETSC_MODULE, "elastimate_start_petsc", why_not);
    if (start != nullptr) {
      start();
    }
  });
#endif
}

}  // namespace elastimate
