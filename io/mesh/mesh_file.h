#ifndef ELASTIMATE_IO_MESH_MESH_FILE_H_
#define ELASTIMATE_IO_MESH_MESH_FILE_H_

#include <Eigen/Core>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "elastimate/core/mesh/element_kind.h"
#include "elastimate/core/scene/scene.h"

namespace elastimate {

/// A named array of a mesh file: one column per node or per element.
struct FileArray {
  std::string name;
  Eigen::MatrixXd values;
};

/// A physical group of a Gmsh file, or a set of nodes, of facets or of elements
/// of a finite element program.
struct PhysicalGroup {
  int dimension;  ///< Zero for a set of nodes.
  /// In a mesh of sets the region that the set is, or zero.
  int number;
  std::string name;        ///< Empty when the file gives it no name.
  std::vector<int> nodes;  ///< The nodes of its elements, ascending, once each.
  /// The vertices of the elements of the group that may be faces of the mesh's
  /// elements (in a planar mesh, edges): num_vertices_of_face x num_facets.
  Eigen::MatrixXi facets;
};

/// A node whose position differs from that in the file.
struct MovedNode {
  Eigen::Index node;
  Eigen::Vector3d in_file;  ///< Its position there.
};

/// A node that no cell of the file has: it is in the middle of a quadratic cell
/// that was cut, or of a side of one.
struct AddedNode {
  /// The nodes of that cell or side: its vertices, and those in the middle of
  /// its edges.
  std::vector<int> around;
  std::vector<double> weights;  ///< The shape functions of `around` there.
};

/// What a mesh file holds, in one form.
///
/// A node is known by its zero-based position among all nodes of the file,
/// those without an element included: the order of the points in a VTK file,
/// ascending node numbers in files of other formats.
struct MeshFile {
  std::filesystem::path path;
  Eigen::Matrix3Xd nodes;
  ElementKind kind = ElementKind::kTet4;
  /// num_nodes of the kind x num_elements, in range, at least one.  Vertices
  /// and middle nodes are numbered in any order.
  Eigen::MatrixXi elements;
  std::vector<FileArray> node_arrays;
  std::vector<FileArray> element_arrays;
  std::vector<PhysicalGroup> groups;
  /// The element array that has the regions; there may be none of this name.
  std::string region_array = "region";
  /// The element array `region` has the numbers of the physical groups that the
  /// elements are in, and zero for those in none.
  bool are_regions_groups = false;
  /// Why groups of elements make no such array, "tetrahedron 5 is in ..."; else
  /// empty.
  std::string why_no_regions;

  /// The field data of these names in a VTK file, or what the element types and
  /// sections of Abaqus say.
  std::optional<double> model;  ///< A place in kNumberedModels, if valid.
  /// Why the elements say no one model, for messages; else empty.
  std::string why_no_model;
  std::optional<double> thickness;
  Origin origin = Origin::kMeasured;

  /// The nodes that were put into the middle of the vertices of straight edges,
  /// of faces and of quadratic elements, because rounding had put them beside
  /// it.
  std::vector<MovedNode> moved;

  Eigen::Array<bool, 1, Eigen::Dynamic> used;  ///< Whether an element uses it.
  bool has_other_cells = false;  ///< Cells of lower dimension were ignored.

  /// The line of each node where nodes are rows of a table; else empty.
  std::vector<std::size_t> node_lines;

  bool is_vtk = true;
  /// Whether the elements are simplices that the cells of the file were cut
  /// into.
  bool is_cut = false;
  /// The program whose sets the groups are ("Abaqus"): their names may be
  /// written in letters of any case, and a set of nodes goes before one of
  /// elements with the same name.  Empty for VTK and Gmsh.
  std::string sets_of;
  std::vector<std::size_t> node_numbers;  ///< Empty for a VTK file.
  /// The number in the file of each element, or of the cell that it was cut
  /// from.  It counts cells from 0 in a VTK file, and is empty where nothing
  /// was cut there.
  std::vector<std::size_t> element_numbers;
  /// The last of the nodes, which are not in the file.
  std::vector<AddedNode> added;
  /// Sentences for people about what is read in another way than it is written.
  std::vector<std::string> notices;
  /// The number of nodes of the file that Gmsh left out because no element uses
  /// them.  The positions of all others are then not known.
  Eigen::Index num_nodes_left_out = 0;

  const ElementTopology& Topology() const { return TopologyOf(kind); }
  int Dimension() const { return Topology().dimension; }
  /// "tetrahedron" and "tetrahedra", and so on.
  std::string Shape() const { return std::string(Topology().shape); }
  std::string Shapes() const { return std::string(Topology().shapes); }
};

/// Lists what the elements of a scene may be, for error messages.
inline constexpr char kSupportedElements[] =
    "tetrahedra of 4 or 10 nodes, pyramids of 5 or 13, wedges of 6 or 15, "
    "hexahedra of 8, 20 or 27, triangles of 3 or 6 and quadrilaterals of 4, 8 "
    "or 9";

/// Lists the extensions of mesh files, for messages.
inline constexpr char kMeshExtensions[] =
    ".vtu, .pvtu, .vtk, .msh, .mesh, .unv, .bdf, .inp or .feb";

/// Returns ".vtu" for "a.vtu" and for "A.VTU", but ".Vtu" for "a.Vtu": Gmsh
/// tells its formats by names in all small or all capital letters, and runs a
/// file of any other name as a script.
std::string FileExtension(const std::filesystem::path& path);

/// Returns the array called `name`, or null.
inline const Eigen::MatrixXd* FindArray(const std::vector<FileArray>& arrays,
                                        const std::string& name) {
  for (const FileArray& array : arrays) {
    if (array.name == name) {
      return &array.values;
    }
  }
  return nullptr;
}

/// "a, b", the names of arrays; "none" where there are none.
std::string ArrayNames(const std::vector<FileArray>& arrays);

/// Returns the program that numbered the nodes; empty for a VTK file.
std::string ProgramOf(const MeshFile& mesh);

/// "node 7" or "node 7 (number 12 in Gmsh)", for error messages.
std::string NodeName(const MeshFile& mesh, Eigen::Index node);

/// "hexahedron 7", "hexahedron 7 (number 12 in Gmsh)", "tetrahedron 30 (of
/// number 12 in Abaqus)" where cells were cut, or "tetrahedron 30 (of cell 7)"
/// in a VTK file, for error messages.
std::string ElementName(const MeshFile& mesh, Eigen::Index element);

/// Returns the values of an array, one column for each node of the file, at an
/// added node.
Eigen::VectorXd ValuesAt(const AddedNode& added, const Eigen::MatrixXd& values);

/// Sets the flags of each added node (one column for each node) where those of
/// all nodes around it are set, and clears its others.
template <typename Flags>
void FlagAddedNodes(const MeshFile& mesh, Flags& flags) {
  Eigen::Index column = flags.cols() - Eigen::Index(mesh.added.size());
  for (const AddedNode& added : mesh.added) {
    flags.col(column++) = flags(Eigen::all, added.around).rowwise().all();
  }
}

/// Gives the added nodes columns in the arrays of nodes, which have one for
/// each node of the file.
void ExtendNodeArrays(MeshFile& mesh);

/// Tells whether two names of groups are the same; where groups are sets,
/// letters may be of any case.
bool AreSameNames(const MeshFile& mesh, const std::string& name,
                  const std::string& other);

/// Throws std::invalid_argument when the positions of the nodes in the file are
/// not known (num_nodes_left_out).
void RequireNodePositions(const MeshFile& mesh);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_MESH_MESH_FILE_H_
