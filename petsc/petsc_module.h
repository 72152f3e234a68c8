#ifndef ELASTIMATE_PETSC_PETSC_MODULE_H_
#define ELASTIMATE_PETSC_PETSC_MODULE_H_

/// StartPetscWhenNeeded looks this function up in the module.  It does nothing
/// where PETSc is running.  Where PETSc cannot be started, it is not running
/// afterwards.
extern "C" __attribute__((visibility("default"))) void elastimate_start_petsc();

#endif  // ELASTIMATE_PETSC_PETSC_MODULE_H_
