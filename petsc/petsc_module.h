#ifndef ELASTIMATE_PETSC_PETSC_MODULE_H_
#define ELASTIMATE_PETSC_PETSC_MODULE_H_

/// What StartPetscWhenNeeded looks up in the module.  Does nothing where PETSc
/// is running; it is not running afterwards where it cannot.
extern "C" __attribute__((visibility("default"))) void elastimate_start_petsc();

#endif  // ELASTIMATE_PETSC_PETSC_MODULE_H_
