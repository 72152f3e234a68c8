#ifndef ELASTIMATE_IO_POINTS_POINT_COLUMNS_H_
#define ELASTIMATE_IO_POINTS_POINT_COLUMNS_H_

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "elastimate/io/points/table_options.h"
#include "elastimate/io/text/csv_table.h"

namespace elastimate {

/// The columns of a table of points.
struct PointColumns {
  std::string format;
  /// The columns of x, y, u, v, or of x, y, z, u, v, w.
  std::vector<std::size_t> columns;
  /// A number below `least` in this column marks a point as not found.
  std::optional<std::size_t> quality;
  double least = 0;
  /// Tells whether columns without a unit are in pixels.
  bool is_in_pixels = false;
};

/// "matchid, vic, ...", for messages.
std::string PointFormatNames();

/// Reads the table (ReadCsvTable) that has the columns which the options name.
/// Without such names it has to have the columns of the format that the options
/// name.  With "auto", the first format that fits a table is taken, and at last
/// columns whose titles say that they are positions and displacements: "x", "X
/// coordinate", "pos_x"; "ux", "U", "dx", "Displacement_x".  Throws
/// std::invalid_argument, naming the file and its columns, where no table has
/// them, or where several may be meant.
CsvTable ReadTableOfPoints(const std::filesystem::path& path,
                           const TableOptions& options, int dimension,
                           PointColumns& columns);

/// Returns the columns whose titles say that they are the components of
/// displacements, for each way to understand the titles.
std::vector<std::vector<std::size_t>> DisplacementColumns(
    const ColumnTitles& titles, int dimension);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_POINTS_POINT_COLUMNS_H_
