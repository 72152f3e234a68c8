#include "elastimate/io/points/points_file.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "elastimate/io/points/point_columns.h"
#include "elastimate/io/points/point_scales.h"
#include "elastimate/io/text/csv_table.h"
#include "elastimate/io/text/input_error.h"
#include "elastimate/io/text/printable.h"

namespace elastimate {
namespace {

using Columns = std::vector<std::size_t>;

constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();

// Returns the columns of standard deviations, or none where the file has none.
Columns FindDeviations(const CsvTable& table, int dimension) {
  for (const std::string axes : {"xyz", "uvw"}) {
    const std::string begin = axes == "xyz" ? "sd_u" : "sd_";
    bool has_any = false;
    for (int i = 0; i < dimension; ++i) {
      has_any = has_any || !table.titles.FindAlike(begin + axes[i]).empty();
    }
    Columns columns;
    for (int i = 0; has_any && i < dimension; ++i) {
      columns.push_back(table.At(begin + axes[i]));
    }
    if (has_any) {
      return columns;
    }
  }
  return {};
}

bool IsFound(const CsvTable& table, const CsvTable::Row& row,
             const PointColumns& columns) {
  return !columns.quality ||
         table.Number(row, *columns.quality).value_or(kNoNumber) >=
             columns.least;
}

void CheckPoint(const std::filesystem::path& path, const PointsFile& file,
                Eigen::Index point) {
  const auto fail = [&](Eigen::Index i, const std::string& sentence) {
    ThrowInputError(path, "line " + std::to_string(file.lines[point]) + ": " +
                              "xyz"[i] + " of " + sentence);
  };
  for (Eigen::Index i = 0; i < file.positions.rows(); ++i) {
    const double value = file.displacement(i, point);
    const double sd = file.noise_sd.size() == 0 ? 1 : file.noise_sd(i, point);
    if (!std::isfinite(file.positions(i, point))) {
      fail(i,
           "the position is not a finite number; give the position of each "
           "point, or leave out the row");
    }
    if (std::isinf(value)) {
      fail(i,
           "the displacement is infinite; correct it, or leave the cell "
           "empty");
    }
    if (!std::isnan(value) && !(sd > 0 && std::isfinite(sd))) {
      fail(i,
           "the standard deviation must be positive where a displacement "
           "was measured; correct it");
    }
  }
}

// Returns the points at which something was measured.
std::vector<Eigen::Index> MeasuredPoints(const PointsFile& file) {
  std::vector<Eigen::Index> measured;
  for (Eigen::Index point = 0; point < file.positions.cols(); ++point) {
    if (!file.displacement.col(point).array().isNaN().all()) {
      measured.push_back(point);
    }
  }
  return measured;
}

// Throws where a row is there twice, since it would count as two measurements.
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
                              " repeats the point and displacement of line " +
                              std::to_string(file.lines[twin[0]]) +
                              "; leave one of them out");
  }
}

// Appends the fewest digits that are read as the same number.
void AppendNumber(double value, std::string& text) {
  std::array<char, 32> digits;
  const auto end =
      std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
  text.append(digits.data(), end);
}

}  // namespace

PointsFile ReadPointRows(const std::filesystem::path& path, int dimension,
                         const TableOptions& options) {
  PointColumns found;
  const CsvTable table = ReadTableOfPoints(path, options, dimension, found);
  Columns columns = found.columns;
  const Columns deviations = FindDeviations(table, dimension);
  PointScales scales = ScalesOf(table, found, deviations, options);
  columns.insert(columns.end(), deviations.begin(), deviations.end());
  table.CheckDecimalMarks(columns);
  if (options.flip_y) {
    scales.factors[1] *= -1;
    scales.factors[dimension + 1] *= -1;
  }
  Eigen::MatrixXd values(columns.size(), table.rows.size());
  PointsFile file;
  for (const CsvTable::Row& row : table.rows) {
    auto point = values.col(Eigen::Index(file.lines.size()));
    for (std::size_t i = 0; i < columns.size(); ++i) {
      point(Eigen::Index(i)) =
          scales.factors[i] * table.Number(row, columns[i]).value_or(kNoNumber);
    }
    if (!IsFound(table, row, found)) {
      point.setConstant(kNoNumber);
    }
    file.lines.push_back(row.line);
  }
  file.format = found.format;
  file.positions = values.topRows(dimension);
  file.displacement = values.middleRows(dimension, dimension);
  if (!deviations.empty()) {
    file.noise_sd = values.bottomRows(dimension);
  }
  file.unit = scales.unit;
  file.notices = scales.notices;
  return file;
}

PointsFile ReadPointsFile(const std::filesystem::path& path, int dimension,
                          const TableOptions& options) {
  PointsFile file = ReadPointRows(path, dimension, options);
  const std::vector<Eigen::Index> measured = MeasuredPoints(file);
  if (measured.empty()) {
    ThrowInputError(path,
                    "no row has a displacement; check the columns of "
                    "displacements");
  }
  const std::size_t num_rows = file.lines.size();
  if (measured.size() < num_rows) {
    file.notices.push_back(PrintablePath(path) + ": " +
                           std::to_string(num_rows - measured.size()) + " of " +
                           std::to_string(num_rows) +
                           " points have no displacement and are left out");
  }
  file.positions = file.positions(Eigen::all, measured).eval();
  file.displacement = file.displacement(Eigen::all, measured).eval();
  if (file.noise_sd.size() != 0) {
    file.noise_sd = file.noise_sd(Eigen::all, measured).eval();
  }
  std::vector<std::size_t> lines;
  lines.reserve(measured.size());
  for (const Eigen::Index point : measured) {
    lines.push_back(file.lines[point]);
  }
  file.lines = lines;
  for (Eigen::Index point = 0; point < file.positions.cols(); ++point) {
    CheckPoint(path, file, point);
  }
  if (file.noise_sd.size() != 0) {
    file.noise_sd = file.displacement.array().isNaN().select(1, file.noise_sd);
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
