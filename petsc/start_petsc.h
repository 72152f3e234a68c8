#ifndef ELASTIMATE_PETSC_START_PETSC_H_
#define ELASTIMATE_PETSC_START_PETSC_H_

namespace elastimate {

/// Has PETSc, and MPI for one process with it, started when multigrid is first
/// used, and ended when the program exits.  For a program that starts neither;
/// call it once, before there are other threads.  Without it, or a
/// PetscInitialize of the program's own, there is no multigrid
/// (WhyNoMultigrid).  It does nothing in a build without PETSc.
///
/// What that start does to the process: it forks one that tries whether MPI can
/// start, for MPI ends the process where it cannot (the stiffness is then
/// factorised); it sets OMPI_MCA_ess_singleton_isolated in the environment, as
/// one process needs no daemon to start others; and it takes no options of
/// PETSc from files or the environment, and no handlers of signals.
void StartPetscWhenNeeded();

}  // namespace elastimate

#endif  // ELASTIMATE_PETSC_START_PETSC_H_
