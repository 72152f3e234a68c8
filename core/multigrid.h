#ifndef ELASTIMATE_CORE_MULTIGRID_H_
#define ELASTIMATE_CORE_MULTIGRID_H_

#include <memory>
#include <string>

#include "elastimate/core/degrees_of_freedom.h"
#include "elastimate/core/linear_solver.h"
#include "elastimate/core/mesh.h"
#include "elastimate/core/stiffness_assembly.h"

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

#endif  // ELASTIMATE_CORE_MULTIGRID_H_
