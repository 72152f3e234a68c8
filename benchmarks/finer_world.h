#ifndef ELASTIMATE_BENCHMARKS_FINER_WORLD_H_
#define ELASTIMATE_BENCHMARKS_FINER_WORLD_H_

#include <Eigen/Core>
#include <vector>

#include "elastimate/core/laws/elasticity.h"
#include "elastimate/core/scene/scene.h"

namespace elastimate {

/// A world in which specimens are finer than the elements of a mesh: quadratic
/// elements on the mesh after `num_divisions` divisions of each tetrahedron
/// into eight.
class FinerWorld {
 public:
  /// The scene has linear tetrahedra.
  FinerWorld(const Scene& scene, int num_divisions);

  /// Measures all load cases of a scene of this mesh at its nodes, without
  /// noise.  The displacements are wrong by 1e-4 at most, in the energy norm.
  /// Throws std::runtime_error where there are none.
  void Measure(const IsotropicElasticity& truth, Scene& scene) const;

 private:
  std::vector<Scene> spaces_;  ///< From the linear elements of the mesh on.
};

}  // namespace elastimate

#endif  // ELASTIMATE_BENCHMARKS_FINER_WORLD_H_
