#include "elastimate/io/points/node_table.h"

#include <algorithm>
#include <array>
#include <boost/algorithm/string/erase.hpp>
#include <boost/algorithm/string/predicate.hpp>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string_view>

#include "elastimate/io/text/column_titles.h"
#include "elastimate/io/text/input_error.h"
#include "elastimate/io/text/parsed_number.h"
#include "elastimate/io/text/text_file.h"
#include "elastimate/io/text/trimmed.h"

namespace elastimate {
namespace {

using Cells = std::vector<std::string_view>;

/// Splits at each of `separators` or, where there are none, at blanks, commas
/// and semicolons, several of which count as one.
Cells Split(std::string_view line, std::string_view separators) {
  Cells cells;
  if (separators.empty()) {
    constexpr char kAll[] = " \t\r,;";
    for (std::size_t first = line.find_first_not_of(kAll);
         first != std::string_view::npos;) {
      const std::size_t end =
          std::min(line.find_first_of(kAll, first), line.size());
      cells.push_back(line.substr(first, end - first));
      first = line.find_first_not_of(kAll, end);
    }
    return cells;
  }
  for (std::size_t first = 0; first <= line.size();) {
    const std::size_t end =
        std::min(line.find_first_of(separators, first), line.size());
    cells.push_back(Trimmed(line.substr(first, end - first)));
    first = end + 1;
  }
  return cells;
}

/// The places of what is read in the cells of a row.
struct NodeColumns {
  std::size_t number = 0;
  std::vector<std::size_t> components;
};

/// Returns the columns of titles, if they are those of displacements of nodes.
std::optional<NodeColumns> ColumnsOf(const Cells& titles, int dimension,
                                     bool has_number) {
  static const std::set<std::string> kNumbers = {
      "node", "nodelabel", "nodeid", "nodenumber", "nodeno", "label", "id"};
  static const std::array<std::set<std::string>, 3> kComponents = {
      std::set<std::string>{"ux", "u1", "uu1", "displacementx", "xdisplacement",
                            "vx"},
      {"uy", "u2", "uu2", "displacementy", "ydisplacement", "vy"},
      {"uz", "u3", "uu3", "displacementz", "zdisplacement", "vz"}};
  NodeColumns columns;
  bool is_number_found = !has_number;
  std::array<std::optional<std::size_t>, 3> places;
  for (std::size_t i = 0; i < titles.size(); ++i) {
    std::string name = PlainName(titles[i]);
    boost::erase_all(name, ":");
    boost::erase_all(name, "\"");
    if (!is_number_found && kNumbers.count(name) > 0) {
      columns.number = i;
      is_number_found = true;
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (!places[axis] && kComponents[axis].count(name) > 0) {
        places[axis] = i + (has_number ? 0 : 1);
      }
    }
  }
  for (int axis = 0; axis < dimension; ++axis) {
    if (!is_number_found || !places[axis]) {
      return std::nullopt;
    }
    columns.components.push_back(*places[axis]);
  }
  return columns;
}

/// Reads one line after the other.
class NodeTableReader {
 public:
  NodeTableReader(const std::filesystem::path& path, int dimension)
      : path_(path), dimension_(dimension) {}

  void Read(std::string_view line, std::size_t number) {
    const bool is_whole = !line.empty() && line.back() == '\n';
    line.remove_suffix(is_whole ? 1 : 0);
    line = Trimmed(line);
    if (line.empty()) {
      // Blank lines end a table.
      columns_ = has_rows_ ? std::nullopt : columns_;
    } else if (!ReadTitles(line) && columns_) {
      ReadRow(line, number, is_whole);
    }
  }

  NodeTable Take() {
    if (table_.numbers.empty()) {
      ThrowInputError(path_,
                      "it has no displacements of numbered nodes; give a table "
                      "with the columns node, ux, uy, uz, or the node data "
                      "ux;uy;uz of FEBio");
    }
    table_.displacement = Eigen::Map<const Eigen::MatrixXd>(
        values_.data(), dimension_, Eigen::Index(table_.numbers.size()));
    CheckNumbersDiffer();
    return std::move(table_);
  }

 private:
  /// Tells whether the line says what follows.
  bool ReadTitles(std::string_view line) {
    std::string_view words = line;
    words.remove_prefix(words[0] == '*' ? 1 : 0);
    const std::size_t equals = words.find('=');
    if (equals != std::string_view::npos) {
      const std::string key(Trimmed(words.substr(0, equals)));
      const std::string_view value = Trimmed(words.substr(equals + 1));
      if (boost::iequals(key, "time")) {
        time_ = value;
        return true;
      }
      if (boost::iequals(key, "data")) {
        Begin(ColumnsOf(Split(value, ";"), dimension_, false));
        return true;
      }
    }
    if (boost::istarts_with(line, "displacements (vx,vy,vz)")) {
      const std::size_t at = line.rfind("time");
      time_ = at == std::string_view::npos ? "" : Trimmed(line.substr(at + 4));
      Begin(ColumnsOf({"vx", "vy", "vz"}, dimension_, false));
      return true;
    }
    // Titles of numbers have one of these letters, and most rows have none.
    if (line.find_first_of("dDlL") == std::string_view::npos) {
      return false;
    }
    for (const std::string_view separators : {",", ";", "\t", ""}) {
      const Cells titles = Split(line, separators);
      if (const auto found = ColumnsOf(titles, dimension_, true)) {
        // Another table is of the same state, as of another part.
        columns_ = found;
        separators_ = separators;
        has_rows_ = false;
        table_.num_states = 1;
        return true;
      }
    }
    return false;
  }

  /// Begins a state, which replaces the one before it.
  void Begin(const std::optional<NodeColumns>& columns) {
    columns_ = columns;
    has_rows_ = false;
    separators_ = "";
    if (columns) {
      table_.numbers.clear();
      table_.lines.clear();
      values_.clear();
      ++table_.num_states;
      table_.state = time_.empty() ? "" : "time " + std::string(time_);
    }
  }

  void ReadRow(std::string_view line, std::size_t at, bool is_whole) {
    const Cells cells = Split(line, separators_);
    if (columns_->number >= cells.size()) {
      return;
    }
    const std::string_view first = cells[columns_->number];
    const std::optional<std::size_t> number = ParsedNumber<std::size_t>(first);
    if (!number) {
      if (!separators_.empty() || ParsedNumber<double>(first)) {
        Fail(at, first, "no number of a node");
      }
      return;  // A line below the titles, such as a rule.
    }
    // Programs end each line; tables without separators are theirs.
    if (!is_whole && separators_.empty()) {
      ThrowInputError(path_, "line " + std::to_string(at) +
                                 ": the file is cut, because its last line has "
                                 "no end; write the file again");
    }
    for (const std::size_t place : columns_->components) {
      const std::string_view cell =
          place < cells.size() ? cells[place] : std::string_view();
      const std::optional<double> value = ParsedNumber<double>(cell);
      if (!value || !std::isfinite(*value)) {
        Fail(at, cell, "no finite number");
      }
      values_.push_back(*value);
    }
    table_.numbers.push_back(*number);
    table_.lines.push_back(at);
    has_rows_ = true;
  }

  [[noreturn]] void Fail(std::size_t line, std::string_view cell,
                         const std::string& what) const {
    ThrowInputError(path_, "line " + std::to_string(line) + ": '" +
                               Printable(cell) + "' is " + what +
                               "; correct it");
  }

  void CheckNumbersDiffer() const {
    std::map<std::size_t, std::size_t> lines;
    for (std::size_t i = 0; i < table_.numbers.size(); ++i) {
      const auto [before, is_new] =
          lines.emplace(table_.numbers[i], table_.lines[i]);
      if (!is_new) {
        ThrowInputError(path_, "lines " + std::to_string(before->second) +
                                   " and " + std::to_string(table_.lines[i]) +
                                   " are both of node " +
                                   std::to_string(table_.numbers[i]) +
                                   "; give the specimen alone, at one time");
      }
    }
  }

  const std::filesystem::path path_;
  const int dimension_;
  std::optional<NodeColumns> columns_;
  bool has_rows_ = false;
  std::string_view separators_;
  std::string_view time_;
  NodeTable table_;
  std::vector<double> values_;
};

}  // namespace

NodeTable ReadNodeTable(const std::filesystem::path& path, int dimension) {
  const std::string text = ReadTextFile(path);
  NodeTableReader reader(path, dimension);
  std::string_view rest = text;
  for (std::size_t line = 1; !rest.empty(); ++line) {
    const std::size_t newline = rest.find('\n');
    const std::size_t size =
        newline == std::string_view::npos ? rest.size() : newline + 1;
    reader.Read(rest.substr(0, size), line);
    rest.remove_prefix(size);
  }
  return reader.Take();
}

}  // namespace elastimate
