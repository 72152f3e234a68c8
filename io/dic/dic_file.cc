#include "elastimate/io/dic/dic_file.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "elastimate/io/text/csv_table.h"
#include "elastimate/io/text/input_error.h"
#include "elastimate/io/text/printable.h"

namespace elastimate {
namespace {

/// What a program names the columns of x, y, u and v, without their units.
struct Format {
  const char* name;
  std::array<const char*, 4> columns;
  /// Of which a number below `least` marks a point as not found.
  const char* quality;
  double least;
  /// A column without which it is another format.
  const char* mark;
  bool is_in_pixels;
};

// What is more special comes first.
constexpr Format kFormats[] = {
    {"matchid",
     {"coor.X", "coor.Y", "disp.Horizontal Displacement U",
      "disp.Vertical Displacement V"},
     nullptr,
     0,
     nullptr,
     false},
    {"matchid", {"x", "y", "u", "v"}, nullptr, 0, "x_pic", false},
    {"dice",
     {"MODEL_COORDINATES_X", "MODEL_COORDINATES_Y", "MODEL_DISPLACEMENT_X",
      "MODEL_DISPLACEMENT_Y"},
     "SIGMA",
     0,
     nullptr,
     false},
    {"dice",
     {"COORDINATE_X", "COORDINATE_Y", "DISPLACEMENT_X", "DISPLACEMENT_Y"},
     "SIGMA",
     0,
     nullptr,
     true},
    {"aramis", {"x_undef", "y_undef", "u", "v"}, nullptr, 0, nullptr, false},
    {"pyvale", {"x", "y", "u", "v"}, "converged", 0.5, "converged", true},
    {"pyvale",
     {"subset_x", "subset_y", "displacement_u", "displacement_v"},
     "converged",
     0.5,
     nullptr,
     true},
    {"vic", {"X", "Y", "U", "V"}, "sigma", 0, nullptr, false},
    {"vic", {"x", "y", "u", "v"}, "sigma", 0, "sigma", true},
    {"csv", {"x", "y", "ux", "uy"}, nullptr, 0, nullptr, false},
};

/// A name and, behind it in brackets, a unit.
struct Column {
  std::string name;
  std::string unit;
};

Column SplitUnit(const std::string& title) {
  const std::size_t open = title.find('[');
  const std::size_t close = title.find(']', open);
  if (open == std::string::npos || close == std::string::npos) {
    return {title, ""};
  }
  const std::size_t end = title.find_last_not_of(' ', open == 0 ? 0 : open - 1);
  return {title.substr(0, end + 1), title.substr(open + 1, close - open - 1)};
}

std::optional<std::size_t> FindColumn(const CsvTable& table,
                                      const std::string& name) {
  if (const std::optional<std::size_t> whole = table.Find(name)) {
    return whole;
  }
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    if (SplitUnit(table.columns[i]).name == name) {
      return i;
    }
  }
  return std::nullopt;
}

bool Fits(const Format& format, const CsvTable& table) {
  return (format.mark == nullptr || FindColumn(table, format.mark)) &&
         std::all_of(format.columns.begin(), format.columns.end(),
                     [&](const char* name) {
                       return FindColumn(table, name).has_value();
                     });
}

const Format& FindFormat(const CsvTable& table, const std::string& name) {
  const auto found = std::find_if(
      std::begin(kFormats), std::end(kFormats), [&](const Format& format) {
        return (name == "auto" || name == format.name) && Fits(format, table);
      });
  if (found == std::end(kFormats)) {
    std::string titles;
    for (const std::string& title : table.columns) {
      titles += (titles.empty() ? "" : ", ") + Printable(title);
    }
    ThrowInputError(
        table.path,
        "its columns (" + titles + ") are not those of " +
            (name == "auto" ? "a format known here (" + DicFormatNames() + ")"
                            : name) +
            "; name those of x, y, u and v as \"columns\"");
  }
  return *found;
}

/// Where a table has what.
struct Places {
  std::array<std::size_t, 4> columns;
  std::optional<std::size_t> quality;
  double least = 0;
  bool is_in_pixels = false;
};

Places PlacesOf(const CsvTable& table, const Format& format) {
  Places places;
  for (std::size_t i = 0; i < places.columns.size(); ++i) {
    places.columns[i] = *FindColumn(table, format.columns[i]);
  }
  if (format.quality != nullptr) {
    places.quality = FindColumn(table, format.quality);
    places.least = format.least;
  }
  const std::string unit = SplitUnit(table.columns[places.columns[0]]).unit;
  const bool names_pixels =
      unit.find("ixel") != std::string::npos || unit == "px" || unit == "pix";
  places.is_in_pixels = unit.empty() ? format.is_in_pixels : names_pixels;
  return places;
}

Places PlacesOf(const CsvTable& table,
                const std::array<std::string, 4>& columns) {
  Places places;
  for (std::size_t i = 0; i < places.columns.size(); ++i) {
    places.columns[i] = table.At(columns[i]);
  }
  return places;
}

double LengthOfUnit(const CsvTable& table, const Places& places,
                    const DicOptions& options) {
  if (places.is_in_pixels && !options.length_per_pixel) {
    ThrowInputError(table.path,
                    "positions and displacements are in pixels; give "
                    "\"length_per_pixel\"");
  }
  return options.length_per_pixel.value_or(1);
}

// x, y, u and v; not a number where the point was not found.
Eigen::Vector4d PointOf(const CsvTable& table, const CsvTable::Row& row,
                        const Places& places) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  Eigen::Vector4d values;
  for (std::size_t i = 0; i < places.columns.size(); ++i) {
    values(Eigen::Index(i)) =
        table.Number(row, places.columns[i]).value_or(kNone);
  }
  if (places.quality &&
      !(table.Number(row, *places.quality).value_or(kNone) >= places.least)) {
    values.setConstant(kNone);
  }
  return values;
}

}  // namespace

std::string DicFormatNames() {
  std::string names;
  std::string last;
  for (const Format& format : kFormats) {
    if (format.name != last) {
      names += (names.empty() ? "" : ", ") + std::string(format.name);
    }
    last = format.name;
  }
  return names;
}

DicFrame ReadDicFile(const std::filesystem::path& path,
                     const DicOptions& options) {
  const CsvTable table = ReadCsvTable(path);
  DicFrame frame;
  Places places;
  if (options.columns) {
    frame.format = "csv";
    places = PlacesOf(table, *options.columns);
  } else {
    const Format& format = FindFormat(table, options.format);
    frame.format = format.name;
    places = PlacesOf(table, format);
  }
  const double length = LengthOfUnit(table, places, options);
  Eigen::Matrix4Xd points(4, Eigen::Index(table.rows.size()));
  Eigen::Index n = 0;
  for (const CsvTable::Row& row : table.rows) {
    const Eigen::Vector4d point = PointOf(table, row, places);
    if (point.allFinite()) {
      points.col(n++) = length * point;
      frame.lines.push_back(row.line);
    }
  }
  frame.num_invalid = points.cols() - n;
  if (options.flip_y) {
    points.row(1) *= -1;
    points.row(3) *= -1;
  }
  frame.positions = points.topLeftCorner(2, n);
  frame.displacement = points.bottomLeftCorner(2, n);
  return frame;
}

}  // namespace elastimate
