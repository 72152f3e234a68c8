#include "elastimate/io/gmsh/gmsh_mesh.h"

#include <algorithm>
#include <boost/algorithm/string/predicate.hpp>
#include <boost/algorithm/string/trim.hpp>
#include <cctype>
#include <cstddef>
#include <fstream>
#include <map>
#include <string>

#include "elastimate/core/text/numbers.h"
#include "elastimate/io/gmsh/gmsh_text_check.h"
#include "elastimate/io/helper/mesh_program_call.h"
#include "elastimate/io/helper/private_link.h"
#include "elastimate/io/text/input_error.h"

namespace elastimate {
namespace {

/// Gmsh runs a .msh file that does not begin like one as a script.
void CheckMshBegin(const std::filesystem::path& path) {
  std::string begin(16, '\0');
  std::ifstream(path, std::ios::binary)
      .read(begin.data(), static_cast<std::streamsize>(begin.size()));
  if (begin.rfind("$MeshFormat", 0) != 0 && begin.rfind("$NOD", 0) != 0 &&
      begin.rfind("$Comments", 0) != 0) {
    ThrowDamagedFile(path, "it does not begin with $MeshFormat or $NOD");
  }
}

/// Gmsh takes many a file that was cut for a whole one.
void CheckEnd(const std::filesystem::path& path) {
  static const std::map<std::string, std::string> kLastLines = {
      {".msh", "$END"}, {".mesh", "END"}, {".unv", "-1"}, {".bdf", "ENDDATA"}};
  const std::string& expected = kLastLines.at(FileExtension(path));
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  const std::streamoff size = file.tellg();
  std::string end(std::min<std::streamoff>(size, 256), '\0');
  file.seekg(size - static_cast<std::streamoff>(end.size()))
      .read(end.data(), static_cast<std::streamsize>(end.size()));
  end.erase(end.find_last_not_of(" \t\r\n") + 1);
  end.erase(0, end.find_last_of("\r\n") + 1);
  end.erase(0, end.find_first_not_of(" \t"));
  std::transform(end.begin(), end.end(), end.begin(),
                 [](unsigned char c) { return std::toupper(c); });
  if (end.rfind(expected, 0) != 0) {
    ThrowDamagedFile(path, "its last line does not begin with " + expected);
  }
}

/// Counts the sets of a Nastran file: lines such as "SET 3 = 1 THRU 9" and
/// cards such as SET1.
std::size_t CountNastranSets(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::size_t count = 0;
  for (std::string line; std::getline(file, line);) {
    boost::algorithm::trim_left(line);
    count += boost::algorithm::istarts_with(line, "SET") && line.size() > 3 &&
                     (line[3] == ' ' || std::isdigit(line[3]) != 0)
                 ? 1
                 : 0;
  }
  return count;
}

}  // namespace

MeshFile ReadGmshMesh(const std::filesystem::path& path) {
  if (FileExtension(path) == ".msh") {
    CheckMshBegin(path);
  }
  CheckEnd(path);
  if (const std::string damage = WhyGmshTextIsDamaged(path); !damage.empty()) {
    ThrowDamagedFile(path, damage);
  }
  // Gmsh runs what it finds in a file of that name and ".opt" beside it.
  const PrivateLink link(path, "mesh" + FileExtension(path));
  MeshFile mesh = ReadByProgram({"elastimate-gmsh", "Gmsh", "reads Gmsh files",
                                 "open it in Gmsh and save it again"},
                                {link.Path().string()}, path);
  const std::size_t num_sets =
      FileExtension(path) == ".bdf" ? CountNastranSets(path) : 0;
  if (num_sets > 0) {
    mesh.notices.push_back(
        Counted(num_sets, "set") + " of this Nastran file " +
        (num_sets == 1 ? "is" : "are") +
        " not read; select nodes by a box in the scene.json, or have the mesh "
        "tool export the mesh for Abaqus (.inp), whose sets are read");
  }
  return mesh;
}

}  // namespace elastimate
