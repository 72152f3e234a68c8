#ifndef ELASTIMATE_IO_POINTS_TABLE_OPTIONS_H_
#define ELASTIMATE_IO_POINTS_TABLE_OPTIONS_H_

#include <optional>
#include <string>
#include <vector>

#include "elastimate/io/text/json_value.h"
#include "elastimate/io/text/length_unit.h"

namespace elastimate {

/// The options that say how a table of points is read.
struct TableOptions {
  /// A name among PointFormatNames(), or "auto" for the first format that has
  /// its columns in the table.
  std::string format = "auto";
  /// The titles of x, y, u, v, or x, y, z, u, v, w, for any other format.  They
  /// may have a unit where those of the table have none.
  std::vector<std::string> columns;
  /// The unit of the scene; without it, the unit of the table is taken.
  std::optional<LengthUnit> unit;
  /// The size of a pixel, for columns in pixels.
  std::optional<double> length_per_pixel;
  /// Turns the sign of y and v, where y points down.
  bool flip_y = false;
};

/// Returns `keys` and the keys that ReadTableOptions reads.
std::vector<std::string> WithTableKeys(std::vector<std::string> keys);

/// Reads the options beside the key "points" of a scene.json.  Throws
/// std::invalid_argument, naming the file and the place in it.
TableOptions ReadTableOptions(const JsonValue& value, int dimension);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_POINTS_TABLE_OPTIONS_H_
