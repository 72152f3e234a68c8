#include "benchmarks/finer_world.h"

#include <stdexcept>

#include "elastimate/core/equilibrium/equilibrium.h"
#include "elastimate/core/scene/finer_scene.h"

namespace elastimate {

FinerWorld::FinerWorld(const Scene& scene, int num_divisions)
    : spaces_({scene}) {
  for (int i = 0; i <= num_divisions; ++i) {
    spaces_.push_back(FinerScene(spaces_.back()));
  }
}

void FinerWorld::Measure(const IsotropicElasticity& truth, Scene& scene) const {
  constexpr double kTolerance = 1e-4;
  std::vector<const Scene*> spaces;
  spaces.reserve(spaces_.size());
  for (const Scene& space : spaces_) {
    spaces.push_back(&space);
  }
  Equilibrium model(spaces, SolverKind::kAutomatic, kTolerance);
  if (!model.Solve(model.Forces().Parameters().Moduli(truth.Parameters()))) {
    throw std::runtime_error("the finer world has no displacements");
  }
  const Mesh& mesh = scene.mesh;
  for (std::size_t k = 0; k < scene.load_cases.size(); ++k) {
    scene.load_cases[k].displacement =
        model.Displacement()
            .col(Eigen::Index(k))
            .head(mesh.NumDofs())
            .reshaped(mesh.Dimension(), mesh.NumNodes());
  }
  scene.origin = Origin::kMeasured;
}

}  // namespace elastimate
