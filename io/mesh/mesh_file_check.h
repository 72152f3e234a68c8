#ifndef ELASTIMATE_IO_MESH_MESH_FILE_CHECK_H_
#define ELASTIMATE_IO_MESH_MESH_FILE_CHECK_H_

#include "elastimate/io/mesh/mesh_file.h"

namespace elastimate {

/// Marks the nodes in use, and throws std::invalid_argument, naming the file,
/// the node or the element as the file does, unless there is an element; nodes
/// have finite positions where an element uses them; planar elements lie in a
/// plane z = const, to within a millionth of their extent; no element comes
/// twice, which would make it twice as stiff; and the mid-edge nodes of
/// quadratic elements are no vertices.
///
/// Mid-edge nodes that are all as near to the middle as rounded positions leave
/// them, within a thousandth of the edge, are put there and listed as moved;
/// where one is further away, the elements are of the curved kind, and all
/// positions stay what they are.  O(num_nodes + num_elements).
void CheckMeshFile(MeshFile& mesh);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_MESH_MESH_FILE_CHECK_H_
