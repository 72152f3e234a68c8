#include "elastimate/petsc/start_petsc.h"

namespace {

// All tests are of programs that may use multigrid.
[[maybe_unused]] const bool may_start = [] {
  elastimate::StartPetscWhenNeeded();
  return true;
}();

}  // namespace
