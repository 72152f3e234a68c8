#ifndef ELASTIMATE_IO_VTK_PVTU_MESH_H_
#define ELASTIMATE_IO_VTK_PVTU_MESH_H_

#include <filesystem>

#include "elastimate/io/mesh/mesh_file.h"

namespace elastimate {

/// Reads an unstructured grid whose pieces are .vtu files of their own, as a
/// program writes it that runs on several processes.  Points of two pieces at
/// exactly the same place become one node, and ghost cells are left out.  Node
/// arrays keep what the first piece says of a point.
///
/// Throws std::invalid_argument, naming the file, for a damaged file or piece,
/// for a piece with two points at one place, which say nothing of which of them
/// the other pieces continue, and for an array of points on whose values two
/// pieces disagree by more than a thousandth of its largest value.
/// O(num_points log num_points).
MeshFile ReadPvtuMesh(const std::filesystem::path& path);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_VTK_PVTU_MESH_H_
