#ifndef ELASTIMATE_BENCHMARKS_FACETS_WHERE_H_
#define ELASTIMATE_BENCHMARKS_FACETS_WHERE_H_

#include <Eigen/Core>
#include <functional>

#include "elastimate/core/mesh/mesh.h"

namespace elastimate {

/// Returns the columns of BoundaryFacets all of whose nodes are accepted, in
/// their order.  O(num_elements).
Eigen::MatrixXi FacetsWhere(const Mesh& mesh,
                            const std::function<bool(int)>& accepts_node);

}  // namespace elastimate

#endif  // ELASTIMATE_BENCHMARKS_FACETS_WHERE_H_
