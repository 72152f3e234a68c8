#include "elastimate/core/scene/linear_scene.h"

#include <algorithm>
#include <variant>

#include "elastimate/core/mesh/facets.h"
#include "elastimate/core/mesh/linear_mesh.h"
#include "elastimate/core/scene/spread_loads.h"

namespace elastimate {
namespace {

// Repeats the columns of the elements for their cuts, unless one column is for
// all.
Eigen::MatrixXd ForCuts(const Eigen::MatrixXd& columns, Eigen::Index num_cuts) {
  return columns.cols() <= 1
             ? columns
             : Eigen::MatrixXd(columns.replicate(num_cuts / columns.cols(), 1)
                                   .reshaped(columns.rows(), num_cuts));
}

// One overload per kind of load.
struct LoadCutter {
  const LinearMesh& mesh;

  Load operator()(const NodalForces& load) const { return load; }
  Load operator()(const BodyForce& load) const {
    return BodyForce{ForCuts(load.force_density, mesh.Parts().NumElements())};
  }
  Load operator()(const Traction& load) const {
    const Eigen::MatrixXi facets = mesh.FacetsOf(load.facets);
    return Traction{facets, ForCuts(load.traction, facets.cols())};
  }
  Load operator()(const Pressure& load) const {
    return Pressure{mesh.FacetsOf(load.facets), load.pressure, load.follows};
  }
  Load operator()(const SurfaceForce& load) const {
    return SurfaceForce{mesh.FacetsOf(load.facets), load.force};
  }
};

bool HasNodalForces(const LoadCase& load_case) {
  return std::any_of(load_case.loads.begin(), load_case.loads.end(),
                     [](const Load& load) {
                       return std::holds_alternative<NodalForces>(load);
                     });
}

}  // namespace

Scene LinearScene(const Scene& scene) {
  const LinearMesh mesh(scene.mesh);
  Scene linear = scene;
  linear.mesh = mesh.Parts();
  // The parts of an element have the axes of that element.
  const Eigen::Index num_elements = scene.mesh.NumElements();
  const Eigen::Index num_cuts = linear.mesh.NumElements() / num_elements;
  for (Material& material : linear.materials) {
    for (Eigen::MatrixXd& axis : material.axes) {
      if (axis.cols() > 1) {
        axis = axis.replicate(num_cuts, 1)
                   .reshaped(axis.rows(), num_cuts * num_elements)
                   .eval();
      }
    }
  }
  for (LoadCase& load_case : linear.load_cases) {
    if (scene.mesh.Order() == 1 && HasNodalForces(load_case)) {
      load_case.loads = SpreadLoads(scene.mesh, BoundaryFacets(scene.mesh),
                                    scene.supports.held, load_case.loads);
    }
    for (Load& load : load_case.loads) {
      load = std::visit(LoadCutter{mesh}, load);
    }
    load_case.points.points = mesh.PointsOf(load_case.points.points);
  }
  return linear;
}

}  // namespace elastimate
