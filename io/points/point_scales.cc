#include "elastimate/io/points/point_scales.h"

#include <algorithm>
#include <optional>

#include "elastimate/io/text/input_error.h"
#include "elastimate/io/text/length_unit.h"
#include "elastimate/io/text/printable.h"

namespace elastimate {
namespace {

using Units = std::vector<std::optional<LengthUnit>>;

std::string Quoted(const CsvTable& table, std::size_t column) {
  return "'" + Printable(table.titles[column].text) + "'";
}

// Returns "'X [mm]', 'Y [mm]'".
std::string QuotedList(const CsvTable& table,
                       const std::vector<std::size_t>& columns) {
  std::string list;
  for (const std::size_t column : columns) {
    list += (list.empty() ? "" : ", ") + Quoted(table, column);
  }
  return list;
}

// Returns the cell below a title, without brackets.
std::string CellUnit(const CsvTable& table, std::size_t column) {
  const std::string cell =
      column < table.units.size() ? table.units[column] : "";
  const bool has_brackets =
      cell.size() > 1 && (cell[0] == '[' || cell[0] == '(');
  return has_brackets ? cell.substr(1, cell.size() - 2) : cell;
}

// Tells whether the row below the titles has units, rather than other words.
bool HasUnitRow(const CsvTable& table,
                const std::vector<std::size_t>& columns) {
  return std::any_of(columns.begin(), columns.end(), [&](std::size_t column) {
    return LengthUnitOf(CellUnit(table, column)).has_value() ||
           (column < table.units.size() &&
            table.units[column].substr(0, 1) == "[");
  });
}

// Returns the unit as the table writes it, or else as the options do.
std::string UnitText(const CsvTable& table, std::size_t column,
                     bool has_unit_row, const std::string& named) {
  const std::string& own = table.titles[column].unit;
  if (!own.empty()) {
    return own;
  }
  const std::string below = has_unit_row ? CellUnit(table, column) : "";
  return below.empty() ? ColumnTitle(named).unit : below;
}

// Gives displacements without a unit that of the other displacements, or else
// of the positions, and positions that of the other positions.
void FillUnits(const CsvTable& table, const std::vector<std::size_t>& columns,
               std::size_t num_positions, Units& units,
               std::vector<std::string>& notices) {
  const auto is_known = [](const auto& unit) { return unit.has_value(); };
  const auto displacements = units.begin() + std::ptrdiff_t(num_positions);
  const auto of_positions =
      std::find_if(units.begin(), displacements, is_known);
  const auto of_displacements =
      std::find_if(displacements, units.end(), is_known);
  if (of_positions == displacements && of_displacements != units.end()) {
    const std::size_t column = columns[of_displacements - units.begin()];
    ThrowInputError(
        table.path,
        Quoted(table, column) + " is in " + (*of_displacements)->name +
            ", but " + Quoted(table, columns[0]) +
            " has no unit; give it one in the title, or name the columns with "
            "their units, such as \"columns\": {\"x\": \"" +
            Printable(table.titles[columns[0]].name) + " [mm]\", ...}");
  }
  if (of_positions == displacements) {
    return;
  }
  const LengthUnit positions = **of_positions;
  const LengthUnit others =
      of_displacements == units.end() ? positions : **of_displacements;
  std::vector<std::size_t> without;
  for (std::size_t i = 0; i < units.size(); ++i) {
    if (!units[i]) {
      units[i] = i < num_positions ? positions : others;
      without.push_back(columns[i]);
    }
  }
  if (!without.empty()) {
    notices.push_back(PrintablePath(table.path) +
                      ": columns without a unit are taken in that of the "
                      "columns beside them: " +
                      QuotedList(table, without));
  }
}

void CheckScale(const CsvTable& table, const std::vector<std::size_t>& columns,
                const Units& units, const TableOptions& options) {
  const auto pixel =
      std::find_if(units.begin(), units.end(),
                   [](const auto& unit) { return unit && unit->IsPixel(); });
  if (pixel != units.end() && !options.length_per_pixel) {
    ThrowInputError(table.path,
                    "positions or displacements (" +
                        Quoted(table, columns[pixel - units.begin()]) +
                        ") are in pixels; give \"length_per_pixel\"");
  }
  if (pixel == units.end() && units[0] && options.length_per_pixel) {
    ThrowInputError(table.path, "no column is in pixels (" +
                                    Quoted(table, columns[0]) + " is in " +
                                    units[0]->name +
                                    "); leave out \"length_per_pixel\"");
  }
}

// Enters the factors and their unit, and notes what is converted.
void AddFactors(const CsvTable& table, const std::vector<std::size_t>& columns,
                const Units& units, const TableOptions& options,
                PointScales& scales) {
  const auto first =
      std::find_if(units.begin(), units.end(),
                   [](const auto& unit) { return unit && !unit->IsPixel(); });
  const std::optional<LengthUnit> base =
      options.unit || first == units.end() ? options.unit : *first;
  scales.unit = base ? base->name : "";
  std::vector<std::size_t> converted;
  for (std::size_t i = 0; i < units.size(); ++i) {
    if (!units[i] || units[i]->IsPixel()) {
      scales.factors.push_back(options.length_per_pixel.value_or(1));
      continue;
    }
    scales.factors.push_back(units[i]->nanometres / base->nanometres);
    if (scales.factors.back() != 1) {
      converted.push_back(columns[i]);
    }
  }
  if (!converted.empty()) {
    scales.notices.push_back(
        PrintablePath(table.path) + ": columns are converted to " +
        scales.unit +
        (options.unit ? ""
                      : ", the unit of " +
                            Quoted(table, columns[first - units.begin()])) +
        ": " + QuotedList(table, converted));
  }
}

}  // namespace

std::vector<std::optional<LengthUnit>> UnitsOf(
    const CsvTable& table, const std::vector<std::size_t>& columns,
    const TableOptions& options) {
  const bool has_unit_row = HasUnitRow(table, columns);
  Units units;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const std::string text =
        UnitText(table, columns[i], has_unit_row,
                 i < options.columns.size() ? options.columns[i] : "");
    units.push_back(LengthUnitOf(text));
    if (!text.empty() && !units.back()) {
      ThrowInputError(table.path, "the unit '" + Printable(text) +
                                      "' of the column " +
                                      Quoted(table, columns[i]) +
                                      " is not known here; make it one of " +
                                      kLengthUnits + ", pixel");
    }
  }
  return units;
}

PointScales ScalesOf(const CsvTable& table, const PointColumns& found,
                     const std::vector<std::size_t>& deviations,
                     const TableOptions& options) {
  std::vector<std::size_t> columns = found.columns;
  const std::size_t dimension = columns.size() / 2;
  const auto is_known = [](const auto& unit) { return unit.has_value(); };
  PointScales scales;
  Units units = UnitsOf(table, columns, options);
  if (found.is_in_pixels &&
      std::none_of(units.begin(), units.end(), is_known)) {
    std::fill(units.begin(), units.end(), LengthUnitOf("pixel"));
  }
  FillUnits(table, columns, dimension, units, scales.notices);
  const Units of_deviations = UnitsOf(table, deviations, {});
  for (std::size_t i = 0; i < deviations.size(); ++i) {
    columns.push_back(deviations[i]);
    units.push_back(of_deviations[i] ? of_deviations[i] : units[dimension + i]);
  }
  CheckScale(table, columns, units, options);
  AddFactors(table, columns, units, options, scales);
  return scales;
}

}  // namespace elastimate
