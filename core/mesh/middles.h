#ifndef ELASTIMATE_CORE_MESH_MIDDLES_H_
#define ELASTIMATE_CORE_MESH_MIDDLES_H_

#include <Eigen/Core>
#include <array>
#include <limits>
#include <vector>

#include "elastimate/core/mesh/mesh.h"
#include "elastimate/core/mesh/vertex_lists.h"

namespace elastimate {

/// The edges of a linear mesh and, where its elements are no simplices, their
/// faces and the elements themselves: all that a quadratic mesh has a node in
/// the middle of (ElementTopology::middles).  They are in ascending order of
/// their vertices, with hexahedra behind all others.
class Middles {
 public:
  /// Precondition: a valid mesh of order 1.  O(num_elements).
  explicit Middles(const Mesh& mesh);

  Eigen::Index Size() const { return vertices_.Size(); }
  /// Returns the vertices of each, ascending but for those of a hexahedron.
  const VertexLists& Vertices() const { return vertices_; }
  /// Returns the number of each middle of each element: as many rows as its
  /// topology has middles.
  const Eigen::MatrixXi& OfElements() const { return of_elements_; }

  /// Returns the edge or face with these vertices, in any order, or -1 where
  /// there is none.  O(log of the number of middles at a vertex).
  Eigen::Index Find(const std::vector<int>& vertices) const;

 private:
  /// The vertices of an edge or a face, ascending, and kNone behind those of an
  /// edge.
  using Key = std::array<int, 4>;
  static constexpr int kNone = std::numeric_limits<int>::max();
  static Key KeyOf(const std::vector<int>& vertices);
  Eigen::Index Find(const Key& key) const;

  std::vector<Key> keys_;  ///< Ascending.
  /// The first key of each lowest vertex, num_nodes + 1.
  std::vector<Eigen::Index> start_;
  VertexLists vertices_;
  Eigen::MatrixXi of_elements_;
};

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_MESH_MIDDLES_H_
