#include "elastimate/io/points/point_columns.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

#include "elastimate/io/text/input_error.h"
#include "elastimate/io/text/printable.h"

namespace elastimate {
namespace {

/// The titles that a program gives to the columns of x, y, z, u, v and w,
/// without their units; null where it has no such column.
struct Format {
  const char* name;
  std::array<const char*, 6> columns;
  /// A number below `least` in this column marks a point as not found.
  const char* quality;
  double least;
  /// A table without this column is of another format.
  const char* mark;
  bool is_in_pixels;
};

// Formats whose names are more special come first.
constexpr Format kFormats[] = {
    {"matchid",
     {"coor.X", "coor.Y", "coor.Z", "disp.Horizontal Displacement U",
      "disp.Vertical Displacement V", "disp.Out-Of-Plane: W"},
     nullptr,
     0,
     nullptr,
     false},
    {"matchid", {"x", "y", "z", "u", "v", "w"}, nullptr, 0, "x_pic", false},
    {"dice",
     {"MODEL_COORDINATES_X", "MODEL_COORDINATES_Y", "MODEL_COORDINATES_Z",
      "MODEL_DISPLACEMENT_X", "MODEL_DISPLACEMENT_Y", "MODEL_DISPLACEMENT_Z"},
     "SIGMA",
     0,
     nullptr,
     false},
    {"dice",
     {"COORDINATE_X", "COORDINATE_Y", nullptr, "DISPLACEMENT_X",
      "DISPLACEMENT_Y", nullptr},
     "SIGMA",
     0,
     nullptr,
     true},
    {"aramis",
     {"x_undef", "y_undef", "z_undef", "u", "v", "w"},
     nullptr,
     0,
     nullptr,
     false},
    {"pyvale",
     {"x", "y", nullptr, "u", "v", nullptr},
     "converged",
     0.5,
     "converged",
     true},
    {"pyvale",
     {"subset_x", "subset_y", nullptr, "displacement_u", "displacement_v",
      nullptr},
     "converged",
     0.5,
     nullptr,
     true},
    {"vic", {"X", "Y", "Z", "U", "V", "W"}, "sigma", 0, nullptr, false},
    {"vic", {"x", "y", nullptr, "u", "v", nullptr}, "sigma", 0, "sigma", true},
    {"csv", {"x", "y", "z", "ux", "uy", "uz"}, nullptr, 0, nullptr, false},
};
constexpr char kOwnFormat[] = "csv";

// The columns that match each of some titles.
using Matches = std::vector<std::vector<std::size_t>>;
using Names = std::vector<std::string>;

// Returns nothing where a name has no column.
template <typename Find>
Matches MatchesOf(const Names& names, const Find& find) {
  Matches matches;
  for (const std::string& name : names) {
    matches.push_back(find(name));
    if (matches.back().empty()) {
      return {};
    }
  }
  return matches;
}

// Returns nothing where the format has no such columns.
Names NamesOf(const Format& format, int dimension) {
  Names names;
  for (int i = 0; i < 2 * dimension; ++i) {
    const char* const name =
        format.columns[i < dimension ? i : i - dimension + 3];
    if (name == nullptr) {
      return {};
    }
    names.emplace_back(name);
  }
  return names;
}

Matches FormatMatches(const ColumnTitles& titles, const Format& format,
                      int dimension) {
  if (format.mark != nullptr && titles.Find(format.mark).empty()) {
    return {};
  }
  return MatchesOf(
      NamesOf(format, dimension),
      [&titles](const std::string& name) { return titles.Find(name); });
}

// Adds the matches of "WORDx, WORDy, WORDz" and "xWORD, yWORD, zWORD", unless
// they are there.
void AddMeanings(const ColumnTitles& titles, const std::string& axes,
                 const std::string& word, std::vector<Matches>& meanings) {
  for (const bool is_axis_first : {false, true}) {
    Names names;
    for (const char axis : axes) {
      names.push_back(is_axis_first ? axis + word : word + axis);
    }
    Matches matches = MatchesOf(names, [&titles](const std::string& name) {
      return titles.FindAlike(name);
    });
    if (!matches.empty() && std::find(meanings.begin(), meanings.end(),
                                      matches) == meanings.end()) {
      meanings.push_back(std::move(matches));
    }
  }
}

std::vector<Matches> PositionMeanings(const ColumnTitles& titles,
                                      int dimension) {
  const std::string axes = std::string("xyz").substr(0, dimension);
  std::vector<Matches> meanings;
  for (const char* const word :
       {"", "coordinate", "coordinates", "coord", "coor", "position", "pos",
        "0", "undef", "undeformed"}) {
    AddMeanings(titles, axes, word, meanings);
  }
  return meanings;
}

std::vector<Matches> DisplacementMeanings(const ColumnTitles& titles,
                                          int dimension) {
  std::vector<Matches> meanings;
  for (const char* const word : {"displacement", "disp", "u", "d"}) {
    AddMeanings(titles, std::string("xyz").substr(0, dimension), word,
                meanings);
  }
  for (const char* const word : {"", "displacement", "disp"}) {
    AddMeanings(titles, std::string("uvw").substr(0, dimension), word,
                meanings);
  }
  return meanings;
}

/// Reads titles as the columns of a table of points.
struct Understanding {
  std::string format;
  const Format* of_program = nullptr;
  std::vector<Matches>
      positions;  // In each way, with displacements or without.
  std::vector<Matches> displacements;
};

std::optional<Understanding> Understand(const ColumnTitles& titles,
                                        const TableOptions& options,
                                        int dimension) {
  if (!options.columns.empty()) {
    const Matches matches = MatchesOf(
        options.columns,
        [&titles](const std::string& name) { return titles.FindAlike(name); });
    return matches.empty() ? std::nullopt
                           : std::optional<Understanding>(
                                 {kOwnFormat, nullptr, {matches}, {}});
  }
  const bool is_any = options.format == "auto";
  for (const Format& format : kFormats) {
    if (is_any || options.format == format.name) {
      const Matches matches = FormatMatches(titles, format, dimension);
      if (!matches.empty()) {
        return Understanding{format.name, &format, {matches}, {}};
      }
    }
  }
  if (!is_any && options.format != kOwnFormat) {
    return std::nullopt;
  }
  Understanding meaning = {kOwnFormat, nullptr,
                           PositionMeanings(titles, dimension),
                           DisplacementMeanings(titles, dimension)};
  return meaning.positions.empty() || meaning.displacements.empty()
             ? std::nullopt
             : std::optional(std::move(meaning));
}

std::string NamedKeys(int dimension) {
  return dimension == 2 ? "x, y, u and v" : "x, y, z, u, v and w";
}

void AppendColumns(const CsvTable& table, const std::vector<Matches>& meanings,
                   int dimension, std::vector<std::size_t>& columns) {
  if (meanings.empty()) {
    return;
  }
  if (meanings.size() > 1) {
    ThrowInputError(table.path,
                    "its columns can be read in several ways ('" +
                        Printable(table.titles[meanings[0][0][0]].text) +
                        "' or '" +
                        Printable(table.titles[meanings[1][0][0]].text) +
                        "' of " + table.titles.List() + "); name those of " +
                        NamedKeys(dimension) + " as \"columns\"");
  }
  for (const std::vector<std::size_t>& found : meanings[0]) {
    columns.push_back(table.One(found, table.titles[found[0]].name));
  }
}

void CheckDifferent(const CsvTable& table, std::vector<std::size_t> columns) {
  std::sort(columns.begin(), columns.end());
  const auto same = std::adjacent_find(columns.begin(), columns.end());
  if (same != columns.end()) {
    ThrowInputError(table.path, "the column '" +
                                    Printable(table.titles[*same].text) +
                                    "' is named twice in \"columns\"; name "
                                    "a different one for each component");
  }
}

[[noreturn]] void ThrowUnknown(const CsvTable& table,
                               const TableOptions& options, int dimension) {
  for (const std::string& name : options.columns) {
    table.At(name);
  }
  ThrowInputError(
      table.path,
      "its columns (" + table.titles.List() + ") are not those of " +
          (options.format == "auto"
               ? "a format known here (" + PointFormatNames() + ")"
               : options.format) +
          "; name those of " + NamedKeys(dimension) + " as \"columns\"");
}

}  // namespace

std::string PointFormatNames() {
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

CsvTable ReadTableOfPoints(const std::filesystem::path& path,
                           const TableOptions& options, int dimension,
                           PointColumns& columns) {
  CsvTable table = ReadCsvTable(path, [&](const ColumnTitles& titles) {
    return Understand(titles, options, dimension).has_value();
  });
  const std::optional<Understanding> found =
      Understand(table.titles, options, dimension);
  if (!found) {
    ThrowUnknown(table, options, dimension);
  }
  columns = {};
  columns.format = found->format;
  AppendColumns(table, found->positions, dimension, columns.columns);
  AppendColumns(table, found->displacements, dimension, columns.columns);
  CheckDifferent(table, columns.columns);
  if (found->of_program != nullptr) {
    columns.is_in_pixels = found->of_program->is_in_pixels;
  }
  for (const Format& format : kFormats) {
    // Columns that are named may be those of a program as well.
    const bool is_it = found->of_program == nullptr
                           ? options.format == format.name
                           : found->of_program == &format;
    if (is_it && format.quality != nullptr &&
        !table.titles.Find(format.quality).empty()) {
      columns.quality = table.At(format.quality);
      columns.least = format.least;
    }
  }
  return table;
}

std::vector<std::vector<std::size_t>> DisplacementColumns(
    const ColumnTitles& titles, int dimension) {
  std::vector<std::vector<std::size_t>> ways;
  for (const Matches& matches : DisplacementMeanings(titles, dimension)) {
    std::vector<std::size_t>& way = ways.emplace_back();
    for (const std::vector<std::size_t>& found : matches) {
      way.push_back(found[0]);
    }
  }
  return ways;
}

}  // namespace elastimate
