#ifndef ELASTIMATE_PETSC_START_PETSC_H_
#define ELASTIMATE_PETSC_START_PETSC_H_

#include <functional>

namespace elastimate {

/// Has PETSc, and with it MPI for one process, started when multigrid is first
/// used, and ended when the program exits.  It is meant for a program that
/// starts neither, which has to call it once, before there are other threads.
/// Without this call or a PetscInitialize of the program's own, there is no
/// multigrid (WhyNoMultigrid).  It does nothing in a build without PETSc.
///
/// The start affects the process in three ways.  It forks a process that tries
/// whether MPI can start, because MPI ends the process where it cannot; the
/// stiffness is then factorised.  It sets OMPI_MCA_ess_singleton_isolated in
/// the environment, as one process needs no daemon to start others.  It takes
/// no options of PETSc from files or the environment, and installs no handlers
/// of signals.
void StartPetscWhenNeeded();

/// Where mpirun has started the program as several processes, starts PETSc in
/// all of them and divides solves among them (ShareSolves): on rank 0 it
/// returns true, and on the others false once rank 0 has ended.  They then have
/// nothing left to do.  Without PETSc they have nothing to do at once.
/// Elsewhere it returns true and starts nothing.  The program must have called
/// StartPetscWhenNeeded.  `apart` is that of ShareSolves.
[[nodiscard]] bool StartRanks(const std::function<void()>& apart = [] {});

}  // namespace elastimate

#endif  // ELASTIMATE_PETSC_START_PETSC_H_
