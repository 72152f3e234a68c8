#include "elastimate/io/legacy_vtk_check.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstdint>
#include <fstream>
#include <map>
#include <set>
#include <string_view>
#include <system_error>

namespace elastimate {
namespace {

std::string UpperCase(std::string_view text) {
  std::string upper(text);
  std::transform(upper.begin(), upper.end(), upper.begin(),
                 [](unsigned char c) { return std::toupper(c); });
  return upper;
}

bool IsSpace(char c) {
  return std::isspace(static_cast<unsigned char>(c)) != 0;
}

std::string ReadContent(const std::filesystem::path& path) {
  std::string content(std::filesystem::file_size(path), '\0');
  std::ifstream(path, std::ios::binary)
      .read(content.data(), static_cast<std::streamsize>(content.size()));
  return content;
}

/// Walks over the sections of a file; throws Damage where they are not whole.
class LegacyVtkCheck {
 public:
  struct Damage {
    std::string reason;
  };

  explicit LegacyVtkCheck(const std::filesystem::path& path)
      : content_(ReadContent(path)) {}

  void Run() {
    WalkHeader();
    while (!(section_ = UpperCase(TakeWord())).empty()) {
      WalkSection();
    }
    if (num_cell_types_ != num_cells_) {
      throw Damage{"it has " + std::to_string(num_cells_) + " cells but " +
                   std::to_string(num_cell_types_) + " cell types"};
    }
  }

 private:
  [[noreturn]] void ThrowShort() const {
    throw Damage{"it ends inside the section " + section_.substr(0, 60)};
  }

  std::string_view TakeLine() {
    const std::size_t end =
        std::min(content_.find('\n', position_), content_.size());
    const std::string_view line(&content_[position_], end - position_);
    position_ = std::min(end + 1, content_.size());
    return line;
  }

  /// Empty at the end of the file.
  std::string_view TakeWord() {
    while (position_ < content_.size() && IsSpace(content_[position_])) {
      ++position_;
    }
    const std::size_t begin = position_;
    while (position_ < content_.size() && !IsSpace(content_[position_])) {
      ++position_;
    }
    return {&content_[begin], position_ - begin};
  }

  std::int64_t TakeInteger() {
    const std::string_view word = TakeWord();
    std::int64_t number = 0;
    const auto [end, error] =
        std::from_chars(word.data(), word.data() + word.size(), number);
    if (error != std::errc() || end != word.data() + word.size()) {
      throw Damage{"'" + std::string(word.substr(0, 40)) +
                   "' is no integer, in the section " + section_.substr(0, 60)};
    }
    return number;
  }

  std::int64_t TakeCount() {
    const std::int64_t count = TakeInteger();
    // Each item takes a byte at least.
    if (count < 0 || static_cast<std::size_t>(count) > content_.size()) {
      throw Damage{"it cannot have the " + std::to_string(count) +
                   " items of the section " + section_.substr(0, 60)};
    }
    return count;
  }

  void Skip(std::int64_t count, const std::string& type) {
    static const std::map<std::string, std::int64_t> kBits = {
        {"BIT", 1},           {"CHAR", 8},          {"SIGNED_CHAR", 8},
        {"UNSIGNED_CHAR", 8}, {"SHORT", 16},        {"UNSIGNED_SHORT", 16},
        {"INT", 32},          {"UNSIGNED_INT", 32}, {"VTKIDTYPE", 32},
        {"FLOAT", 32},        {"LONG", 64},         {"UNSIGNED_LONG", 64},
        {"DOUBLE", 64},       {"VTKTYPEINT64", 64}, {"VTKTYPEUINT64", 64}};
    const auto bits = kBits.find(type);
    if (bits == kBits.end()) {
      throw Damage{"the type '" + type.substr(0, 40) +
                   "' is unknown, in the section " + section_.substr(0, 60)};
    }
    if (!is_binary_) {
      for (std::int64_t i = 0; i < count; ++i) {
        const std::string_view word = TakeWord();
        if (word.empty()) {
          ThrowShort();
        }
        // VTK does not read "nan" and "inf" either.
        if (word.find_first_not_of("0123456789+-.eE") != word.npos) {
          throw Damage{"'" + std::string(word.substr(0, 40)) +
                       "' is no number, in the section " +
                       section_.substr(0, 60)};
        }
      }
      return;
    }
    TakeLine();
    const std::size_t size = (count * bits->second + 7) / 8;
    if (content_.size() - position_ < size) {
      ThrowShort();
    }
    position_ += size;
  }

  std::int64_t TakeCellValue() {
    if (!is_binary_) {
      return TakeInteger();
    }
    if (content_.size() - position_ < 4) {
      ThrowShort();
    }
    std::uint32_t value = 0;
    for (int i = 0; i < 4; ++i) {  // Big-endian.
      value = value << 8 | static_cast<unsigned char>(content_[position_++]);
    }
    return static_cast<std::int32_t>(value);
  }

  void WalkHeader() {
    section_ = "header";
    const std::string_view magic = "# VTK DATAFILE VERSION ";
    std::string first = UpperCase(TakeLine());
    first.erase(first.find_last_not_of(" \t\r") + 1);
    if (first.substr(0, magic.size()) != magic) {
      throw Damage{"its first line is not '# vtk DataFile Version ...'"};
    }
    // VTK takes what it does not understand for an old version.
    const std::string version = first.substr(magic.size());
    if (version.size() != 3 || version[0] < '1' || version[0] > '5' ||
        version[1] != '.' || version[2] < '0' || version[2] > '9') {
      throw Damage{"its version is none from 1.0 to 5.9"};
    }
    is_version_5_ = version[0] == '5';
    TakeLine();  // The title.
    const std::string encoding = UpperCase(TakeWord());
    if (encoding != "ASCII" && encoding != "BINARY") {
      throw Damage{"its third line is neither ASCII nor BINARY"};
    }
    is_binary_ = encoding == "BINARY";
  }

  void WalkSection() {
    if (section_ == "DATASET") {
      const std::string_view kind = TakeWord();
      if (UpperCase(kind) != "UNSTRUCTURED_GRID") {
        throw Damage{"its dataset is '" + std::string(kind.substr(0, 40)) +
                     "'"};
      }
    } else if (section_ == "POINTS") {
      const std::int64_t count = TakeCount();
      Skip(3 * count, UpperCase(TakeWord()));
    } else if (section_ == "CELLS") {
      WalkCells();
    } else if (section_ == "CELL_TYPES") {
      num_cell_types_ = TakeCount();
      Skip(num_cell_types_, "INT");
    } else if (section_ == "POINT_DATA" || section_ == "CELL_DATA") {
      names_.clear();
      num_tuples_ = TakeCount();
    } else if (section_ == "METADATA") {
      SkipMetadata();
    } else if (section_ == "FIELD") {
      WalkFields();
    } else {
      WalkAttribute();
    }
  }

  void WalkCells() {
    const std::int64_t count = TakeCount();
    const std::int64_t size = TakeCount();
    if (is_version_5_) {
      num_cells_ = std::max<std::int64_t>(count - 1, 0);
      WalkCellValues("OFFSETS", count);
      WalkCellValues("CONNECTIVITY", size);
      return;
    }
    // Each cell is its number of points and then those.
    num_cells_ = count;
    if (is_binary_) {
      TakeLine();
    }
    std::int64_t left = size;
    for (std::int64_t cell = 0; cell < count; ++cell) {
      const std::int64_t num_points = left > 0 ? TakeCellValue() : -1;
      if (num_points < 0 || num_points > left - 1) {
        throw Damage{"the sizes of its cells do not add up"};
      }
      for (std::int64_t i = 0; i < num_points; ++i) {
        TakeCellValue();
      }
      left -= num_points + 1;
    }
    if (left != 0) {
      throw Damage{"the sizes of its cells do not add up"};
    }
  }

  void WalkCellValues(const std::string& name, std::int64_t count) {
    section_ = name;
    if (UpperCase(TakeWord()) != name) {
      throw Damage{"the section " + name + " is missing"};
    }
    Skip(count, UpperCase(TakeWord()));
  }

  /// Up to the next empty line.
  void SkipMetadata() {
    TakeLine();
    while (position_ < content_.size() && !TakeLine().empty()) {
    }
  }

  void WalkFields() {
    TakeWord();  // The name of the collection.
    const std::int64_t num_arrays = TakeCount();
    for (std::int64_t i = 0; i < num_arrays; ++i) {
      std::string_view name = TakeWord();
      if (name == "METADATA") {
        SkipMetadata();
        name = TakeWord();
      }
      section_ = "FIELD, array '" + std::string(name) + "'";
      NoteArray(std::string(name));
      const std::int64_t num_components = TakeCount();
      const std::int64_t num_tuples = TakeCount();
      Skip(num_components * num_tuples, UpperCase(TakeWord()));
    }
  }

  /// VTK takes the last of several arrays of one name.
  void NoteArray(const std::string& name) {
    if (!names_.insert(name).second) {
      throw Damage{"it has two arrays '" + name.substr(0, 40) + "'"};
    }
  }

  void WalkAttribute() {
    static const std::map<std::string, std::int64_t> kComponents = {
        {"VECTORS", 3},  {"NORMALS", 3},    {"TENSORS", 9},
        {"TENSORS6", 6}, {"GLOBAL_IDS", 1}, {"PEDIGREE_IDS", 1}};
    const std::string kind = section_;
    const std::string name(TakeWord());
    section_ += " '" + name + "'";
    if (kind != "LOOKUP_TABLE") {
      NoteArray(name);
    }
    if (kind == "SCALARS") {
      WalkScalars();
    } else if (kind == "COLOR_SCALARS") {
      Skip(TakeCount() * num_tuples_, "UNSIGNED_CHAR");
    } else if (kind == "LOOKUP_TABLE") {
      Skip(4 * TakeCount(), "UNSIGNED_CHAR");
    } else if (kind == "TEXTURE_COORDINATES") {
      const std::int64_t num_components = TakeCount();
      Skip(num_components * num_tuples_, UpperCase(TakeWord()));
    } else if (const auto known = kComponents.find(kind);
               known != kComponents.end()) {
      Skip(known->second * num_tuples_, UpperCase(TakeWord()));
    } else {
      throw Damage{"the section '" + kind.substr(0, 40) + "' is unknown"};
    }
  }

  void WalkScalars() {
    const std::string type = UpperCase(TakeWord());
    const std::size_t end_of_type = position_;
    const std::string_view rest = TakeLine();
    std::int64_t num_components = 1;
    if (!std::all_of(rest.begin(), rest.end(), IsSpace)) {
      position_ = end_of_type;
      num_components = TakeCount();
    }
    if (UpperCase(TakeWord()) != "LOOKUP_TABLE") {
      throw Damage{"the LOOKUP_TABLE is missing in the section " + section_};
    }
    TakeWord();  // The name of the table.
    Skip(num_components * num_tuples_, type);
  }

  const std::string content_;
  std::size_t position_ = 0;
  std::string section_;
  bool is_binary_ = false;
  bool is_version_5_ = false;
  std::int64_t num_cells_ = 0;
  std::int64_t num_cell_types_ = 0;
  std::set<std::string> names_;  ///< Of the point or cell data walked over.
  std::int64_t num_tuples_ = 0;  ///< Of the point or cell data walked over.
};

}  // namespace

std::string WhyLegacyVtkIsDamaged(const std::filesystem::path& path) {
  try {
    LegacyVtkCheck(path).Run();
  } catch (const LegacyVtkCheck::Damage& damage) {
    return damage.reason;
  }
  return "";
}

}  // namespace elastimate
