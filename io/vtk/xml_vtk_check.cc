#include "elastimate/io/vtk/xml_vtk_check.h"

#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkXMLDataElement.h>
#include <vtkXMLDataParser.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstdint>
#include <fstream>
#include <map>
#include <set>
#include <string_view>
#include <system_error>
#include <vector>

#include "elastimate/io/text/printable.h"

namespace elastimate {
namespace {

/// Data are at most this many times as large as their compressed form.
constexpr double kLargestCompression = 1e4;

std::string_view Attribute(vtkXMLDataElement* element, const char* name) {
  const char* value = element->GetAttribute(name);
  return value == nullptr ? std::string_view() : value;
}

/// Returns a count in an attribute, `missing` when there is none, -1 when it is
/// no count.
std::int64_t Count(vtkXMLDataElement* element, const char* name,
                   std::int64_t missing) {
  const std::string_view text = Attribute(element, name);
  if (element->GetAttribute(name) == nullptr) {
    return missing;
  }
  std::int64_t count = -1;
  const auto [end, error] =
      std::from_chars(text.data(), text.data() + text.size(), count);
  return error == std::errc() && end == text.data() + text.size() ? count : -1;
}

/// Returns zero when the size is not fixed.
std::int64_t WordSize(std::string_view type) {
  static const std::map<std::string_view, std::int64_t> kSizes = {
      {"Int8", 1},    {"UInt8", 1},  {"Int16", 2}, {"UInt16", 2},
      {"Int32", 4},   {"UInt32", 4}, {"Int64", 8}, {"UInt64", 8},
      {"Float32", 4}, {"Float64", 8}};
  const auto found = kSizes.find(type);
  return found == kSizes.end() ? 0 : found->second;
}

/// Returns the bytes that base64 text encodes, up to what is no such text.
std::string DecodeBase64(std::string_view text) {
  static const std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  std::uint32_t bits = 0;
  int num_bits = 0;
  for (const char c : text) {
    const std::size_t digit = kDigits.find(c);
    if (digit == std::string_view::npos) {
      break;
    }
    bits = bits << 6 | static_cast<std::uint32_t>(digit);
    num_bits += 6;
    if (num_bits >= 8) {
      num_bits -= 8;
      bytes += static_cast<char>(bits >> num_bits & 0xFF);
    }
  }
  return bytes;
}

/// Tells where the data inside an element begin.
class PlacingParser : public vtkXMLDataParser {
 public:
  static PlacingParser* New();

  std::int64_t FindInlineData(vtkXMLDataElement* element) {
    SeekInlineDataPosition(element);
    return TellG();
  }
};

vtkStandardNewMacro(PlacingParser);

class XmlVtkCheck {
 public:
  explicit XmlVtkCheck(const std::filesystem::path& path)
      : file_(path, std::ios::binary),
        file_size_(
            static_cast<std::int64_t>(std::filesystem::file_size(path))) {
    parser_->SetStream(&file_);
  }

  XmlVtkFrame Run() {
    CheckRoot();
    return frame_;
  }

 private:
  void CheckRoot() {
    if (parser_->Parse() == 0 || parser_->GetRootElement() == nullptr) {
      frame_.damage = "its XML cannot be parsed";
      return;
    }
    vtkXMLDataElement* root = parser_->GetRootElement();
    const std::string type(Attribute(root, "type"));
    if (type != "UnstructuredGrid") {
      frame_.damage =
          "its type is '" + Printable(type) + "' instead of 'UnstructuredGrid'";
      return;
    }
    const std::string_view header = Attribute(root, "header_type");
    header_size_ = header.empty() ? 4 : WordSize(header);
    if (header_size_ < 4) {
      frame_.damage = "its header_type is unknown";
      return;
    }
    is_big_endian_ = Attribute(root, "byte_order") == "BigEndian";
    is_compressed_ = !Attribute(root, "compressor").empty();
    CheckChildren(root);
  }

  void CheckChildren(vtkXMLDataElement* element) {
    for (int i = 0; i < element->GetNumberOfNestedElements(); ++i) {
      if (frame_.damage.empty()) {
        CheckElement(element->GetNestedElement(i), element);
      }
    }
  }

  void CheckElement(vtkXMLDataElement* element, vtkXMLDataElement* parent) {
    const std::string_view name = element->GetName();
    if (name == "DataArray" || name == "Array") {
      CheckArray(element, parent);
      return;
    }
    if (name == "Piece") {
      num_points_ = Count(element, "NumberOfPoints", 0);
      num_cells_ = Count(element, "NumberOfCells", 0);
      // Positions do not shrink to less than a hundredth of a byte.
      if (std::min(num_points_, num_cells_) < 0 ||
          std::max(num_points_, num_cells_) > 100 * file_size_) {
        frame_.damage = "its NumberOfPoints or NumberOfCells is wrong";
      }
    }
    names_.clear();
    CheckChildren(element);
  }

  /// Returns -1 when the file says it only in the data.
  std::int64_t NumTuples(vtkXMLDataElement* array,
                         vtkXMLDataElement* parent) const {
    const std::string_view place = parent->GetName();
    const std::string_view name = Attribute(array, "Name");
    if (place == "PointData" || place == "Points") {
      return num_points_;
    }
    if (place == "CellData" ||
        (place == "Cells" && (name == "offsets" || name == "types"))) {
      return num_cells_;
    }
    return -1;
  }

  /// VTK takes the last of several arrays of one name.
  void CheckName(const std::string& name, const std::string& parent) {
    if (parent != "PointData" && parent != "CellData") {
      return;
    }
    if (name.empty()) {
      frame_.damage = "an array of its " + parent + " has no name";
    } else if (!names_.insert(name).second) {
      frame_.damage =
          "its " + parent + " has two arrays '" + Printable(name) + "'";
    }
  }

  void NoteTextArray(const std::string& name, const std::string& parent) {
    if (parent == "PointData") {
      frame_.text_point_arrays.push_back(name);
    } else if (parent == "CellData") {
      frame_.text_cell_arrays.push_back(name);
    }
  }

  void CheckArray(vtkXMLDataElement* array, vtkXMLDataElement* parent) {
    const std::string name(Attribute(array, "Name"));
    CheckName(name, parent->GetName());
    if (Attribute(array, "type") == "String") {
      NoteTextArray(name, parent->GetName());
    }
    const std::int64_t components = Count(array, "NumberOfComponents", 1);
    if (components < 0 || components > 100000) {
      frame_.damage = "the NumberOfComponents of its array '" +
                      Printable(name) + "' is wrong";
      return;
    }
    if (Count(array, "NumberOfTuples", 0) < 0 ||
        Count(array, "NumberOfTuples", 0) > 100 * file_size_) {
      frame_.damage =
          "the NumberOfTuples of its array '" + Printable(name) + "' is wrong";
      return;
    }
    const std::int64_t num_tuples = NumTuples(array, parent);
    const double num_words =
        num_tuples < 0
            ? -1.0
            : static_cast<double>(num_tuples) *
                  static_cast<double>(std::max<std::int64_t>(components, 1));
    const std::string_view format = Attribute(array, "format");
    const auto word_size =
        static_cast<double>(WordSize(Attribute(array, "type")));
    if (format != "binary" && format != "appended") {
      if (word_size > 0) {
        CheckNumWords(name, CountInlineWords(array), num_words);
      } else if (num_words > static_cast<double>(file_size_)) {
        frame_.damage =
            "its array '" + Printable(name) + "' is shorter than it says";
      }
      return;
    }
    const double size = DataSize(array, format == "appended");
    if (size < 0) {
      frame_.damage =
          "the data of its array '" + Printable(name) + "' are not all there";
    } else if (word_size > 0) {
      CheckNumWords(name, size / word_size, num_words);
    }
  }

  /// Checks the number of values, of which VTK ignores those beyond the due
  /// number; any number is right when the due number is negative.
  void CheckNumWords(const std::string& name, double num_words, double due) {
    if (due >= 0 && num_words != due) {
      frame_.damage = "its array '" + Printable(name) + "' has " +
                      Text(num_words) + " values where " + Text(due) +
                      " are due";
    }
  }

  static std::string Text(double count) {
    return std::to_string(static_cast<std::int64_t>(count));
  }

  double CountInlineWords(vtkXMLDataElement* array) {
    file_.clear();
    file_.seekg(parser_->FindInlineData(array));
    std::int64_t count = 0;
    bool was_space = true;
    std::streambuf& buffer = *file_.rdbuf();
    for (int c = buffer.sbumpc();
         c != std::char_traits<char>::eof() && c != '<'; c = buffer.sbumpc()) {
      const bool is_space = std::isspace(c) != 0;
      count += was_space && !is_space ? 1 : 0;
      was_space = is_space;
    }
    return static_cast<double>(count);
  }

  /// Returns the number of bytes that the sizes ahead of the data of an array
  /// give, or -1 where these do not fit the file.
  double DataSize(vtkXMLDataElement* array, bool is_appended) {
    std::int64_t position = 0;
    if (is_appended) {
      const std::int64_t offset = Count(array, "offset", -1);
      position = parser_->GetAppendedDataPosition();
      if (offset < 0 || offset > file_size_ - position) {
        return -1;
      }
      position += offset;
    } else {
      file_.clear();
      position = parser_->FindInlineData(array);
    }
    const bool is_base64 = !is_appended || AppendedIsBase64();
    if (!is_compressed_) {
      const auto size = ReadHeader(position, is_base64, 1);
      return size.size() == 1 && size[0] <= Available(position) ? size[0] : -1;
    }
    const auto sizes = ReadHeader(position, is_base64, 3);
    return sizes.size() == 3
               ? BlocksSize(position, is_base64, sizes[0], sizes[1], sizes[2])
               : -1;
  }

  /// Returns this number of bytes for compressed data.
  double BlocksSize(std::int64_t position, bool is_base64, double num_blocks,
                    double block_size, double last_block_size) {
    const double available = Available(position);
    if (num_blocks * static_cast<double>(header_size_) > available ||
        last_block_size > block_size) {
      return -1;
    }
    if (num_blocks == 0) {
      return 0;
    }
    const double size = last_block_size > 0
                            ? (num_blocks - 1) * block_size + last_block_size
                            : num_blocks * block_size;
    const auto header = ReadHeader(position, is_base64,
                                   3 + static_cast<std::int64_t>(num_blocks));
    if (static_cast<double>(header.size()) != 3 + num_blocks) {
      return -1;
    }
    double compressed_size = 0;
    for (std::size_t i = 3; i < header.size(); ++i) {
      compressed_size += header[i];
    }
    return compressed_size <= available &&
                   std::max(size, block_size) <=
                       kLargestCompression * (compressed_size + 64)
               ? size
               : -1;
  }

  double Available(std::int64_t position) const {
    return static_cast<double>(file_size_ - position);
  }

  /// Returns the first words of an array, as doubles; fewer where the file
  /// ends.
  std::vector<double> ReadHeader(std::int64_t position, bool is_base64,
                                 std::int64_t num_words) {
    const std::int64_t num_bytes = num_words * header_size_;
    std::string bytes = ReadAt(position, is_base64, num_bytes);
    std::vector<double> words;
    for (std::size_t begin = 0;
         begin + header_size_ <= bytes.size() &&
         words.size() < static_cast<std::size_t>(num_words);
         begin += header_size_) {
      std::uint64_t word = 0;
      for (std::int64_t i = 0; i < header_size_; ++i) {
        const std::int64_t place = is_big_endian_ ? i : header_size_ - 1 - i;
        word = word << 8 | static_cast<unsigned char>(bytes[begin + place]);
      }
      words.push_back(static_cast<double>(word));
    }
    return words;
  }

  std::string ReadAt(std::int64_t position, bool is_base64,
                     std::int64_t num_bytes) {
    file_.clear();
    file_.seekg(position);
    if (is_base64) {
      file_ >> std::ws;
      num_bytes = (num_bytes + 2) / 3 * 4;
    }
    std::string bytes(std::min(num_bytes, file_size_), '\0');
    file_.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    bytes.resize(file_.gcount());
    return is_base64 ? DecodeBase64(bytes) : bytes;
  }

  bool AppendedIsBase64() {
    vtkXMLDataElement* section =
        parser_->GetRootElement()->FindNestedElementWithName("AppendedData");
    return section != nullptr && Attribute(section, "encoding") == "base64";
  }

  std::ifstream file_;
  vtkNew<PlacingParser> parser_;
  std::int64_t file_size_;
  std::int64_t header_size_ = 4;
  bool is_big_endian_ = false;
  bool is_compressed_ = false;
  std::int64_t num_points_ = 0;
  std::int64_t num_cells_ = 0;
  XmlVtkFrame frame_;            ///< It has the damage that was found first.
  std::set<std::string> names_;  ///< In the point or cell data walked over.
};

}  // namespace

XmlVtkFrame CheckXmlVtk(const std::filesystem::path& path) {
  return XmlVtkCheck(path).Run();
}

}  // namespace elastimate
