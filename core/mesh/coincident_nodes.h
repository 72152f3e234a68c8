#ifndef ELASTIMATE_CORE_MESH_COINCIDENT_NODES_H_
#define ELASTIMATE_CORE_MESH_COINCIDENT_NODES_H_

#include <array>
#include <vector>

#include "elastimate/core/mesh/mesh.h"

namespace elastimate {

/// Returns, ascending, each node that lies at the place of another node, within
/// a ten-thousandth of the shortest edge at either of the two, with such
/// another node.  Elements on such nodes are not connected there, since no
/// element may have both (ValidateMesh).
/// Precondition: a valid mesh.
/// O(num_elements + num_nodes log num_nodes) for the nodes of a mesh, of which
/// few lie in one of the thin layers that are searched.
std::vector<std::array<int, 2>> CoincidentNodes(const Mesh& mesh);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_MESH_COINCIDENT_NODES_H_
