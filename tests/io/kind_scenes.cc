#include "tests/io/kind_scenes.h"

#include <stdexcept>

#include "elastimate/core/equilibrium/simulated_measurement.h"
#include "elastimate/core/scene/quadratic_scene.h"
#include "elastimate/io/examples/example_scenes.h"

namespace elastimate {
namespace {

const std::string kPlaneStrain = "_plane_strain";

Scene SceneOfLinear(ElementKind kind, SectionModel model) {
  if (TopologyOf(kind).dimension == 3) {
    CuboidOptions options;
    options.cells = {2, 2, 1};
    options.kind = kind;
    return CuboidScene(options);
  }
  RectangleOptions options;
  options.cells = {4, 2};
  options.size = {2, 1};
  options.kind = kind;
  options.section = {model, 0.25};
  options.force = {30, 20};
  return RectangleScene(options);
}

/// With mid-edge nodes that are measured as all others are.
Scene Quadratic(const Scene& linear) {
  Scene scene = QuadraticScene(linear);
  scene.load_cases[0].observed.resize(0, 0);
  return scene;
}

Scene UnmeasuredScene(const std::string& kind, SectionModel model) {
  if (kind.rfind("curved_", 0) == 0) {
    Scene scene = UnmeasuredScene(kind.substr(7), model);
    scene.mesh.kind = CurvedKind(scene.mesh.kind);
    for (auto x : scene.mesh.nodes.colwise()) {
      x(0) += 0.3 * x(1) * x(1);
    }
    return scene;
  }
  for (const ElementKind one : kElementKinds) {
    if (TopologyOf(one).name == kind) {
      const Scene linear = SceneOfLinear(LinearKind(one), model);
      return LinearKind(one) == one ? linear : Quadratic(linear);
    }
  }
  throw std::logic_error("no scene " + kind);
}

}  // namespace

std::vector<std::string> SceneNames() {
  std::vector<std::string> names;
  for (const ElementKind kind : kElementKinds) {
    names.emplace_back(TopologyOf(kind).name);
    if (TopologyOf(kind).dimension == 2) {
      names.push_back(names.back() + kPlaneStrain);
    }
  }
  return names;
}

Scene SceneOf(const std::string& name) {
  const std::size_t end = name.find(kPlaneStrain);
  Scene scene =
      UnmeasuredScene(name.substr(0, end), end == std::string::npos
                                               ? SectionModel::kPlaneStress
                                               : SectionModel::kPlaneStrain);
  Measure(kMeasuredElasticity, scene);
  return scene;
}

std::string PlanarVtkText() {
  return "# vtk DataFile Version 3.0\n"
         "four quadrilaterals\n"
         "ASCII\n"
         "DATASET UNSTRUCTURED_GRID\n"
         "POINTS 9 float\n"
         "0 0 7  1 0 7  2 0 7  0 0.5 7  1.25 0.375 7  2 0.5 7  0 1 7  1 1 7  "
         "2 1 7\n"
         "CELLS 4 20\n"
         "4 0 1 4 3\n"
         "4 1 2 5 4\n"
         "4 3 4 7 6\n"
         "4 4 5 8 7\n"
         "CELL_TYPES 4\n"
         "9 9 9 9\n";
}

}  // namespace elastimate
