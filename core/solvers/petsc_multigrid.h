#ifndef ELASTIMATE_CORE_SOLVERS_PETSC_MULTIGRID_H_
#define ELASTIMATE_CORE_SOLVERS_PETSC_MULTIGRID_H_

#include <Eigen/Core>
#include <memory>
#include <optional>

#include "elastimate/core/mechanics/stiffness_assembly.h"
#include "elastimate/core/mesh/mesh.h"
#include "elastimate/core/scene/degrees_of_freedom.h"
#include "elastimate/core/solvers/linear_solver.h"

namespace elastimate {

/// Conjugate gradients, preconditioned by algebraic multigrid: smoothed
/// aggregation [Vanek, Mandel & Brezina 1996] from PETSc, with coarse spaces
/// that hold the rigid motions.  Time and memory grow linearly with the number
/// of nodes; the number of iterations grows as nu nears 1/2, and with bad
/// elements.
class PetscMultigrid : public LinearSolver {
 public:
  /// `assembly` must outlive this object.  Where PETSc is not running,
  /// Factorize returns false.
  PetscMultigrid(const Mesh& mesh, const StiffnessAssembly& assembly,
                 const DegreesOfFreedom& degrees_of_freedom);
  ~PetscMultigrid() override;

  /// Sets up the coarse matrices.
  bool Factorize(const Eigen::VectorXd& values) override;

  std::optional<Eigen::MatrixXd> Solve(const Eigen::MatrixXd& right_hand_sides,
                                       double tolerance) override;

  int NumIterations() const override;

 private:
  struct Workspace;
  std::unique_ptr<Workspace> workspace_;
};

}  // namespace elastimate

// core/solvers/multigrid.cc looks this function up in the module.
extern "C" __attribute__((visibility("default"))) elastimate::LinearSolver*
elastimate_make_multigrid(
    const elastimate::Mesh& mesh, const elastimate::StiffnessAssembly& assembly,
    const elastimate::DegreesOfFreedom& degrees_of_freedom);
extern "C" __attribute__((visibility("default"))) bool
elastimate_is_petsc_running();

#endif  // ELASTIMATE_CORE_SOLVERS_PETSC_MULTIGRID_H_
