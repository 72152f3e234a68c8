#ifndef ELASTIMATE_IO_GMSH_TEXT_CHECK_H_
#define ELASTIMATE_IO_GMSH_TEXT_CHECK_H_

#include <filesystem>
#include <string>

namespace elastimate {

/// What is wrong with the counts of nodes and elements in a text file of Gmsh
/// (.msh, any version) or Medit (.mesh), or with Gmsh's node numbers, in a few
/// words, or an empty string.  Gmsh 4.8 stops at a count that is too small, and
/// so loses what follows, and takes the last of several nodes of one number.
/// Binary files are not looked into.
std::string WhyGmshTextIsDamaged(const std::filesystem::path& path);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_GMSH_TEXT_CHECK_H_
