#ifndef ELASTIMATE_IO_HELPER_MESH_PROGRAM_H_
#define ELASTIMATE_IO_HELPER_MESH_PROGRAM_H_

#include <functional>
#include <string>
#include <vector>

#include "elastimate/io/mesh/mesh_file.h"

namespace elastimate {

/// The main function of a helper program, which makes one mesh for the process
/// that has started it, in a process of its own: what Gmsh or a reader of VTK
/// does to damaged files ends there, and their global state is not that of the
/// caller.  It dies with its parent, and takes no more memory and processor
/// time than it is told.  `make` gets the arguments that are left; what it
/// throws is told to the parent.  Not for use by hand: see
/// io/helper/mesh_program_call.h.
///
/// Arguments: the parent's process, seconds of processor time and bytes of
/// memory (none of them limited when 0), and those of `make`.
int RunMeshProgram(
    int argc, char** argv,
    const std::function<MeshFile(const std::vector<std::string>&)>& make);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_HELPER_MESH_PROGRAM_H_
