#ifndef ELASTIMATE_IO_VTK_PVTU_MESH_H_
#define ELASTIMATE_IO_VTK_PVTU_MESH_H_

#include <filesystem>

#include "elastimate/io/mesh/mesh_file.h"

namespace elastimate {

/// Reads an unstructured grid whose pieces are .vtu files of their own, as a
/// program writes it that runs on several processes.  Points of two pieces at
/// exactly the same place become one node.  Ghost cells are left out, and so
/// are arrays that some pieces lack, or on whose values at a shared point two
/// pieces disagree by more than a thousandth of the largest value (with a
/// notice).
///
/// Throws std::invalid_argument, naming the file, for a damaged file or piece,
/// and for a piece with two points at one place, as it is unclear which one
/// other pieces share.  O(num_points log num_points).
MeshFile ReadPvtuMesh(const std::filesystem::path& path);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_VTK_PVTU_MESH_H_
