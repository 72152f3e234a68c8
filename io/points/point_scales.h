#ifndef ELASTIMATE_IO_POINTS_POINT_SCALES_H_
#define ELASTIMATE_IO_POINTS_POINT_SCALES_H_

#include <optional>
#include <string>
#include <vector>

#include "elastimate/io/points/point_columns.h"
#include "elastimate/io/text/length_unit.h"

namespace elastimate {

/// The unit of each column: that of its title, of the row below the titles, or
/// of the title that the options name; empty without one.  Throws
/// std::invalid_argument, naming the file and the column, where it is not
/// known.
std::vector<std::optional<LengthUnit>> UnitsOf(
    const CsvTable& table, const std::vector<std::size_t>& columns,
    const TableOptions& options);

/// By what the numbers of a table are multiplied to be in one unit of length.
struct PointScales {
  /// For each of the columns, and the standard deviations behind them.
  std::vector<double> factors;
  /// That unit, of the titles; empty where they have none.
  std::string unit;
  /// What columns were converted, and which have no unit.
  std::vector<std::string> notices;
};

/// The unit is that of the options, or that of the first column which has a
/// unit of length, so that positions keep theirs and displacements are
/// converted.  Pixels, and tables without any unit, have `length_per_pixel` of
/// it.  Columns without a unit are in that of the others, with a notice.
/// `deviations` are those of the displacement, or none, in its unit unless they
/// have their own. Throws std::invalid_argument, naming the file and the
/// column, where a unit is not known, pixels have no scale, a scale has no
/// pixels, or positions without a unit stand beside displacements in pixels, um
/// or nm.
PointScales ScalesOf(const CsvTable& table, const PointColumns& columns,
                     const std::vector<std::size_t>& deviations,
                     const TableOptions& options);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_POINTS_POINT_SCALES_H_
