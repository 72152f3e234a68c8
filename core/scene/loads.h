#ifndef ELASTIMATE_CORE_SCENE_LOADS_H_
#define ELASTIMATE_CORE_SCENE_LOADS_H_

#include <Eigen/Core>
#include <optional>
#include <string_view>
#include <vector>

#include "elastimate/core/mesh/mesh.h"
#include "elastimate/core/scene/scene.h"

namespace elastimate {

/// The consistent nodal forces of `loads`, 3 x num_nodes [force]: f_i =
/// integral of N_i times the load.  On linear elements a uniform body force
/// puts a quarter of an element's share on each node, a uniform traction,
/// pressure or surface force a third of a facet's; on quadratic ones it is
/// -1/20 at the vertices and 1/5 at the mid-edge nodes of an element, 0 and 1/3
/// of a facet [Zienkiewicz & Taylor, The Finite Element Method]. Precondition:
/// a valid scene (ValidateScene). O(num_nodes + num_elements + num_facets) per
/// load.
Eigen::Matrix3Xd AssembleLoads(const Mesh& mesh,
                               const std::vector<Load>& loads);

/// AssembleLoads for each load case, one column each:
/// (3 num_nodes) x num_load_cases, row 3 * node + component.
Eigen::MatrixXd AssembleLoadCases(const Scene& scene);
/// The same into columns that are there.
void AssembleLoadCases(const Scene& scene, Eigen::Ref<Eigen::MatrixXd> force);

/// The area of triangles of the mesh, `3 x num_facets` or `6 x num_facets` node
/// indices in range [length^2].  O(num_facets).
double FacetArea(const Mesh& mesh, const Eigen::MatrixXi& facets);

/// A load in sum.
struct LoadResultant {
  std::string_view type;  ///< As a scene.json calls it, such as "traction".
  Eigen::Vector3d force;  ///< The sum of its nodal forces [force], with the
                          ///< share on held components, which the supports
                          ///< take without straining the specimen.
  std::optional<double> area;  ///< Of its facets [length^2], if it has any.
};

/// The resultant of one load of a valid scene, the same for each element order.
/// O(num_nodes + num_elements + num_facets).
LoadResultant ResultantOf(const Mesh& mesh, const Load& load);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_SCENE_LOADS_H_
