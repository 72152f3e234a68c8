#include "benchmarks/facets_where.h"

#include <algorithm>

#include "elastimate/core/mesh/facets.h"

namespace elastimate {

Eigen::MatrixXi FacetsWhere(const Mesh& mesh,
                            const std::function<bool(int)>& accepts_node) {
  const Eigen::MatrixXi all = BoundaryFacets(mesh);
  Eigen::MatrixXi facets(all.rows(), all.cols());
  Eigen::Index count = 0;
  for (const auto& facet : all.colwise()) {
    if (std::all_of(facet.begin(), facet.end(), accepts_node)) {
      facets.col(count++) = facet;
    }
  }
  return facets.leftCols(count);
}

}  // namespace elastimate
