#ifndef ELASTIMATE_PETSC_PETSC_MODULE_H_
#define ELASTIMATE_PETSC_PETSC_MODULE_H_

#include <cstdlib>
#include <initializer_list>
#include <optional>

namespace elastimate {

/// Returns one of these variables of the environment as a number; empty where
/// none is set.
inline std::optional<int> NumberInEnvironment(
    std::initializer_list<const char*> names) {
  for (const char* const name : names) {
    if (const char* const value = std::getenv(name)) {
      return std::atoi(value);
    }
  }
  return std::nullopt;
}

/// Returns how many processes mpirun has started, as Open MPI and MPICH say;
/// empty where it has not started this one.
inline std::optional<int> NumStarted() {
  return NumberInEnvironment({"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"});
}

}  // namespace elastimate

/// StartPetscWhenNeeded looks this function up in the module.  It does nothing
/// where PETSc is running.  Where PETSc cannot be started, it is not running
/// afterwards.
extern "C" __attribute__((visibility("default"))) void elastimate_start_petsc();

#endif  // ELASTIMATE_PETSC_PETSC_MODULE_H_
