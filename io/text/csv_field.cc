#include "elastimate/io/text/csv_field.h"

#include <cstddef>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include "elastimate/io/text/csv_table.h"
#include "elastimate/io/text/input_error.h"
#include "elastimate/io/text/input_file.h"

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

void ParseRow(const std::filesystem::path& path, std::string_view line,
              std::size_t line_number, Eigen::Ref<Eigen::VectorXd> row) {
  const std::vector<std::string_view> cells = SplitCells(line);
  if (static_cast<Eigen::Index>(cells.size()) != row.size()) {
    ThrowInputError(path, "line " + std::to_string(line_number) + " has " +
                              std::to_string(cells.size()) + " columns where " +
                              std::to_string(row.size()) +
                              " are due; correct it");
  }
  for (std::size_t column = 0; column < cells.size(); ++column) {
    row[static_cast<Eigen::Index>(column)] =
        NumberOfCell(path, cells[column], line_number, column);
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
  std::size_t line_number = 2;
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
