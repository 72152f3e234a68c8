#ifndef ELASTIMATE_IO_GMSH_GMSH_TEXT_CHECK_H_
#define ELASTIMATE_IO_GMSH_GMSH_TEXT_CHECK_H_

#include <filesystem>
#include <string>

namespace elastimate {

/// What Gmsh 4.8 does not mind in a text file of nodes and elements (.msh, any
/// version, or .mesh), although it makes another mesh of it, in a few words, or
/// an empty string: it stops at a count that is too small, and so loses what
/// follows, and of several nodes of one number takes the last.  Binary files
/// are not looked into.
std::string WhyGmshTextIsDamaged(const std::filesystem::path& path);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_GMSH_GMSH_TEXT_CHECK_H_
