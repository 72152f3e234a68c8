#ifndef ELASTIMATE_CORE_LOADS_H_
#define ELASTIMATE_CORE_LOADS_H_

#include <Eigen/Core>
#include <vector>

#include "elastimate/core/mesh.h"
#include "elastimate/core/scene.h"

namespace elastimate {

/// The consistent nodal forces of `loads`, 3 x num_nodes [force]: f_i =
/// integral of N_i times the load.  On linear elements a uniform body force
/// puts a quarter of an element's share on each node, a uniform traction or
/// pressure a third of a facet's; on quadratic ones it is -1/20 at the vertices
/// and 1/5 at the mid-edge nodes of an element, 0 and 1/3 of a facet
/// [Zienkiewicz & Taylor, The Finite Element Method].
/// Precondition: a valid scene (ValidateScene).
/// O(num_nodes + num_elements + num_facets) per load.
Eigen::Matrix3Xd AssembleLoads(const Mesh& mesh,
                               const std::vector<Load>& loads);

/// AssembleLoads for each load case, one column each:
/// (3 num_nodes) x num_load_cases, row 3 * node + component.
Eigen::MatrixXd AssembleLoadCases(const Scene& scene);
/// The same into columns that are there.
void AssembleLoadCases(const Scene& scene, Eigen::Ref<Eigen::MatrixXd> force);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_LOADS_H_
