#include "elastimate/io/points/csv_field.h"

#include <optional>
#include <string>

#include "elastimate/io/points/point_columns.h"
#include "elastimate/io/points/point_scales.h"
#include "elastimate/io/text/csv_table.h"
#include "elastimate/io/text/input_error.h"
#include "elastimate/io/text/printable.h"

namespace elastimate {
namespace {

// The columns of x, y and z; empty where there are others as well.
std::vector<std::size_t> ComponentColumns(const ColumnTitles& titles,
                                          int dimension) {
  const int size = static_cast<int>(titles.Size());
  if (size != 3 && !(size == 2 && dimension == 2)) {
    return {};
  }
  std::vector<std::size_t> columns;
  for (const std::string name : {"x", "y", "z"}) {
    const std::vector<std::size_t> found = titles.FindAlike(name);
    if (found.size() == 1 && static_cast<int>(columns.size()) < size) {
      columns.push_back(found[0]);
    }
  }
  if (static_cast<int>(columns.size()) == size) {
    return columns;
  }
  const auto ways = DisplacementColumns(titles, size);
  return ways.empty() ? std::vector<std::size_t>() : ways[0];
}

// Refuses what can hardly be in the unit of the mesh, which no file says.
void CheckUnits(const CsvTable& table,
                const std::vector<std::size_t>& columns) {
  const auto units = UnitsOf(table, columns, {});
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const bool differs =
        units[i].has_value() != units[0].has_value() ||
        (units[i] && units[i]->nanometres != units[0]->nanometres);
    if (differs || (units[i] && units[i]->IsSmall())) {
      ThrowInputError(table.path,
                      "the column '" +
                          Printable(table.titles[columns[i]].text) +
                          "' is in another unit than the mesh; convert it, and "
                          "leave the unit out of the title");
    }
  }
}

}  // namespace

CsvField ReadCsvField(const std::filesystem::path& path, Eigen::Index num_nodes,
                      int dimension) {
  const CsvTable table =
      ReadCsvTable(path, [dimension](const ColumnTitles& titles) {
        return !ComponentColumns(titles, dimension).empty();
      });
  const std::vector<std::size_t> columns =
      ComponentColumns(table.titles, dimension);
  if (columns.empty()) {
    ThrowInputError(
        path, std::string("the header must be ") +
                  (dimension == 3 ? "x,y,z or ux,uy,uz"
                                  : "x,y or ux,uy (or x,y,z or ux,uy,uz)") +
                  ", but has the columns " + table.titles.List() +
                  "; correct it, or give displacements with their positions as "
                  "\"points\"");
  }
  if (static_cast<Eigen::Index>(table.rows.size()) != num_nodes) {
    ThrowInputError(path, "the file has " + std::to_string(table.rows.size()) +
                              " rows below its header, but the mesh has " +
                              std::to_string(num_nodes) +
                              " nodes; give one row per node");
  }
  CheckUnits(table, columns);
  table.CheckDecimalMarks(columns);
  CsvField field;
  field.values.resize(Eigen::Index(columns.size()), num_nodes);
  for (const CsvTable::Row& row : table.rows) {
    const Eigen::Index node = static_cast<Eigen::Index>(field.lines.size());
    for (std::size_t i = 0; i < columns.size(); ++i) {
      const std::optional<double> value = table.Number(row, columns[i]);
      field.values(Eigen::Index(i), node) =
          value ? *value : NumberOfCell(path, "", row.line, columns[i]);
    }
    field.lines.push_back(row.line);
  }
  return field;
}

}  // namespace elastimate
