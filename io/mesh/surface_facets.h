#ifndef ELASTIMATE_IO_MESH_SURFACE_FACETS_H_
#define ELASTIMATE_IO_MESH_SURFACE_FACETS_H_

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <map>

namespace elastimate {

/// Finds facets of a surface by their vertices, in any order.
class SurfaceFacets {
 public:
  /// Facets as those of BoundaryFacets, the vertices of which come first.
  /// O(num_facets log num_facets).
  SurfaceFacets(const Eigen::MatrixXi& facets, int num_vertices)
      : num_vertices_(num_vertices) {
    for (Eigen::Index facet = 0; facet < facets.cols(); ++facet) {
      places_.emplace(VerticesOf(facets.col(facet)), facet);
    }
  }

  /// Returns the place of the facet of these vertices; -1 where there is none.
  Eigen::Index Find(const Eigen::Ref<const Eigen::VectorXi>& vertices) const {
    const auto found = places_.find(VerticesOf(vertices));
    return found == places_.end() ? -1 : found->second;
  }

 private:
  using Vertices = std::array<int, 4>;

  // The last ones are -1 where there are fewer.
  Vertices VerticesOf(const Eigen::Ref<const Eigen::VectorXi>& facet) const {
    Vertices vertices = {-1, -1, -1, -1};
    std::copy_n(facet.data(), num_vertices_, vertices.begin());
    std::sort(vertices.begin(), vertices.end());
    return vertices;
  }

  int num_vertices_;
  std::map<Vertices, Eigen::Index> places_;
};

}  // namespace elastimate

#endif  // ELASTIMATE_IO_MESH_SURFACE_FACETS_H_
