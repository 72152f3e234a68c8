#ifndef ELASTIMATE_IO_SCENE_NODE_SELECTION_H_
#define ELASTIMATE_IO_SCENE_NODE_SELECTION_H_

#include <Eigen/Core>

#include "elastimate/io/mesh/mesh_file.h"
#include "elastimate/io/scene/json_value.h"

namespace elastimate {

/// One flag per node of the file; never set for a node without a tetrahedron.
using NodeMask = Eigen::Array<bool, 1, Eigen::Dynamic>;

/// The nodes that `selection` selects: "all"; "free", which is `free` (null
/// where it cannot be used); {"ids": [...]}, zero-based positions among all
/// nodes of the file; {"box": [low, high]}, bounds included; {"array": "name"},
/// where the node array of one component is not zero; {"physical": "name"}, a
/// Gmsh group by its name or number.  Throws std::invalid_argument, naming the
/// file and the place in it, also when nothing is selected.
NodeMask SelectNodes(const JsonValue& selection, const MeshFile& mesh,
                     const NodeMask* free);

/// The boundary facets that `selection` selects, 3 x num_facets, outward: those
/// all of whose nodes are selected, or exactly the triangles of a Gmsh group of
/// dimension 2.  `boundary` are all of them (BoundaryFacets).
Eigen::MatrixXi SelectFacets(const JsonValue& selection, const MeshFile& mesh,
                             const NodeMask& free,
                             const Eigen::MatrixXi& boundary);

/// The node array of the mesh file that `name` names, with one of the given
/// numbers of components (0: any other number is wrong).
const Eigen::MatrixXd& NamedNodeArray(const JsonValue& name,
                                      const MeshFile& mesh, int components,
                                      int other_components = 0);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_SCENE_NODE_SELECTION_H_
