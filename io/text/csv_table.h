#ifndef ELASTIMATE_IO_TEXT_CSV_TABLE_H_
#define ELASTIMATE_IO_TEXT_CSV_TABLE_H_

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace elastimate {

/// A file of values separated by commas, semicolons or tabulators, whichever
/// its header has most of, or by spaces where it has none of these.
struct CsvTable {
  struct Row {
    std::size_t line;  ///< In the file, from 1 on.
    std::vector<std::string> cells;
  };

  std::filesystem::path path;
  std::vector<std::string> columns;
  std::vector<Row> rows;  ///< Of one cell for each column.

  /// The place of a column; empty where there is none.  Throws
  /// std::invalid_argument, naming the file, where several have the name.
  std::optional<std::size_t> Find(std::string_view column) const;
  /// Throws std::invalid_argument, naming the file, the columns that there are,
  /// and the one that is missing.
  std::size_t At(std::string_view column) const;
  /// A number, or empty where the cell is.  Throws std::invalid_argument,
  /// naming the file, the line and the column, for anything else.
  std::optional<double> Number(const Row& row, std::size_t column) const;
};

/// A header of several words above rows of one is that of one column.  Cells
/// may be quoted; lines that are blank or begin with # or *** are
/// skipped, and so is a row of units below the header, which has no number.  A
/// comment right above the first row is the header where there is no other and
/// it names as many columns.  Throws std::invalid_argument, naming the file and
/// the line, when a row has another number of cells than the header, or a file
/// has none.
CsvTable ReadCsvTable(const std::filesystem::path& path);

/// The number in a cell; `nan` and `inf` are numbers.  Throws
/// std::invalid_argument: "FILE: line 3, column 2: 'abc' is not a number;
/// correct it".
double NumberOfCell(const std::filesystem::path& path, std::string_view cell,
                    std::size_t line, std::size_t column);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_TEXT_CSV_TABLE_H_
