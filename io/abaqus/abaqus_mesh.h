#ifndef ELASTIMATE_IO_ABAQUS_ABAQUS_MESH_H_
#define ELASTIMATE_IO_ABAQUS_ABAQUS_MESH_H_

#include <filesystem>

#include "elastimate/io/mesh/mesh_file.h"

namespace elastimate {

/// Reads the mesh of an Abaqus (or CalculiX) input file and of the files that
/// it includes: nodes, elements, sets and surfaces, flat or of the one instance
/// that has elements of a body, where that stands in the assembly.
///
/// The model of planar elements is that of their type, CPS or CPE, and their
/// thickness that of *SOLID SECTION.  Reduced integration and the like, which
/// are not of the mesh, are left out with a notice, as are elements of a lower
/// dimension, which make up sets only.  Sets that Abaqus/CAE made for itself
/// (INTERNAL) have no names.  A set of a part whose name the assembly has too
/// is called INSTANCE.NAME.
///
/// Throws std::invalid_argument, naming the file and the line or the element,
/// for what is wrong and for elements that are not for scenes (ToMeshFile).
/// O(size of the files), with a factor of the logarithm.
MeshFile ReadAbaqusMesh(const std::filesystem::path& path);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_ABAQUS_ABAQUS_MESH_H_
