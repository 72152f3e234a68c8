#ifndef ELASTIMATE_CORE_SCENE_LOADS_H_
#define ELASTIMATE_CORE_SCENE_LOADS_H_

#include <Eigen/Core>
#include <optional>
#include <string_view>
#include <vector>

#include "elastimate/core/mesh/mesh.h"
#include "elastimate/core/scene/scene.h"

namespace elastimate {

/// Returns the consistent nodal forces of `loads`, dimension x num_nodes
/// [force]: f_i = integral of N_i times the load.  On linear tetrahedra a
/// uniform body force puts a quarter of an element's share on each node, and a
/// uniform traction, pressure or surface force a third of a facet's.  On
/// quadratic ones with straight edges, an element's share is -1/20 at the
/// vertices and 1/5 at the mid-edge nodes, and a facet's is 0 and 1/3
/// [Zienkiewicz & Taylor, The Finite Element Method]. Precondition: a valid
/// scene (ValidateScene).  O(num_nodes + num_elements + num_facets) per load.
[[nodiscard]] Eigen::MatrixXd AssembleLoads(const Mesh& mesh,
                                            const std::vector<Load>& loads);

/// Does what AssembleLoads does for each load case, one column each: num_dofs x
/// num_load_cases, row dimension * node + component.
[[nodiscard]] Eigen::MatrixXd AssembleLoadCases(const Scene& scene);
/// Writes the forces into the columns of `force`, which has that shape.
void AssembleLoadCases(const Scene& scene, Eigen::Ref<Eigen::MatrixXd> force);

/// Tells whether a load is a pressure that follows the deformed surface.  Above
/// it acts as it does on the undeformed one.
[[nodiscard]] bool Follows(const Load& load);

/// Returns a load that is `factor` times another.
[[nodiscard]] Load Scaled(const Load& load, double factor);

/// The sum of a load.
struct LoadResultant {
  std::string_view type;  ///< As a scene.json calls it, such as "traction".
  Eigen::VectorXd force;  ///< The sum of its nodal forces [force], with the
                          ///< share on held components, which the supports
                          ///< take without straining the specimen.
  std::optional<double> area;  ///< The area of its facets [length^2], if any.
};

/// Returns the resultant of one load of a valid scene, which is the same for
/// each element order.  O(num_nodes + num_elements + num_facets).
[[nodiscard]] LoadResultant ResultantOf(const Mesh& mesh, const Load& load);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_SCENE_LOADS_H_
