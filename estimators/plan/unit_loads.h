#ifndef ELASTIMATE_ESTIMATORS_PLAN_UNIT_LOADS_H_
#define ELASTIMATE_ESTIMATORS_PLAN_UNIT_LOADS_H_

#include <Eigen/Core>
#include <string>
#include <vector>

#include "elastimate/core/scene/scene.h"

namespace elastimate {

/// The facets that the loads of a scene act on: those of tractions, pressures
/// and surface forces, each once, and the boundary facets whose vertices all
/// have a nodal force.  Empty where there are none, as under body forces.
/// O(num_elements + num_facets log num_facets).
[[nodiscard]] Eigen::MatrixXi LoadedFacets(const Scene& scene);

/// A load whose resultant is 1 along one axis, and 0 along all others.
struct UnitLoad {
  std::string name;  ///< Such as "force along x" or "moment about z".
  NodalForces load;
};

/// Forces along the axes, which are uniform tractions on the facets, and the
/// moments about the axes through their centroid c (one in the plane), which
/// are tractions t = w x (x - c) with the w of a moment of 1 and no force:
///
///   f_i = t(x_i) A_i,   A_i = integral of N_i,   sum of (x_i - c) x f_i = e.
///
/// Precondition: facets of an area.  O(num_nodes + num_facets).
[[nodiscard]] std::vector<UnitLoad> UnitLoads(const Mesh& mesh,
                                              const Eigen::MatrixXi& facets);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_PLAN_UNIT_LOADS_H_
