#ifndef ELASTIMATE_TESTS_APPS_REGION_SCENE_H_
#define ELASTIMATE_TESTS_APPS_REGION_SCENE_H_

#include <filesystem>

#include "elastimate/io/examples/example_scenes.h"
#include "elastimate/io/vtk/vtu_writer.h"

namespace elastimate::testing {

/// Writes the cuboid of `generate cuboid` as a VTU file, with three regions, 1
/// to 3, side by side along x.
inline void WriteRegions(const std::filesystem::path& path) {
  Scene scene = CuboidScene({});
  Mesh& mesh = scene.mesh;
  mesh.regions.resize(mesh.NumElements());
  for (Eigen::Index e = 0; e < mesh.NumElements(); ++e) {
    const double x = mesh.nodes(0, mesh.elements.col(e)).mean();
    mesh.regions(e) = x < 0.4 ? 1 : x < 0.6 ? 2 : 3;
  }
  WriteVtu(path, mesh, SceneFields(scene));
}

}  // namespace elastimate::testing

#endif  // ELASTIMATE_TESTS_APPS_REGION_SCENE_H_
