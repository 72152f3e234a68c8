#ifndef ELASTIMATE_CORE_SOLVERS_MULTIGRID_H_
#define ELASTIMATE_CORE_SOLVERS_MULTIGRID_H_

#include <memory>
#include <string>

#include "elastimate/core/mechanics/stiffness_assembly.h"
#include "elastimate/core/mesh/mesh.h"
#include "elastimate/core/scene/degrees_of_freedom.h"
#include "elastimate/core/solvers/linear_solver.h"

namespace elastimate {

/// Has this function start PETSc for the process when multigrid is first made:
/// to start it is the program's affair, for it starts MPI, which there is once
/// in a process.  Null, the default, leaves PETSc to a PetscInitialize of the
/// program.  It is called for each solver, under no lock, and does nothing
/// where PETSc runs.  A program that has none of its own calls
/// StartPetscWhenNeeded (petsc/start_petsc.h).
void SetStartOfPetsc(void (*start)());

/// Empty when there is a multigrid solver: the library was built with PETSc,
/// its module `libelastimate_multigrid` is found at run time, and PETSc runs or
/// has a function that starts it.  Else why not, in a few words.  The module is
/// loaded at the first call, for PETSc brings libraries that take longer to
/// load than a small scene takes to estimate.
[[nodiscard]] std::string WhyNoMultigrid();

inline bool HasMultigrid() { return WhyNoMultigrid().empty(); }

/// A PetscMultigrid, which cannot be set up where PETSc fails to start.
/// `assembly` and `degrees_of_freedom` must outlive it.
/// Precondition: HasMultigrid().
[[nodiscard]] std::unique_ptr<LinearSolver> MakeMultigrid(
    const Mesh& mesh, const StiffnessAssembly& assembly,
    const DegreesOfFreedom& degrees_of_freedom);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_SOLVERS_MULTIGRID_H_
