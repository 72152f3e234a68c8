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

/// Where a table of points has what.
struct PointColumns {
  std::string format;
  /// The columns of x, y, u, v, or of x, y, z, u, v, w.
  std::vector<std::size_t> columns;
  /// A number below `least` in it marks a point as not found.
  std::optional<std::size_t> quality;
  double least = 0;
  /// What columns without a unit are.
  bool is_in_pixels = false;
};

/// "matchid, vic, ...", for messages.
std::string PointFormatNames();

/// Reads the table (ReadCsvTable) that has the columns which the options name;
/// else those of their format; else, with "auto", those of the first format
/// that a table has the columns of, and at last those whose titles say that
/// they are positions and displacements: "x", "X coordinate", "pos_x"; "ux",
/// "U", "dx", "Displacement_x".  Throws std::invalid_argument, naming the file
/// and its columns, where no table has them, or several may be meant.
CsvTable ReadTableOfPoints(const std::filesystem::path& path,
                           const TableOptions& options, int dimension,
                           PointColumns& columns);

/// The columns whose titles say that they are the components of displacements,
/// in each way in which they may be understood.
std::vector<std::vector<std::size_t>> DisplacementColumns(
    const ColumnTitles& titles, int dimension);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_POINTS_POINT_COLUMNS_H_
