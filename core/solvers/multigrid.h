#ifndef ELASTIMATE_CORE_SOLVERS_MULTIGRID_H_
#define ELASTIMATE_CORE_SOLVERS_MULTIGRID_H_

#include <functional>
#include <memory>
#include <string>

#include "elastimate/core/mechanics/stiffness_assembly.h"
#include "elastimate/core/mesh/mesh.h"
#include "elastimate/core/scene/degrees_of_freedom.h"
#include "elastimate/core/solvers/linear_solver.h"

namespace elastimate {

class Ranks;

/// Has `start` start PETSc for the process when multigrid is first made.  To
/// start it is up to the program, because PETSc starts MPI, which starts only
/// once in a process.  Null, the default, leaves PETSc to a PetscInitialize of
/// the program.  `start` is called for each solver, under no lock, and has to
/// do nothing where PETSc runs.  A program without such a function of its own
/// passes StartPetscWhenNeeded (petsc/start_petsc.h).
void SetStartOfPetsc(void (*start)());

/// Tells in a few words why there is no multigrid solver.  It is empty when
/// there is one: the library was built with PETSc, its module
/// `libelastimate_multigrid` is found at run time, and PETSc runs or has a
/// function that starts it.  The module is loaded at the first call, because
/// PETSc brings libraries that take longer to load than a small scene takes to
/// estimate.
[[nodiscard]] std::string WhyNoMultigrid();

inline bool HasMultigrid() { return WhyNoMultigrid().empty(); }

/// Divides what multigrid solves among the processes of PETSC_COMM_WORLD, which
/// all call this function once, while PETSc runs.  On rank 0 it returns true at
/// once: this rank goes on alone, and has the others take part in each set-up
/// and solve.  On these it returns false once rank 0 calls EndSharedSolves or
/// exits.  Where there is one process, it returns true and does nothing.  Each
/// time rank 0 calls WorkApart, the other ranks call `apart`.
[[nodiscard]] bool ShareSolves(const std::function<void()>& apart = [] {});
/// Lets the other processes go on.  Rank 0 calls it before PETSc ends, when no
/// solver of MakeMultigrid is left.
void EndSharedSolves();
/// Returns how many processes share the solves; 1 without ShareSolves, and
/// within WorkApart.
[[nodiscard]] int NumRanksOfSolves();

/// Returns the processes of ShareSolves; null where there is one.
[[nodiscard]] const Ranks* RanksOfSolves();
/// Does `work` on rank 0 while each other rank does what it gave ShareSolves.
/// Meanwhile each process solves by itself.  Within that, another rank may call
/// this function as well, which then does `work`.  After an exception that
/// leaves `work`, all ranks end when this one exits or solves again.
/// Preconditions: RanksOfSolves() is not null, and no solver of MakeMultigrid
/// is left.
void WorkApart(const std::function<void()>& work);

/// Returns an AlgebraicMultigrid whose coarse spaces PETSc finds; its Factorize
/// fails where PETSc fails to start.  The last two arguments must outlive it.
/// Precondition: HasMultigrid().
[[nodiscard]] std::unique_ptr<LinearSolver> MakeMultigrid(
    const Mesh& mesh, const StiffnessAssembly& assembly,
    const DegreesOfFreedom& degrees_of_freedom);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_SOLVERS_MULTIGRID_H_
