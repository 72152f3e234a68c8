#ifndef ELASTIMATE_CORE_SOLVERS_MULTIGRID_H_
#define ELASTIMATE_CORE_SOLVERS_MULTIGRID_H_

#include <memory>
#include <string>

#include "elastimate/core/mechanics/stiffness_assembly.h"
#include "elastimate/core/mesh/mesh.h"
#include "elastimate/core/scene/degrees_of_freedom.h"
#include "elastimate/core/solvers/linear_solver.h"

namespace elastimate {

/// Empty when there is a multigrid solver: the library was built with PETSc,
/// and its module `libelastimate_multigrid` is found at run time.  Else why
/// not, in a few words.  It is loaded at the first call, for PETSc brings
/// libraries that take longer to load than a small scene takes to estimate.
const std::string& WhyNoMultigrid();

inline bool HasMultigrid() { return WhyNoMultigrid().empty(); }

/// A PetscMultigrid.  `assembly` and `degrees_of_freedom` must outlive it.
/// Precondition: HasMultigrid().
std::unique_ptr<LinearSolver> MakeMultigrid(
    const Mesh& mesh, const StiffnessAssembly& assembly,
    const DegreesOfFreedom& degrees_of_freedom);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_SOLVERS_MULTIGRID_H_
