#include "elastimate/io/scene/csv_field.h"

#include <charconv>
#include <fstream>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "elastimate/io/mesh/mesh_file.h"
#include "elastimate/io/text/input_error.h"
#include "elastimate/io/text/printable.h"

namespace elastimate {
namespace {

std::string_view Trim(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t\r");
  if (begin == std::string_view::npos) {
    return {};
  }
  return text.substr(begin, text.find_last_not_of(" \t\r") - begin + 1);
}

std::vector<std::string_view> SplitCells(std::string_view line) {
  std::vector<std::string_view> cells;
  std::size_t comma = 0;
  while ((comma = line.find(',')) != std::string_view::npos) {
    cells.push_back(Trim(line.substr(0, comma)));
    line.remove_prefix(comma + 1);
  }
  cells.push_back(Trim(line));
  return cells;
}

/// The number of columns.
Eigen::Index ReadHeader(const std::filesystem::path& path,
                        std::string_view line, int dimension) {
  const std::string_view byte_order_mark = "\xEF\xBB\xBF";
  if (line.substr(0, byte_order_mark.size()) == byte_order_mark) {
    line.remove_prefix(byte_order_mark.size());
  }
  using Header = std::vector<std::string_view>;
  const Header header = SplitCells(line);
  if (header == Header{"x", "y", "z"} || header == Header{"ux", "uy", "uz"}) {
    return 3;
  }
  if (dimension == 2 &&
      (header == Header{"x", "y"} || header == Header{"ux", "uy"})) {
    return 2;
  }
  ThrowInputError(path,
                  std::string("line 1: the header must be ") +
                      (dimension == 3 ? "x,y,z or ux,uy,uz"
                                      : "x,y or ux,uy (or x,y,z or ux,uy,uz)") +
                      "; correct it (columns are separated by commas)");
}

std::string Place(Eigen::Index line, std::size_t column) {
  return "line " + std::to_string(line) + ", column " +
         std::to_string(column + 1) + ": ";
}

double ParseNumber(const std::filesystem::path& path, std::string_view cell,
                   Eigen::Index line, std::size_t column) {
  if (cell.empty()) {
    ThrowInputError(path,
                    Place(line, column) + "the cell is empty; give a number");
  }
  const std::string_view digits = cell[0] == '+' ? cell.substr(1) : cell;
  double value = 0;
  const auto [end, error] =
      std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error == std::errc::result_out_of_range) {
    ThrowInputError(path, Place(line, column) + "'" + Printable(cell) +
                              "' is beyond the range of a double; correct it");
  }
  if (error != std::errc() || end != digits.data() + digits.size()) {
    ThrowInputError(path, Place(line, column) + "'" + Printable(cell) +
                              "' is not a number; correct it");
  }
  return value;
}

void ParseRow(const std::filesystem::path& path, std::string_view line,
              Eigen::Index line_number, Eigen::Ref<Eigen::VectorXd> row) {
  const std::vector<std::string_view> cells = SplitCells(line);
  if (static_cast<Eigen::Index>(cells.size()) != row.size()) {
    ThrowInputError(path, "line " + std::to_string(line_number) + " has " +
                              std::to_string(cells.size()) + " columns where " +
                              std::to_string(row.size()) +
                              " are due; correct it");
  }
  for (std::size_t column = 0; column < cells.size(); ++column) {
    row[static_cast<Eigen::Index>(column)] =
        ParseNumber(path, cells[column], line_number, column);
  }
}

[[noreturn]] void ThrowRowCount(const std::filesystem::path& path,
                                const std::string& count,
                                Eigen::Index num_nodes) {
  ThrowInputError(
      path, "the file has " + count + " below its header, but the mesh has " +
                std::to_string(num_nodes) + " nodes; give one row per node");
}

}  // namespace

Eigen::MatrixXd ReadCsvField(const std::filesystem::path& path,
                             Eigen::Index num_nodes, int dimension) {
  CheckReadable(path);
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  Eigen::MatrixXd field(ReadHeader(path, line, dimension), num_nodes);
  Eigen::Index row = 0;
  Eigen::Index line_number = 2;
  for (; std::getline(file, line); ++line_number) {
    if (Trim(line).empty() && (file >> std::ws).eof()) {
      break;  // Blank lines at the end.
    }
    if (row == num_nodes) {
      ThrowRowCount(path, "more than " + std::to_string(row) + " rows",
                    num_nodes);
    }
    ParseRow(path, line, line_number, field.col(row++));
  }
  if (file.bad()) {
    ThrowInputError(path, "the file cannot be read to its end");
  }
  if (row < num_nodes) {
    ThrowRowCount(path, std::to_string(row) + " rows", num_nodes);
  }
  return field;
}

}  // namespace elastimate
