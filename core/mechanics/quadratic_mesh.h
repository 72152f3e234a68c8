#ifndef ELASTIMATE_CORE_MECHANICS_QUADRATIC_MESH_H_
#define ELASTIMATE_CORE_MECHANICS_QUADRATIC_MESH_H_

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "elastimate/core/mechanics/element_blocks.h"
#include "elastimate/core/mesh/mesh.h"

namespace elastimate {

/// Tells whether QuadraticPass takes elements of this kind.
[[nodiscard]] inline bool HasQuadraticPass(ElementKind kind) {
  return kind == ElementKind::kTet10 || kind == ElementKind::kHex27 ||
         kind == ElementKind::kQuad9;
}

/// A mesh of quadratic elements in the order in which a pass visits it.
class QuadraticMesh {
 public:
  /// Takes the mesh as it is, as one block.  Refers to `mesh`, which has to
  /// stay as it is; a temporary one does not compile. Precondition of both:
  /// HasQuadraticPass(mesh.kind).
  explicit QuadraticMesh(const Mesh& mesh);
  explicit QuadraticMesh(const Mesh&&) = delete;

  /// Numbers a large mesh for locality, whose middle nodes usually come behind
  /// all vertices, so that threads can share its blocks and the nodes of one
  /// block fit into the cache.  O(num_elements) time, several element passes.
  [[nodiscard]] static QuadraticMesh InBlocks(const Mesh& mesh);

  ElementKind Kind() const { return mesh_.kind; }
  int Dimension() const { return mesh_.Dimension(); }
  double Thickness() const { return mesh_.section.thickness; }
  SectionModel Model() const { return mesh_.section.model; }
  Eigen::Index NumDofs() const { return mesh_.NumDofs(); }
  Eigen::Index NumElements() const { return mesh_.NumElements(); }

  /// Returns the nodes of an element and those that follow.
  const int* Element(std::ptrdiff_t element) const {
    return Elements().data() + Elements().rows() * element;
  }
  /// Returns the positions of the nodes.  Four values may be read at each
  /// vertex.
  const double* Positions() const {
    return IsOrdered() ? positions_.data() : mesh_.nodes.data();
  }
  /// Returns which node, or element, of the mesh the i-th one is.
  std::ptrdiff_t Node(std::ptrdiff_t i) const {
    return IsOrdered() ? nodes_[i] : i;
  }
  std::ptrdiff_t ElementOfMesh(std::ptrdiff_t i) const {
    return IsOrdered() ? element_of_mesh_[i] : i;
  }
  const ElementBlocks& Blocks() const { return blocks_; }

 private:
  bool IsOrdered() const { return !nodes_.empty(); }
  const Eigen::MatrixXi& Elements() const {
    return IsOrdered() ? elements_ : mesh_.elements;
  }

  const Mesh& mesh_;
  /// These are empty where the mesh is taken as it is.
  Eigen::MatrixXi elements_;
  Eigen::MatrixXd positions_;  ///< With one column more than there are nodes.
  std::vector<int> nodes_;
  std::vector<int> element_of_mesh_;
  ElementBlocks blocks_;
};

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_MECHANICS_QUADRATIC_MESH_H_
