#ifndef ELASTIMATE_CORE_MESH_NODE_ORDER_H_
#define ELASTIMATE_CORE_MESH_NODE_ORDER_H_

#include <vector>

#include "elastimate/core/mesh/mesh.h"

namespace elastimate {

/// Tells whether elements that follow each other are near each other in memory:
/// the mean distance between the smallest node indices of consecutive elements
/// is at most 1024, or a sixteenth of the nodes, as in fronts of nodes across a
/// compact body.  Random numbering of the nodes or of the elements makes it
/// about a fifth of the nodes.  O(num_elements), much less than an element
/// pass.
bool HasLocality(const Mesh& mesh);

struct OrderedMesh {
  /// It has no regions, and middle nodes among its vertices.
  Mesh mesh;
  std::vector<int> places;  ///< Its node i is node places[i] of the other mesh.
  /// Its element i is element element_places[i] of the other mesh.
  std::vector<int> element_places;
};

/// Returns the mesh with its nodes in the order in which a breadth-first search
/// along the elements finds them, from one end of its longest extent [Cuthill &
/// McKee 1969], and its elements in the order of their first node.  The nodes
/// of an element are then at most two fronts of the search apart.
/// Precondition: a valid mesh.
/// O(num_elements) time and memory, at the speed of random access.
OrderedMesh OrderForLocality(const Mesh& mesh);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_MESH_NODE_ORDER_H_
