#ifndef ELASTIMATE_IO_SCENE_NODE_SELECTION_H_
#define ELASTIMATE_IO_SCENE_NODE_SELECTION_H_

#include <Eigen/Core>
#include <vector>

#include "elastimate/io/mesh/mesh_file.h"
#include "elastimate/io/text/json_value.h"

namespace elastimate {

/// One flag per node of the file; never set for a node without an element.
using NodeMask = Eigen::Array<bool, 1, Eigen::Dynamic>;

/// The opposite corners, of 3 coordinates or, in a plane z = const, also of 2.
struct BoxCorners {
  Eigen::VectorXd low;
  Eigen::VectorXd high;
};

/// Returns the value of the key "box" of a selection.  Throws
/// std::invalid_argument, naming the file and the place in it, unless it is
/// [low, high].
BoxCorners CornersOfBox(const JsonValue& box, const MeshFile& mesh);

/// Returns the nodes that `selection` selects: "all"; "free", which is `free`
/// (null where it cannot be used); {"ids": [...]}, zero-based positions among
/// all nodes of the file; {"box": [low, high]}, bounds included, of 3
/// coordinates or, in a plane z = const, also of 2; {"array": "name"}, where
/// the node array of one component is not zero; {"physical": "name"} or {"set":
/// "name"}, a group by its name or, of Gmsh, its number.  Throws
/// std::invalid_argument, naming the file and the place in it, also when
/// nothing is selected.
NodeMask SelectNodes(const JsonValue& selection, const MeshFile& mesh,
                     const NodeMask* free);

/// Returns the boundary facets that `selection` selects, with the outward
/// orientation of BoundaryFacets: those all of whose nodes are selected, or
/// exactly the facets of a group.  `boundary` has all boundary facets
/// (BoundaryFacets).
Eigen::MatrixXi SelectFacets(const JsonValue& selection, const MeshFile& mesh,
                             const NodeMask& free,
                             const Eigen::MatrixXi& boundary);

/// Returns the node array of the mesh file that `name` names, which has to have
/// one of the given numbers of components.
const Eigen::MatrixXd& NamedNodeArray(
    const JsonValue& name, const MeshFile& mesh,
    const std::vector<Eigen::Index>& components);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_SCENE_NODE_SELECTION_H_
