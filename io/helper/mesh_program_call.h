#ifndef ELASTIMATE_IO_HELPER_MESH_PROGRAM_CALL_H_
#define ELASTIMATE_IO_HELPER_MESH_PROGRAM_CALL_H_

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "elastimate/io/mesh/mesh_file.h"

namespace elastimate {

/// A helper program of the package (io/helper/mesh_program.h).
struct MeshProgram {
  std::string file;     ///< "elastimate-gmsh"
  std::string library;  ///< Whose work it is, for people: "Gmsh"
  std::string purpose;  ///< "reads Gmsh files"
  std::string mend;     ///< For a damaged file: "write it again"
};

/// Lets the program read a file, in a process of its own with limits of memory
/// and processor time that follow from the size of the file, as `arguments` and
/// the path tell it to.  Positions and arrays are as the file has them, indices
/// are in range.  For concurrent calls.
///
/// Throws std::invalid_argument, naming the file, with the program's sentence,
/// or when the program crashes or meets its limits; std::bad_alloc when this
/// process or the machine has too little memory; std::runtime_error when the
/// program is not there.
MeshFile ReadByProgram(const MeshProgram& program,
                       const std::vector<std::string>& arguments,
                       const std::filesystem::path& path);

/// Lets the program make a mesh without a file and without limits.  Throws
/// std::runtime_error with its sentence when it fails; std::bad_alloc as above.
MeshFile MakeByProgram(const MeshProgram& program,
                       const std::vector<std::string>& arguments);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_HELPER_MESH_PROGRAM_CALL_H_
