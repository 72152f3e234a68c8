#include "elastimate/core/equilibrium/vertex_space.h"

#include <utility>

#include "elastimate/core/scene/rigid_motion.h"
#include "elastimate/core/scene/unknown_motion.h"

namespace elastimate {
namespace {

// With fewer vertices a factorisation is faster whatever the shape of the body,
// so the vertices need not be analysed.
constexpr Eigen::Index kFewVertices = 20000;

Supports OfVertices(const Supports& supports, Eigen::Index num_vertices) {
  return {supports.held.leftCols(num_vertices),
          supports.displacement.leftCols(num_vertices)};
}

Scene SceneOfVertices(const Scene& scene) {
  const Mesh& mesh = scene.mesh;
  const Eigen::Index num_vertices = mesh.NumVertices();
  Scene vertices;
  vertices.mesh.kind = LinearKind(mesh.kind);
  vertices.mesh.section = mesh.section;
  vertices.mesh.nodes = mesh.nodes.leftCols(num_vertices);
  vertices.mesh.elements = mesh.elements.topRows(mesh.Topology().num_vertices);
  vertices.mesh.regions = mesh.regions;
  vertices.materials = scene.materials;
  vertices.supports = OfVertices(scene.supports, num_vertices);
  for (const LoadCase& load_case : scene.load_cases) {
    LoadCase& own = vertices.load_cases.emplace_back();
    if (load_case.supports) {
      own.supports = OfVertices(*load_case.supports, num_vertices);
    }
  }
  return vertices;
}

}  // namespace

VertexSpace::VertexSpace(Scene vertices, SolverKind kind)
    : scene(std::move(vertices)),
      solver(scene.mesh, SupportsOf(scene, 0), kind) {}

std::unique_ptr<VertexSpace> VertexSpaceToSolveBy(const Scene& scene,
                                                  SolverKind solver) {
  if (scene.mesh.Order() == 1 || IsCurved(scene.mesh.kind) ||
      solver == SolverKind::kCholesky || HasUnknownMotion(scene) ||
      scene.load_cases.empty() ||
      (solver == SolverKind::kAutomatic &&
       scene.mesh.NumVertices() < kFewVertices)) {
    return nullptr;
  }
  Scene vertices = SceneOfVertices(scene);
  if (!WhyNotHeld(vertices).empty()) {
    return nullptr;
  }
  auto space = std::make_unique<VertexSpace>(std::move(vertices), solver);
  return space->solver.UsesMultigrid() ? std::move(space) : nullptr;
}

}  // namespace elastimate
