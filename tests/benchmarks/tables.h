#ifndef ELASTIMATE_TESTS_BENCHMARKS_TABLES_H_
#define ELASTIMATE_TESTS_BENCHMARKS_TABLES_H_

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace elastimate::testing {

// Several studies have these columns.
inline constexpr const char* kYoungsModulusError = "youngs_modulus_error [1]";
inline constexpr const char* kPoissonRatioError = "poisson_ratio_error [1]";

/// Holds the cells of a row by their columns.
class TableRow {
 public:
  explicit TableRow(std::map<std::string, std::string> cells)
      : cells_(std::move(cells)) {}

  const std::string& Text(const std::string& column) const {
    return cells_.at(column);
  }
  /// NaN when the cell is empty.
  double Number(const std::string& column) const {
    const std::string& text = Text(column);
    return text.empty() ? std::numeric_limits<double>::quiet_NaN()
                        : std::stod(text);
  }

 private:
  std::map<std::string, std::string> cells_;
};

inline std::vector<std::string> SplitAtCommas(const std::string& line) {
  std::vector<std::string> cells(1);
  for (const char character : line) {
    if (character == ',') {
      cells.emplace_back();
    } else {
      cells.back() += character;
    }
  }
  return cells;
}

inline std::vector<TableRow> ReadTable(const std::filesystem::path& path) {
  std::ifstream file(path);
  EXPECT_TRUE(file.good()) << path;
  std::string line;
  std::getline(file, line);
  const std::vector<std::string> columns = SplitAtCommas(line);
  std::vector<TableRow> rows;
  while (std::getline(file, line)) {
    const std::vector<std::string> texts = SplitAtCommas(line);
    EXPECT_EQ(texts.size(), columns.size()) << line;
    std::map<std::string, std::string> cells;
    for (std::size_t i = 0; i < columns.size(); ++i) {
      cells[columns[i]] = texts.at(i);
    }
    rows.emplace_back(cells);
  }
  EXPECT_FALSE(rows.empty()) << path;
  return rows;
}

}  // namespace elastimate::testing

#endif  // ELASTIMATE_TESTS_BENCHMARKS_TABLES_H_
