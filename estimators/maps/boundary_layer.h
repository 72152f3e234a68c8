#ifndef ELASTIMATE_ESTIMATORS_MAPS_BOUNDARY_LAYER_H_
#define ELASTIMATE_ESTIMATORS_MAPS_BOUNDARY_LAYER_H_

#include <Eigen/Core>
#include <vector>

#include "elastimate/core/mesh/mesh.h"

namespace elastimate {

/// Tells whether the second of three regions is no material of its own, but the
/// elements that the boundary between the other two cuts: its modulus lies
/// between theirs, and at least nine tenths of its volume is in elements that
/// share a node with both.  A layer of a third material that is as thin as an
/// element looks the same.  It is false unless there are three levels.
/// `volumes` are those of the elements.  O(num_elements).
[[nodiscard]] bool IsBoundaryLayer(const Mesh& mesh,
                                   const Eigen::VectorXd& volumes,
                                   const std::vector<int>& region_of_element,
                                   const Eigen::VectorXd& levels);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_MAPS_BOUNDARY_LAYER_H_
