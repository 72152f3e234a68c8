#ifndef ELASTIMATE_IO_GMSH_GMSH_TEXT_CHECK_H_
#define ELASTIMATE_IO_GMSH_GMSH_TEXT_CHECK_H_

#include <filesystem>
#include <string>

namespace elastimate {

/// Tells in a few words how a text file of nodes and elements (.msh, any
/// version, or .mesh) is damaged where Gmsh 4.8 does not mind, although it
/// makes another mesh of it; empty when it is not.  Gmsh stops at a count that
/// is too small, and so loses what follows, and takes the last of several nodes
/// of one number.  Binary files are not looked into.
std::string WhyGmshTextIsDamaged(const std::filesystem::path& path);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_GMSH_GMSH_TEXT_CHECK_H_
