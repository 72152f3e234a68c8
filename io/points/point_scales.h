#ifndef ELASTIMATE_IO_POINTS_POINT_SCALES_H_
#define ELASTIMATE_IO_POINTS_POINT_SCALES_H_

#include <optional>
#include <string>
#include <vector>

#include "elastimate/io/points/point_columns.h"
#include "elastimate/io/text/length_unit.h"

namespace elastimate {

/// Returns the unit of each column: from its title, from the row below the
/// titles, or from the title that the options name; empty without one.  Throws
/// std::invalid_argument, naming the file and the column, where it is not
/// known.
std::vector<std::optional<LengthUnit>> UnitsOf(
    const CsvTable& table, const std::vector<std::size_t>& columns,
    const TableOptions& options);

/// The factors that bring the numbers of a table to one unit of length.
struct PointScales {
  /// The factor of each column, and of each column of standard deviations
  /// behind.
  std::vector<double> factors;
  /// This unit, as the titles have it; empty where they have none.
  std::string unit;
  /// Sentences on what was converted, and which columns have no unit.
  std::vector<std::string> notices;
};

/// Chooses the unit and the factors.  The unit is that of the options, or else
/// of the first column that has a unit of length, so that positions keep theirs
/// and displacements are converted.  Pixels, and tables without any unit, are
/// `length_per_pixel` long in this unit.  Displacements without a unit are
/// taken in that of the positions, with a notice.  `deviations` are the columns
/// of the standard deviations of the displacement, or none; they have its unit
/// unless they have their own.
///
/// Throws std::invalid_argument, naming the file and the column, where a unit
/// is not known, pixels have no scale, a scale has no pixels, or positions
/// without a unit stand beside displacements with one.
PointScales ScalesOf(const CsvTable& table, const PointColumns& columns,
                     const std::vector<std::size_t>& deviations,
                     const TableOptions& options);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_POINTS_POINT_SCALES_H_
