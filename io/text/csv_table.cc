#include "elastimate/io/text/csv_table.h"

#include <csv.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <new>
#include <system_error>
#include <utility>

#include "elastimate/io/text/input_error.h"
#include "elastimate/io/text/printable.h"
#include "elastimate/io/text/text_file.h"

namespace elastimate {
namespace {

using CellTexts = std::vector<std::string>;

// Returns the cells of one line, by libcsv; nothing when quotes are wrong.
std::optional<CellTexts> SplitLine(std::string_view line, char delimiter) {
  csv_parser parser;
  if (csv_init(&parser, CSV_STRICT | CSV_STRICT_FINI) != 0) {
    throw std::bad_alloc();
  }
  csv_set_delim(&parser, static_cast<unsigned char>(delimiter));
  CellTexts cells;
  const auto add = [](void* text, std::size_t size, void* data) {
    static_cast<CellTexts*>(data)->emplace_back(static_cast<const char*>(text),
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
  return is_read ? std::optional<CellTexts>(std::move(cells)) : std::nullopt;
}

constexpr char kSpaces[] = " \t";
// Separators are tried in this order: a semicolon or a tabulator is no part of
// a number.
constexpr std::array<char, 4> kDelimiters = {';', '\t', ',', ' '};

// Returns the separator of which a line has most; a space where it has none.
char DelimiterOf(std::string_view line) {
  const char delimiter = *std::max_element(
      kDelimiters.begin(), kDelimiters.end() - 1, [&line](char a, char b) {
        return std::count(line.begin(), line.end(), a) <
               std::count(line.begin(), line.end(), b);
      });
  return line.find(delimiter) == std::string::npos ? ' ' : delimiter;
}

bool IsBlank(std::string_view line) {
  return line.find_first_not_of(kSpaces) == std::string_view::npos;
}

// Matches "# a comment" and "*** a comment".
bool IsComment(std::string_view line) {
  const std::size_t begin = line.find_first_not_of(kSpaces);
  return line[begin] == '#' || line.compare(begin, 3, "***") == 0;
}

// Splits at spaces outside of quotes; nothing when quotes are wrong.
std::optional<CellTexts> SplitWords(std::string_view line) {
  CellTexts words;
  bool is_quoted = false;
  bool is_in_word = false;
  for (const char c : line) {
    const bool is_space =
        std::string_view(kSpaces).find(c) != std::string_view::npos;
    if (is_space && !is_quoted) {
      is_in_word = false;
      continue;
    }
    if (!is_in_word) {
      words.emplace_back();
      is_in_word = true;
    }
    if (c == '"') {
      is_quoted = !is_quoted;
    } else {
      words.back() += c;
    }
  }
  return is_quoted ? std::nullopt : std::optional<CellTexts>(std::move(words));
}

std::optional<CellTexts> CellsOf(std::string_view line, char delimiter) {
  return delimiter == ' ' ? SplitWords(line) : SplitLine(line, delimiter);
}

// Returns the titles that a line has; nothing when quotes are wrong.
std::optional<CellTexts> TitlesOf(std::string_view line, char delimiter) {
  std::optional<CellTexts> cells = CellsOf(line, delimiter);
  if (!cells) {
    return cells;
  }
  CellTexts titles;
  for (std::string& cell : *cells) {
    const bool is_unit =
        delimiter == ' ' && !cell.empty() && (cell[0] == '[' || cell[0] == '(');
    if (is_unit && !titles.empty()) {
      titles.back() += " " + cell;
    } else {
      titles.push_back(std::move(cell));
    }
  }
  while (!titles.empty() && titles.back().empty()) {
    titles.pop_back();
  }
  return titles;
}

// The number may have a decimal comma.
bool IsNumberText(const std::string& cell) {
  const std::size_t sign = cell.empty() || cell[0] != '+' ? 0 : 1;
  std::string text = cell.substr(sign);
  std::replace(text.begin(), text.end(), ',', '.');
  double value = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  return error != std::errc::invalid_argument && stop == end;
}

bool HasNumber(const CellTexts& cells) {
  return std::any_of(cells.begin(), cells.end(), IsNumberText);
}

// Empty cells may stand for numbers.
bool HasOnlyNumbers(const CellTexts& cells) {
  return std::all_of(cells.begin(), cells.end(), [](const std::string& cell) {
    return cell.empty() || IsNumberText(cell);
  });
}

// The titles that were found, and what separates them.
struct TitleLine {
  ColumnTitles titles;
  char delimiter;
};

std::optional<TitleLine> FindTitles(std::string_view line,
                                    const IsTable& is_table) {
  const std::optional<CellTexts> usual = CellsOf(line, DelimiterOf(line));
  if (usual && HasOnlyNumbers(*usual)) {
    return std::nullopt;
  }
  for (const char delimiter : kDelimiters) {
    // The first separator, of which the line has none, makes one title of it.
    if (delimiter != kDelimiters[0] &&
        line.find(delimiter) == std::string_view::npos) {
      continue;
    }
    if (const std::optional<CellTexts> texts = TitlesOf(line, delimiter)) {
      ColumnTitles titles(*texts);
      if (is_table(titles)) {
        return TitleLine{std::move(titles), delimiter};
      }
    }
  }
  return std::nullopt;
}

// Reads a table line by line.
class TableReader {
 public:
  TableReader(const std::filesystem::path& path, const IsTable& is_table)
      : is_table_(is_table) {
    table_.path = path;
  }

  void Add(std::string_view line, std::size_t number) {
    if (IsBlank(line)) {
      return;
    }
    if (IsComment(line)) {
      AddComment(line);
    } else if (has_titles_ || (of_comment_ && TakeComment(line))) {
      AddRow(line, number);
    } else {
      AddTitles(line);
    }
  }

  CsvTable Table() {
    if (!has_titles_) {
      table_.titles = ColumnTitles(likely_);
    }
    // Rows with another separator have no numbers either.
    if (has_titles_ && table_.rows.empty() && !table_.units.empty() &&
        table_.units.size() != table_.titles.Size()) {
      ThrowCount(table_.units.size(), line_of_units_);
    }
    if (has_titles_ ? table_.rows.empty() : likely_.empty()) {
      ThrowInputError(
          table_.path,
          "the file has no row of numbers below a line of titles; add both");
    }
    return std::move(table_);
  }

 private:
  void AddComment(std::string_view line) {
    const std::size_t begin = line.find_first_not_of("#* \t");
    if (!has_titles_ && begin != std::string_view::npos) {
      if (auto found = FindTitles(line.substr(begin), is_table_)) {
        of_comment_ = std::move(found);
      }
    }
  }

  // Tells whether the titles of a comment belong to the row of numbers below
  // it.
  bool TakeComment(std::string_view row) {
    const TitleLine comment = std::move(*of_comment_);
    of_comment_.reset();
    std::vector<char> delimiters = {comment.delimiter};
    delimiters.insert(delimiters.end(), kDelimiters.begin(), kDelimiters.end());
    for (const char delimiter : delimiters) {
      std::optional<CellTexts> cells = CellsOf(row, delimiter);
      if (cells && cells->size() > comment.titles.Size() &&
          cells->back().empty()) {
        cells->pop_back();
      }
      if (cells && cells->size() == comment.titles.Size() &&
          HasOnlyNumbers(*cells) && HasNumber(*cells)) {
        table_.titles = comment.titles;
        table_.delimiter = delimiter;
        has_titles_ = true;
        return true;
      }
    }
    return false;
  }

  void AddTitles(std::string_view line) {
    if (std::optional<TitleLine> found = FindTitles(line, is_table_)) {
      table_.titles = std::move(found->titles);
      table_.delimiter = found->delimiter;
      has_titles_ = true;
      return;
    }
    const std::optional<CellTexts> cells = TitlesOf(line, DelimiterOf(line));
    if (cells && (likely_.empty() ||
                  (!HasNumber(*cells) &&
                   (HasNumber(likely_) || cells->size() > likely_.size())))) {
      likely_ = *cells;
    }
  }

  void AddRow(std::string_view line, std::size_t number) {
    std::optional<CellTexts> cells = CellsOf(line, table_.delimiter);
    if (!cells) {
      ThrowInputError(table_.path,
                      "line " + std::to_string(number) +
                          ": the quotes do not match; correct them");
    }
    while (cells->size() > table_.titles.Size() && cells->back().empty()) {
      cells->pop_back();
    }
    if (table_.rows.empty() && !HasNumber(*cells)) {
      if (table_.units.empty()) {
        table_.units = std::move(*cells);
        line_of_units_ = number;
      }
      return;
    }
    if (cells->size() != table_.titles.Size()) {
      ThrowCount(cells->size(), number);
    }
    table_.rows.push_back({number, std::move(*cells)});
  }

  [[noreturn]] void ThrowCount(std::size_t num_cells, std::size_t line) const {
    ThrowInputError(
        table_.path,
        "line " + std::to_string(line) + " has " + std::to_string(num_cells) +
            " columns, but the titles have " +
            std::to_string(table_.titles.Size()) + "; correct it" +
            (table_.delimiter == ',' && num_cells > table_.titles.Size()
                 ? ", and separate the columns by semicolons where the comma "
                   "is the decimal mark"
                 : ""));
  }

  const IsTable& is_table_;
  CsvTable table_;
  std::size_t line_of_units_ = 0;
  bool has_titles_ = false;
  std::optional<TitleLine> of_comment_;
  CellTexts likely_;  // Titles, should none be found.
};

}  // namespace

std::size_t CsvTable::One(const std::vector<std::size_t>& found,
                          std::string_view title) const {
  if (found.empty()) {
    ThrowInputError(path, "there is no column '" + Printable(title) +
                              "' among " + titles.List() + "; add it");
  }
  if (found.size() > 1) {
    ThrowInputError(path, "several columns have the name '" + Printable(title) +
                              "' (" + Printable(titles[found[0]].text) + ", " +
                              Printable(titles[found[1]].text) +
                              "); name each once");
  }
  return found[0];
}

std::size_t CsvTable::At(std::string_view title) const {
  return One(titles.FindAlike(title), title);
}

std::optional<double> CsvTable::Number(const Row& row,
                                       std::size_t column) const {
  const std::string& cell = row.cells[column];
  if (cell.empty()) {
    return std::nullopt;
  }
  const std::size_t comma =
      delimiter == ',' ? std::string::npos : cell.find(',');
  if (comma == std::string::npos || cell.find('.') != std::string::npos) {
    return NumberOfCell(path, cell, row.line, column);
  }
  std::string with_point = cell;
  with_point[comma] = '.';
  return NumberOfCell(path, with_point, row.line, column);
}

void CsvTable::CheckDecimalMarks(
    const std::vector<std::size_t>& columns) const {
  const Row* with_comma = nullptr;
  const Row* with_point = nullptr;
  for (const Row& row : rows) {
    for (const std::size_t column : columns) {
      const std::string& cell = row.cells[column];
      with_comma = cell.find(',') != std::string::npos ? &row : with_comma;
      with_point = cell.find('.') != std::string::npos ? &row : with_point;
    }
    if (with_comma != nullptr && with_point != nullptr) {
      ThrowInputError(path, "line " + std::to_string(with_comma->line) +
                                " has a decimal comma and line " +
                                std::to_string(with_point->line) +
                                " a decimal point; write all with points");
    }
  }
}

CsvTable ReadCsvTable(const std::filesystem::path& path,
                      const IsTable& is_table) {
  const std::string text = ReadTextFile(path);
  TableReader reader(path, is_table);
  std::string_view rest = text;
  for (std::size_t number = 1; !rest.empty(); ++number) {
    const std::size_t end = std::min(rest.find_first_of("\r\n"), rest.size());
    reader.Add(rest.substr(0, end), number);
    rest.remove_prefix(end);
    rest.remove_prefix(rest.substr(0, 2) == "\r\n"
                           ? 2
                           : std::min<std::size_t>(1, rest.size()));
  }
  return reader.Table();
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
                              (cell.find(',') == std::string_view::npos
                                   ? "' is not a number; correct it"
                                   : "' has a comma; write a point, or put "
                                     "semicolons between the columns"));
  }
  return value;
}

}  // namespace elastimate
