#include "elastimate/io/points/points_file.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "elastimate/io/text/csv_table.h"
#include "elastimate/io/text/input_error.h"

namespace elastimate {
namespace {

using Columns = std::vector<std::size_t>;

constexpr std::array<const char*, 3> kPositions = {"x", "y", "z"};
constexpr std::array<const char*, 3> kDisplacements = {"ux", "uy", "uz"};
constexpr std::array<const char*, 3> kDeviations = {"sd_ux", "sd_uy", "sd_uz"};

Columns Find(const CsvTable& table, const std::array<const char*, 3>& names,
             int dimension) {
  Columns columns;
  for (int i = 0; i < dimension; ++i) {
    columns.push_back(table.At(names[i]));
  }
  return columns;
}

// The columns of standard deviations; none where the file has none of them.
Columns FindDeviations(const CsvTable& table, int dimension) {
  bool has_any = false;
  for (int i = 0; i < dimension; ++i) {
    has_any = has_any || table.Find(kDeviations[i]);
  }
  return has_any ? Find(table, kDeviations, dimension) : Columns{};
}

std::string Place(const CsvTable& table, const CsvTable::Row& row,
                  std::size_t column) {
  return "line " + std::to_string(row.line) + ": " + table.columns[column];
}

double Position(const CsvTable& table, const CsvTable::Row& row,
                std::size_t column) {
  const std::optional<double> value = table.Number(row, column);
  if (!value || !std::isfinite(*value)) {
    ThrowInputError(table.path,
                    Place(table, row, column) +
                        " is not a finite number; give the position of each "
                        "point, or leave out the row");
  }
  return *value;
}

double Displacement(const CsvTable& table, const CsvTable::Row& row,
                    std::size_t column) {
  const double value = table.Number(row, column)
                           .value_or(std::numeric_limits<double>::quiet_NaN());
  if (std::isinf(value)) {
    ThrowInputError(table.path,
                    Place(table, row, column) +
                        " is infinite; correct it, or leave the cell empty");
  }
  return value;
}

double Deviation(const CsvTable& table, const CsvTable::Row& row,
                 std::size_t column) {
  const double value = table.Number(row, column).value_or(0);
  if (!(value > 0 && std::isfinite(value))) {
    ThrowInputError(table.path, Place(table, row, column) +
                                    " must be positive where a displacement "
                                    "was measured; correct it");
  }
  return value;
}

// A row that is there twice would count as two measurements.
void CheckRowsDiffer(const std::filesystem::path& path,
                     const PointsFile& file) {
  Eigen::MatrixXd rows(2 * file.positions.rows(), file.positions.cols());
  rows << file.positions, file.displacement;
  std::vector<Eigen::Index> order;
  for (Eigen::Index point = 0; point < rows.cols(); ++point) {
    if (rows.col(point).allFinite()) {
      order.push_back(point);
    }
  }
  const auto is_less = [&rows](Eigen::Index a, Eigen::Index b) {
    return std::lexicographical_compare(rows.col(a).begin(), rows.col(a).end(),
                                        rows.col(b).begin(), rows.col(b).end());
  };
  std::stable_sort(order.begin(), order.end(), is_less);
  const auto twin = std::adjacent_find(
      order.begin(), order.end(),
      [&](Eigen::Index a, Eigen::Index b) { return !is_less(a, b); });
  if (twin != order.end()) {
    ThrowInputError(path, "line " + std::to_string(file.lines[twin[1]]) +
                              " has the same point and displacement as line " +
                              std::to_string(file.lines[twin[0]]) +
                              "; leave one out");
  }
}

// The fewest digits that are read as the same number.
void AppendNumber(double value, std::string& text) {
  std::array<char, 32> digits;
  const auto end =
      std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
  text.append(digits.data(), end);
}

}  // namespace

PointsFile ReadPointsFile(const std::filesystem::path& path, int dimension) {
  const CsvTable table = ReadCsvTable(path);
  const Columns x = Find(table, kPositions, dimension);
  const Columns u = Find(table, kDisplacements, dimension);
  const Columns sd = FindDeviations(table, dimension);
  const Eigen::Index n = static_cast<Eigen::Index>(table.rows.size());
  PointsFile file;
  file.positions.resize(dimension, n);
  file.displacement.resize(dimension, n);
  if (!sd.empty()) {
    file.noise_sd.setOnes(dimension, n);
  }
  for (Eigen::Index point = 0; point < n; ++point) {
    const CsvTable::Row& row = table.rows[point];
    file.lines.push_back(row.line);
    for (int i = 0; i < dimension; ++i) {
      file.positions(i, point) = Position(table, row, x[i]);
      file.displacement(i, point) = Displacement(table, row, u[i]);
      if (!sd.empty() && !std::isnan(file.displacement(i, point))) {
        file.noise_sd(i, point) = Deviation(table, row, sd[i]);
      }
    }
  }
  CheckRowsDiffer(path, file);
  return file;
}

std::string PointsContent(const Eigen::MatrixXd& positions,
                          const Eigen::MatrixXd& displacement) {
  const Eigen::Index dimension = positions.rows();
  std::string text = dimension == 2 ? "x,y,ux,uy\n" : "x,y,z,ux,uy,uz\n";
  for (Eigen::Index point = 0; point < positions.cols(); ++point) {
    for (Eigen::Index i = 0; i < 2 * dimension; ++i) {
      AppendNumber(i < dimension ? positions(i, point)
                                 : displacement(i - dimension, point),
                   text);
      text += i + 1 < 2 * dimension ? ',' : '\n';
    }
  }
  return text;
}

}  // namespace elastimate
