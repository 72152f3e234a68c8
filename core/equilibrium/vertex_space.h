#ifndef ELASTIMATE_CORE_EQUILIBRIUM_VERTEX_SPACE_H_
#define ELASTIMATE_CORE_EQUILIBRIUM_VERTEX_SPACE_H_

#include <memory>

#include "elastimate/core/scene/scene.h"
#include "elastimate/core/solvers/stiffness_solver.h"

namespace elastimate {

/// Linear elements on the vertices of a quadratic mesh. Where edges are
/// straight, the shape functions of the quadratic elements span those of the
/// linear ones.
struct VertexSpace {
  VertexSpace(Scene vertices, SolverKind kind);
  VertexSpace(const VertexSpace&) = delete;
  VertexSpace& operator=(const VertexSpace&) = delete;

  /// Mesh, materials and supports; the load cases have nothing but their own
  /// supports.
  Scene scene;
  /// Has analysed the mesh with the supports of the first load case.
  StiffnessSolver solver;
};

/// Returns the space of the vertices where systems of `scene` are better solved
/// by iterations over it than by a factor: where multigrid is asked for or,
/// with SolverKind::kAutomatic, where a StiffnessSolver takes multigrid for the
/// vertices.  Null elsewhere: for linear and curved elements, where motions are
/// unknown, or where supports do not hold the vertices alone.
[[nodiscard]] std::unique_ptr<VertexSpace> VertexSpaceToSolveBy(
    const Scene& scene, SolverKind solver);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_EQUILIBRIUM_VERTEX_SPACE_H_
