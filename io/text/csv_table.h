#ifndef ELASTIMATE_IO_TEXT_CSV_TABLE_H_
#define ELASTIMATE_IO_TEXT_CSV_TABLE_H_

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "elastimate/io/text/column_titles.h"

namespace elastimate {

/// A table of a text file, with cells that are separated by semicolons,
/// tabulators, commas or spaces.
struct CsvTable {
  struct Row {
    std::size_t line;  ///< In the file, from 1 on.
    std::vector<std::string> cells;
  };

  std::filesystem::path path;
  ColumnTitles titles;
  /// The cells of a row without numbers below the titles; it may be shorter.
  std::vector<std::string> units;
  std::vector<Row> rows;  ///< Each has one cell for each column.
  char delimiter = ',';

  /// Returns the place of a column by its title (ColumnTitles::FindAlike).
  /// Throws std::invalid_argument, naming the file and the columns that there
  /// are, where no column or several columns have that title.
  std::size_t At(std::string_view title) const;
  /// Throws, as At does, unless exactly one is found.
  std::size_t One(const std::vector<std::size_t>& found,
                  std::string_view title) const;
  /// Returns a number, or nothing where the cell is empty.  A comma is a
  /// decimal mark where cells are not separated by commas.  Throws
  /// std::invalid_argument, naming the file, the line and the column, for
  /// anything else.
  std::optional<double> Number(const Row& row, std::size_t column) const;
  /// Throws std::invalid_argument, naming the file and two lines, where numbers
  /// of the columns have decimal commas and decimal points.
  void CheckDecimalMarks(const std::vector<std::size_t>& columns) const;
};

/// Tells whether these are the titles of the table that is looked for.
using IsTable = std::function<bool(const ColumnTitles&)>;

/// Reads the first table whose titles `is_table` takes; what stands above it is
/// skipped.  Cells may be quoted.  Where words are separated by spaces, "[mm]"
/// and "(mm)" belong to the word before them.  Lines that are blank or begin
/// with # or *** are skipped, but a comment right above the first row has the
/// titles where it names as many.  Without such a table there are no rows, and
/// the titles are those of the line that looks most like it, for a message.
///
/// Throws std::invalid_argument, naming the file and the line, where a row has
/// another number of cells than titles, or the table has no row.
/// O(size of the file).
CsvTable ReadCsvTable(const std::filesystem::path& path,
                      const IsTable& is_table);

/// Returns the number in a cell; `nan` and `inf` are numbers.  Throws
/// std::invalid_argument: "FILE: line 3, column 2: 'abc' is not a number;
/// correct it".
double NumberOfCell(const std::filesystem::path& path, std::string_view cell,
                    std::size_t line, std::size_t column);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_TEXT_CSV_TABLE_H_
