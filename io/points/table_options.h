#ifndef ELASTIMATE_IO_POINTS_TABLE_OPTIONS_H_
#define ELASTIMATE_IO_POINTS_TABLE_OPTIONS_H_

#include <optional>
#include <string>
#include <vector>

#include "elastimate/io/text/json_value.h"
#include "elastimate/io/text/length_unit.h"

namespace elastimate {

/// How a table of points is read.
struct TableOptions {
  /// A name among PointFormatNames(), or "auto": the first that it has the
  /// columns of.
  std::string format = "auto";
  /// The titles of x, y, u, v, or x, y, z, u, v, w, for any other format.  They
  /// may have a unit where those of the table have none.
  std::vector<std::string> columns;
  /// The unit of the scene; without it, that of the table.
  std::optional<LengthUnit> unit;
  /// For columns in pixels.
  std::optional<double> length_per_pixel;
  /// Turns y and v round, where y points down.
  bool flip_y = false;
};

/// The keys that ReadTableOptions reads, and these.
std::vector<std::string> WithTableKeys(std::vector<std::string> keys);

/// The options beside the key "points" of a scene.json.  Throws
/// std::invalid_argument, naming the file and the place in it.
TableOptions ReadTableOptions(const JsonValue& value, int dimension);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_POINTS_TABLE_OPTIONS_H_
