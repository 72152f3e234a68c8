#ifndef ELASTIMATE_IO_MESH_NUMBERED_MESH_H_
#define ELASTIMATE_IO_MESH_NUMBERED_MESH_H_

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "elastimate/io/mesh/mesh_file.h"
#include "elastimate/io/mesh/simplices.h"

namespace elastimate {

/// A type of element as a finite element program names it.
struct NumberedType {
  std::string name;
  int dimension = 0;
  /// None where it is not for scenes, and for cells that are cut.
  std::optional<ElementKind> kind;
  /// The number of vertices, which come first, of what may be a facet or cut.
  int num_vertices = 0;
  /// "which has ...; convert it by ...", for a type that is not for scenes.
  std::string mend;
  /// Whether it has a node in the middle of each edge; not read where `kind`
  /// is given.
  bool has_middles = false;

  /// Returns the shape of what may be cut into simplices; null where it may
  /// not.
  const CellShape* Cell() const;
  /// Returns 1 or 2, for what may be cut.
  int Order() const;
  /// Returns the number of nodes of an element; zero where it is not known.
  int NumNodes() const;
};

struct NumberedElement {
  std::size_t number;
  std::size_t type;        ///< The place in NumberedMesh::types.
  std::size_t first_node;  ///< The place in NumberedMesh::nodes_of_elements.
  std::size_t num_nodes;
};

/// A face of an element as files name it.
struct NumberedFace {
  std::size_t element;  ///< The number of the element.
  /// The places of its vertices in the element.  None stands for all faces of
  /// the element that are on the boundary or, where the element is a facet
  /// itself, for the element.
  std::vector<int> vertices;
};

/// A named set of nodes, of facets or of elements.
struct NumberedSet {
  enum class Members { kNodes, kFacets, kElements };

  std::string name;
  Members members = Members::kNodes;
  std::vector<std::size_t> numbers;  ///< Of nodes or of elements.
  std::vector<NumberedFace> faces;
  /// The numbers of the vertices of facets that a file gives by their nodes.
  std::vector<std::vector<std::size_t>> facets;
};

/// A mesh with the numbers that a file gives to nodes and elements, in the
/// order of the file.  The nodes of elements are in the order of VTK.
struct NumberedMesh {
  std::string program;  ///< Whose numbers they are: "Abaqus".
  std::vector<std::size_t> node_numbers;
  std::vector<Eigen::Vector3d> positions;
  std::vector<NumberedType> types;
  std::vector<NumberedElement> elements;
  std::vector<std::size_t> nodes_of_elements;
  std::vector<NumberedSet> sets;
  /// The names of the sets of elements that have materials; may be empty.
  std::vector<std::string> material_sets;
};

/// Returns the mesh with the nodes and the elements in ascending order of their
/// numbers; the sets become its groups.
///
/// The elements are those of dimension 3 or, where there are none, those of
/// dimension 2; others make up sets only.  The regions are the sets that have
/// materials or, where none has, the sets of elements except for those of all
/// elements, if there are others.  Where two of them share an element there are
/// none (MeshFile::why_no_regions).
///
/// Where the elements are not of one kind, or are pyramids or wedges, all are
/// cut into simplices (Simplices) if their nodes are their vertices, or their
/// vertices and the middles of their edges.  In the latter case nodes are added
/// (AddMiddleNodes), which have numbers behind the others, and which are in the
/// sets of nodes that have all nodes around them.
///
/// Throws std::invalid_argument, naming the file and the element or the node,
/// for elements that are neither of one ElementKind nor cut, for those that
/// fold onto themselves when they are cut, for numbers that come twice, and for
/// nodes and elements that the file does not have. O((num_nodes + num_elements)
/// log num_elements).
MeshFile ToMeshFile(const std::filesystem::path& path,
                    const NumberedMesh& numbered);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_MESH_NUMBERED_MESH_H_
