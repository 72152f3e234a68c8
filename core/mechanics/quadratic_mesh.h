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
  /// Takes the mesh as it is, as one block.  Both this and InBlocks refer to
  /// `mesh`, which has to stay as it is; a temporary one does not compile.
  /// Precondition of both: HasQuadraticPass(mesh.kind).
  explicit QuadraticMesh(const Mesh& mesh);
  explicit QuadraticMesh(const Mesh&&) = delete;

  /// Orders a large mesh for locality and divides it into blocks, so that
  /// threads share them and the nodes of a block are near each other in memory:
  /// in a mesh, the vertices come before all middle nodes.  O(num_elements)
  /// time, several element passes.
  [[nodiscard]] static QuadraticMesh InBlocks(const Mesh& mesh);
  static QuadraticMesh InBlocks(const Mesh&&) = delete;

  ElementKind Kind() const { return mesh_.kind; }
  int Dimension() const { return mesh_.Dimension(); }
  double Thickness() const { return mesh_.section.thickness; }
  SectionModel Model() const { return mesh_.section.model; }
  Eigen::Index NumDofs() const { return mesh_.NumDofs(); }
  Eigen::Index NumElements() const { return mesh_.NumElements(); }

  /// Returns the nodes of an element; those of the next elements follow in
  /// memory.
  const int* Element(std::ptrdiff_t element) const {
    return Elements().data() + Elements().rows() * element;
  }
  /// Returns the positions of the nodes.  Four values may be read at each
  /// vertex: a middle node comes behind it, or a spare column.
  const double* Positions() const {
    return IsOrdered() ? positions_.data() : mesh_.nodes.data();
  }
  /// Returns the index in the mesh of node, or element, i of this order.
  std::ptrdiff_t NodeOfMesh(std::ptrdiff_t i) const {
    return IsOrdered() ? node_of_mesh_[i] : i;
  }
  std::ptrdiff_t ElementOfMesh(std::ptrdiff_t i) const {
    return IsOrdered() ? element_of_mesh_[i] : i;
  }
  const ElementBlocks& Blocks() const { return blocks_; }

 private:
  bool IsOrdered() const { return !node_of_mesh_.empty(); }
  const Eigen::MatrixXi& Elements() const {
    return IsOrdered() ? elements_ : mesh_.elements;
  }

  const Mesh& mesh_;
  // These are empty where the mesh is taken as it is.
  Eigen::MatrixXi elements_;
  Eigen::MatrixXd positions_;  ///< With one column more than there are nodes.
  std::vector<int> node_of_mesh_;
  std::vector<int> element_of_mesh_;
  ElementBlocks blocks_;
};

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_MECHANICS_QUADRATIC_MESH_H_
