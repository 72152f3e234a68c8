#include "elastimate/io/gmsh/gmsh_text_check.h"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <set>
#include <sstream>
#include <vector>

#include "elastimate/io/mesh/mesh_file.h"

namespace elastimate {
namespace {

/// The lines between two keywords of a file.
struct TextSection {
  std::string keyword;
  std::string first_line;
  std::int64_t num_lines = 0;
  std::vector<std::uint64_t> numbers;  ///< They begin each line but the first.
};

bool HasNodes(const TextSection& section) {
  static const std::set<std::string> kKeywords = {"$NOD", "$NOE", "$Nodes",
                                                  "$ParametricNodes"};
  return kKeywords.count(section.keyword) > 0;
}

bool IsCounted(const TextSection& section) {
  static const std::set<std::string> kKeywords = {
      "$ELM",      "$Elements",    "Vertices",    "Edges",     "EdgesP2",
      "Triangles", "Tetrahedra",   "TrianglesP2", "Hexahedra", "Quadrilaterals",
      "Prisms",    "TetrahedraP2", "Pyramids"};
  return HasNodes(section) || kKeywords.count(section.keyword) > 0;
}

/// Returns the number of lines for which the first line of the section calls.
double DueLines(const TextSection& section, double version) {
  std::istringstream counts(section.first_line);
  double first = 0;
  double second = 0;
  counts >> first;
  if (version < 4 || section.keyword[0] != '$') {
    return 1 + first;
  }
  // Each block has a line of its own.  From version 4.1 on, blocks of nodes
  // have the numbers and the positions in separate lines.
  counts >> second;
  return 1 + first + (HasNodes(section) && version >= 4.1 ? 2 : 1) * second;
}

std::string WhyDamaged(TextSection& section, double version) {
  if (!IsCounted(section)) {
    return "";
  }
  const double due = DueLines(section, version);
  if (static_cast<double>(section.num_lines) != due) {
    std::ostringstream text;
    text << "its section " << section.keyword << " has " << section.num_lines
         << " lines where " << due << " are due";
    return text.str();
  }
  if (HasNodes(section) && version < 4) {
    std::sort(section.numbers.begin(), section.numbers.end());
    const auto twin =
        std::adjacent_find(section.numbers.begin(), section.numbers.end());
    if (twin != section.numbers.end()) {
      return "its section " + section.keyword + " has the number " +
             std::to_string(*twin) + " twice";
    }
  }
  return "";
}

/// Appends a line that is no keyword.
void Append(const std::string& line, TextSection& section) {
  if (++section.num_lines == 1) {
    section.first_line = line;
  } else if (HasNodes(section)) {
    section.numbers.push_back(std::strtoull(line.c_str(), nullptr, 10));
  }
}

/// Takes the next line that has something other than a comment; false at the
/// end.
bool TakeLine(std::istream& file, std::string& line) {
  while (std::getline(file, line)) {
    line.erase(line.find_last_not_of(" \t\r") + 1);
    line.erase(0, line.find_first_not_of(" \t"));
    if (!line.empty() && line[0] != '#') {
      return true;
    }
  }
  return false;
}

}  // namespace

std::string WhyGmshTextIsDamaged(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  double version = 1;
  TextSection section;
  std::string line;
  while (TakeLine(file, line)) {
    // A keyword begins like this in .msh or in .mesh.
    if (line[0] == '$' || std::isupper(static_cast<unsigned char>(line[0]))) {
      const std::string damage = WhyDamaged(section, version);
      if (!damage.empty()) {
        return damage;
      }
      section = TextSection();
      section.keyword = line;
      continue;
    }
    Append(line, section);
    if (section.keyword == "$MeshFormat" && section.num_lines == 1) {
      bool is_binary = false;
      std::istringstream(line) >> version >> is_binary;
      if (is_binary) {
        return "";
      }
    }
  }
  return WhyDamaged(section, version);
}

}  // namespace elastimate
