#include "elastimate/io/gmsh_text_check.h"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <set>
#include <sstream>
#include <vector>

#include "elastimate/io/mesh_file.h"

namespace elastimate {
namespace {

/// Walks over the lines of a file, one for each node and element; throws Damage
/// where they are not as many as counted.
class GmshTextCheck {
 public:
  struct Damage {
    std::string reason;
  };

  explicit GmshTextCheck(const std::filesystem::path& path)
      : file_(path, std::ios::binary) {}

  void WalkMsh() {
    static const std::set<std::string> kNodes = {"$NOD", "$NOE", "$Nodes",
                                                 "$ParametricNodes"};
    static const std::set<std::string> kElements = {"$ELM", "$Elements"};
    double version = 1;
    while (TakeLine()) {
      section_ = line_;
      if (section_ == "$MeshFormat") {
        TakeLine();
        std::istringstream format(line_);
        bool is_binary = false;
        format >> version >> is_binary;
        if (is_binary) {
          return;
        }
      } else if (kNodes.count(section_) > 0) {
        // Version 4.1 has the numbers of a block ahead of its positions.
        WalkMshSection(version >= 4, version >= 4.1);
        CheckNumbersDiffer();
      } else if (kElements.count(section_) > 0) {
        WalkMshSection(version >= 4, false);
      }
    }
  }

  void WalkMesh() {
    static const std::set<std::string> kCounted = {
        "Vertices",    "Edges",          "EdgesP2",    "Triangles",
        "TrianglesP2", "Quadrilaterals", "Tetrahedra", "TetrahedraP2",
        "Hexahedra",   "Prisms",         "Pyramids"};
    while (TakeLine()) {
      section_ = line_;
      if (kCounted.count(section_) > 0) {
        const std::int64_t count = TakeCounts(1)[0];
        SkipEntries(count);
        RequireEnd(count);
      }
    }
  }

 private:
  void WalkMshSection(bool has_blocks, bool has_numbers_ahead) {
    numbers_.clear();
    if (!has_blocks) {
      const std::int64_t count = TakeCounts(1)[0];
      SkipEntries(count);
      RequireEnd(count);
      return;
    }
    const std::vector<std::int64_t> counts = TakeCounts(2);
    std::int64_t total = 0;
    for (std::int64_t block = 0; block < counts[0]; ++block) {
      const std::int64_t count = TakeCounts(4)[3];
      SkipEntries(count);
      total += count;
      if (has_numbers_ahead) {
        const std::size_t num_numbers = numbers_.size();
        SkipEntries(count);
        numbers_.resize(num_numbers);
      }
    }
    RequireEnd(total);
    if (total != counts[1]) {
      throw Damage{"the blocks of its section " + section_ +
                   " have more or fewer entries than it counts"};
    }
  }

  void SkipEntries(std::int64_t count) {
    if (count < 0) {
      throw Damage{"its section " + section_ + " counts " +
                   std::to_string(count) + " entries"};
    }
    for (std::int64_t i = 0; i < count; ++i) {
      if (!TakeLine() || !IsEntry()) {
        throw Damage{"its section " + section_ + " ends before the " +
                     std::to_string(count) + " entries that it counts"};
      }
      numbers_.push_back(std::strtoull(line_.c_str(), nullptr, 10));
    }
  }

  /// Gmsh takes the last of several nodes of one number.
  void CheckNumbersDiffer() {
    std::sort(numbers_.begin(), numbers_.end());
    const auto twin = std::adjacent_find(numbers_.begin(), numbers_.end());
    if (twin != numbers_.end()) {
      throw Damage{"its section " + section_ + " has the number " +
                   std::to_string(*twin) + " twice"};
    }
  }

  void RequireEnd(std::int64_t count) {
    if (TakeLine() && IsEntry()) {
      throw Damage{"its section " + section_ + " goes on after the " +
                   std::to_string(count) + " entries that it counts"};
    }
    is_line_kept_ = true;
  }

  /// Neither a keyword of .msh nor one of .mesh.
  bool IsEntry() const {
    return line_[0] != '$' &&
           std::isupper(static_cast<unsigned char>(line_[0])) == 0;
  }

  /// The next line that has something other than a comment; false at the end.
  bool TakeLine() {
    if (is_line_kept_) {
      is_line_kept_ = false;
      return !line_.empty();
    }
    while (std::getline(file_, line_)) {
      line_.erase(line_.find_last_not_of(" \t\r") + 1);
      line_.erase(0, line_.find_first_not_of(" \t"));
      if (!line_.empty() && line_[0] != '#') {
        return true;
      }
    }
    return false;
  }

  std::vector<std::int64_t> TakeCounts(std::size_t at_least) {
    std::vector<std::int64_t> counts;
    if (TakeLine()) {
      std::istringstream line(line_);
      for (std::int64_t count = 0; line >> count;) {
        counts.push_back(count);
      }
    }
    if (counts.size() < at_least) {
      throw Damage{"its section " + section_ + " lacks a count"};
    }
    return counts;
  }

  std::ifstream file_;
  std::string line_;           ///< Empty at the end of the file.
  bool is_line_kept_ = false;  ///< To be taken once more.
  std::string section_;
  std::vector<std::uint64_t> numbers_;  ///< First ones of the entries.
};

}  // namespace

std::string WhyGmshTextIsDamaged(const std::filesystem::path& path) {
  GmshTextCheck check(path);
  try {
    if (FileExtension(path) == ".mesh") {
      check.WalkMesh();
    } else {
      check.WalkMsh();
    }
  } catch (const GmshTextCheck::Damage& damage) {
    return damage.reason;
  }
  return "";
}

}  // namespace elastimate
