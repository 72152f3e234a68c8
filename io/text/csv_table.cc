#include "elastimate/io/text/csv_table.h"

#include <csv.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <fstream>
#include <new>
#include <sstream>
#include <system_error>
#include <utility>

#include "elastimate/io/text/input_error.h"
#include "elastimate/io/text/input_file.h"
#include "elastimate/io/text/printable.h"

namespace elastimate {
namespace {

using Cells = std::vector<std::string>;

// The cells of one line, by libcsv; empty when quotes are wrong.
std::optional<Cells> SplitLine(const std::string& line, char delimiter) {
  csv_parser parser;
  if (csv_init(&parser, CSV_STRICT | CSV_STRICT_FINI) != 0) {
    throw std::bad_alloc();
  }
  csv_set_delim(&parser, static_cast<unsigned char>(delimiter));
  Cells cells;
  const auto add = [](void* text, std::size_t size, void* data) {
    static_cast<Cells*>(data)->emplace_back(static_cast<const char*>(text),
                                            size);
  };
  const bool is_read = csv_parse(&parser, line.data(), line.size(), add,
                                 nullptr, &cells) == line.size() &&
                       csv_fini(&parser, add, nullptr, &cells) == 0;
  const int error = csv_error(&parser);
  csv_free(&parser);
  if (!is_read && error != CSV_EPARSE) {
    throw std::bad_alloc();
  }
  return is_read ? std::optional<Cells>(std::move(cells)) : std::nullopt;
}

constexpr char kSpaces[] = " \t\r";

// A space where the header has neither commas, semicolons nor tabulators.
char DelimiterOf(const std::string& header) {
  constexpr std::array<char, 3> kDelimiters = {',', ';', '\t'};
  const char delimiter = *std::max_element(
      kDelimiters.begin(), kDelimiters.end(), [&header](char a, char b) {
        return std::count(header.begin(), header.end(), a) <
               std::count(header.begin(), header.end(), b);
      });
  return header.find(delimiter) == std::string::npos ? ' ' : delimiter;
}

bool IsBlank(const std::string& line) {
  return line.find_first_not_of(kSpaces) == std::string::npos;
}

// "# a comment", "*** a comment".
bool IsComment(const std::string& line) {
  const std::size_t begin = line.find_first_not_of(kSpaces);
  return line[begin] == '#' || line.compare(begin, 3, "***") == 0;
}

// Each run of spaces between words as one delimiter.
std::string WithCommas(const std::string& line) {
  std::istringstream words(line);
  std::string joined;
  for (std::string word; words >> word;) {
    joined += (joined.empty() ? "" : ",") + word;
  }
  return joined;
}

std::optional<Cells> CellsOf(const std::string& line, char delimiter) {
  return delimiter == ' ' ? SplitLine(WithCommas(line), ',')
                          : SplitLine(line, delimiter);
}

void RemoveByteOrderMark(std::string& line) {
  const std::string_view mark = "\xEF\xBB\xBF";
  if (std::string_view(line).substr(0, mark.size()) == mark) {
    line.erase(0, mark.size());
  }
}

bool BeginsWithNumber(const std::string& cell) {
  double value = 0;
  return std::from_chars(cell.data(), cell.data() + cell.size(), value).ec ==
         std::errc();
}

bool HasNumber(const Cells& cells) {
  return std::any_of(cells.begin(), cells.end(), BeginsWithNumber);
}

// The columns that a comment right above the numbers names, as ARAMIS writes
// them; none where it does not name as many.
Cells ColumnsOfComment(const std::string& comment, char delimiter,
                       const Cells& numbers) {
  const std::size_t begin = comment.find_first_not_of("# \t");
  if (begin == std::string::npos ||
      !std::all_of(numbers.begin(), numbers.end(), BeginsWithNumber)) {
    return {};
  }
  const std::optional<Cells> cells = CellsOf(comment.substr(begin), delimiter);
  return cells && cells->size() == numbers.size() ? *cells : Cells{};
}

void CheckCount(const CsvTable& table, CsvTable::Row& row) {
  Cells& cells = row.cells;
  // Behind a delimiter at the end of the line.
  if (cells.size() == table.columns.size() + 1 && cells.back().empty()) {
    cells.pop_back();
  }
  if (cells.size() != table.columns.size()) {
    ThrowInputError(table.path, "line " + std::to_string(row.line) + " has " +
                                    std::to_string(cells.size()) +
                                    " columns where " +
                                    std::to_string(table.columns.size()) +
                                    " are due; correct it");
  }
}

}  // namespace

std::optional<std::size_t> CsvTable::Find(std::string_view column) const {
  const auto found = std::find(columns.begin(), columns.end(), column);
  if (found == columns.end()) {
    return std::nullopt;
  }
  if (std::find(found + 1, columns.end(), column) != columns.end()) {
    ThrowInputError(path, "several columns have the name '" +
                              Printable(column) + "'; name each once");
  }
  return static_cast<std::size_t>(found - columns.begin());
}

std::size_t CsvTable::At(std::string_view column) const {
  const std::optional<std::size_t> place = Find(column);
  if (!place) {
    std::string names;
    for (const std::string& name : columns) {
      names += (names.empty() ? "" : ", ") + Printable(name);
    }
    ThrowInputError(path, "there is no column '" + Printable(column) +
                              "' among " + names + "; add it");
  }
  return *place;
}

std::optional<double> CsvTable::Number(const Row& row,
                                       std::size_t column) const {
  const std::string& cell = row.cells[column];
  return cell.empty() ? std::nullopt
                      : std::optional<double>(
                            NumberOfCell(path, cell, row.line, column));
}

CsvTable ReadCsvTable(const std::filesystem::path& path) {
  CheckReadable(path);
  std::ifstream file(path);
  CsvTable table;
  table.path = path;
  std::string line;
  std::string comment;
  std::string header;
  char delimiter = ',';
  std::size_t number = 0;
  while (std::getline(file, line)) {
    ++number;
    RemoveByteOrderMark(line);
    if (IsBlank(line)) {
      continue;
    }
    if (IsComment(line)) {
      comment = line;
      continue;
    }
    if (table.columns.empty()) {
      delimiter = DelimiterOf(line);
    }
    std::optional<Cells> cells = CellsOf(line, delimiter);
    if (!cells) {
      ThrowInputError(path, "line " + std::to_string(number) +
                                ": the quotes do not match; correct them");
    }
    // One column may have a name of several words.
    if (delimiter == ' ' && table.rows.empty() && cells->size() == 1 &&
        !header.empty()) {
      table.columns = SplitLine(header, ',').value_or(Cells{header});
    }
    if (table.columns.empty()) {
      header = line.substr(0, line.find_last_not_of(kSpaces) + 1);
      table.columns = ColumnsOfComment(comment, delimiter, *cells);
      if (table.columns.empty()) {
        table.columns = std::move(*cells);
        continue;
      }
    }
    CsvTable::Row row = {number, std::move(*cells)};
    if (table.rows.empty() && !HasNumber(row.cells)) {
      continue;
    }
    CheckCount(table, row);
    table.rows.push_back(std::move(row));
  }
  if (file.bad()) {
    ThrowInputError(path, "the file cannot be read to its end");
  }
  if (table.rows.empty()) {
    ThrowInputError(path,
                    "the file has no row of numbers below a header; add them");
  }
  return table;
}

double NumberOfCell(const std::filesystem::path& path, std::string_view cell,
                    std::size_t line, std::size_t column) {
  const auto place = [&] {
    return "line " + std::to_string(line) + ", column " +
           std::to_string(column + 1) + ": ";
  };
  if (cell.empty()) {
    ThrowInputError(path, place() + "the cell is empty; give a number");
  }
  const std::string_view digits = cell[0] == '+' ? cell.substr(1) : cell;
  double value = 0;
  const auto [end, error] =
      std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error == std::errc::result_out_of_range) {
    ThrowInputError(path, place() + "'" + Printable(cell) +
                              "' is beyond the range of a double; correct it");
  }
  if (error != std::errc() || end != digits.data() + digits.size()) {
    ThrowInputError(path, place() + "'" + Printable(cell) +
                              "' is not a number; correct it");
  }
  return value;
}

}  // namespace elastimate
