#include "elastimate/io/points/table_options.h"

#include "elastimate/io/points/point_columns.h"
#include "elastimate/io/text/printable.h"

namespace elastimate {

std::vector<std::string> WithTableKeys(std::vector<std::string> keys) {
  keys.insert(keys.end(),
              {"format", "columns", "unit", "length_per_pixel", "flip_y"});
  return keys;
}

TableOptions ReadTableOptions(const JsonValue& value, int dimension) {
  TableOptions options;
  if (value.Has("format")) {
    const JsonValue format = value.At("format");
    options.format = format.String();
    if (("auto, " + PointFormatNames() + ", ").find(options.format + ", ") ==
        std::string::npos) {
      format.Fail("is \"" + Printable(options.format) +
                  "\"; the formats known here are auto, " + PointFormatNames());
    }
  }
  if (value.Has("columns")) {
    const JsonValue columns = value.At("columns");
    const std::vector<std::string> names =
        dimension == 2 ? std::vector<std::string>{"x", "y", "u", "v"}
                       : std::vector<std::string>{"x", "y", "z", "u", "v", "w"};
    columns.CheckKeys(names);
    for (const std::string& name : names) {
      options.columns.push_back(columns.At(name).String());
    }
  }
  if (value.Has("unit")) {
    const JsonValue unit = value.At("unit");
    options.unit = LengthUnitOf(unit.String());
    if (!options.unit || options.unit->IsPixel()) {
      unit.Fail("is \"" + Printable(unit.String()) +
                "\"; make it the unit of length of the scene, one of " +
                kLengthUnits);
    }
  }
  if (value.Has("length_per_pixel")) {
    options.length_per_pixel = value.At("length_per_pixel").Number();
    if (!(*options.length_per_pixel > 0)) {
      value.At("length_per_pixel").Fail("must be positive");
    }
  }
  options.flip_y = value.Has("flip_y") && value.At("flip_y").Boolean();
  return options;
}

}  // namespace elastimate
