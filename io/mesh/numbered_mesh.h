#ifndef ELASTIMATE_IO_MESH_NUMBERED_MESH_H_
#define ELASTIMATE_IO_MESH_NUMBERED_MESH_H_

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "elastimate/io/mesh/mesh_file.h"

namespace elastimate {

/// A type of element as a finite element program names it.
struct NumberedType {
  std::string name;
  int dimension = 0;
  /// None where it is not for scenes.
  std::optional<ElementKind> kind;
  /// The number of vertices, which come first, of what may be a facet.
  int num_vertices = 0;
  /// "which has ...; convert it by ...", for a type that is not for scenes.
  std::string mend;
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
/// Throws std::invalid_argument, naming the file and the element or the node,
/// for elements that are not of one ElementKind, for numbers that come twice,
/// and for nodes and elements that the file does not have.
/// O((num_nodes + num_elements) log num_elements).
MeshFile ToMeshFile(const std::filesystem::path& path,
                    const NumberedMesh& numbered);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_MESH_NUMBERED_MESH_H_
