#include "elastimate/io/scene/load_record.h"

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <utility>

#include "elastimate/core/text/numbers.h"
#include "elastimate/io/text/csv_table.h"
#include "elastimate/io/text/input_error.h"
#include "elastimate/io/text/printable.h"

namespace elastimate {
namespace {

// Returns the name of a file without its folder, whichever system wrote it.
std::string WithoutFolder(const std::string& name) {
  return name.substr(name.find_last_of("/\\") + 1);
}

std::string WithoutExtension(const std::string& name) {
  return std::filesystem::path(name).stem().string();
}

/// Finds frames by the names that a record may give them.
class NamedFrames {
 public:
  explicit NamedFrames(const std::vector<std::string>& frames) {
    for (std::size_t i = 0; i < frames.size(); ++i) {
      const std::string name = WithoutFolder(frames[i]);
      whole_.emplace(frames[i], i);
      names_[name].push_back(i);
      stems_[WithoutExtension(name)].push_back(i);
    }
  }

  /// Returns nothing where no frame or more than one may be meant.
  std::optional<std::size_t> Find(const std::string& cell) const {
    if (const auto found = whole_.find(cell); found != whole_.end()) {
      return found->second;
    }
    const std::string name = WithoutFolder(cell);
    // A point in the name may begin its extension, or decimals.
    for (const auto& [places, key] :
         {std::pair(&names_, name), std::pair(&stems_, name),
          std::pair(&stems_, WithoutExtension(name))}) {
      if (const auto found = places->find(key); found != places->end()) {
        return found->second.size() == 1 ? std::optional(found->second[0])
                                         : std::nullopt;
      }
    }
    return std::nullopt;
  }

 private:
  std::map<std::string, std::size_t> whole_;
  std::map<std::string, std::vector<std::size_t>> names_;
  std::map<std::string, std::vector<std::size_t>> stems_;
};

bool IsPlainNumber(const std::string& cell) {
  return cell.find_first_not_of("0123456789+-.,eE") == std::string::npos;
}

// Returns the column that names frames, or nothing where there is none.
std::optional<std::size_t> FindFilesColumn(const JsonValue& record,
                                           const CsvTable& table,
                                           const NamedFrames& frames) {
  if (record.Has("files_column")) {
    return table.At(record.At("files_column").String());
  }
  std::optional<std::size_t> found;
  for (std::size_t column = 0; column < table.titles.Size(); ++column) {
    const bool names_any = std::any_of(
        table.rows.begin(), table.rows.end(), [&](const CsvTable::Row& row) {
          return !IsPlainNumber(row.cells[column]) &&
                 frames.Find(row.cells[column]);
        });
    if (names_any && found) {
      record.Fail("has two columns that name frames, '" +
                  Printable(table.titles[*found].text) + "' and '" +
                  Printable(table.titles[column].text) +
                  "'; name one of them as \"files_column\"");
    }
    found = names_any ? column : found;
  }
  return found;
}

// Returns the row that names each frame.
std::vector<std::size_t> RowsByName(const CsvTable& table, std::size_t column,
                                    const std::vector<std::string>& files,
                                    const NamedFrames& frames) {
  std::vector<std::optional<std::size_t>> row_of(files.size());
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    const std::string& cell = table.rows[row].cells[column];
    const std::string place = "line " + std::to_string(table.rows[row].line) +
                              ": '" + Printable(cell) + "' ";
    const std::optional<std::size_t> frame = frames.Find(cell);
    if (!frame) {
      ThrowInputError(table.path,
                      place +
                          "is not the name of exactly one frame; correct it, "
                          "leave out the row, or add the file to \"frames\"");
    }
    if (row_of[*frame]) {
      ThrowInputError(table.path,
                      place + "names the same frame as line " +
                          std::to_string(table.rows[*row_of[*frame]].line) +
                          "; give one row for each frame");
    }
    row_of[*frame] = row;
  }
  std::vector<std::size_t> rows;
  for (std::size_t i = 0; i < files.size(); ++i) {
    if (!row_of[i]) {
      ThrowInputError(table.path, "no row names the frame " +
                                      Printable(files[i]) + " in the column '" +
                                      Printable(table.titles[column].text) +
                                      "'; add it, or leave out the frame");
    }
    rows.push_back(*row_of[i]);
  }
  return rows;
}

// Returns what mends it that there are not as many rows as frames.
std::string Remedy(const CsvTable& table, std::size_t column,
                   std::size_t num_frames) {
  if (table.rows.size() == num_frames + 1) {
    const double first = table.Number(table.rows[0], column).value_or(0);
    const std::string line = std::to_string(table.rows[0].line);
    return first == 0 ? "leave out line " + line +
                            ", which has no load, as a reference frame has"
                      : "leave out the row of a reference frame";
  }
  return table.rows.size() + 1 == num_frames
             ? "leave a reference frame out of \"files\""
             : "give one row for each frame, in their order";
}

}  // namespace

std::vector<double> ReadLoadRecord(const JsonValue& record,
                                   const std::vector<std::string>& frames) {
  record.CheckKeys({"file", "column", "files_column", "relative_sd"});
  const std::string load = record.At("column").String();
  const std::string files =
      record.Has("files_column") ? record.At("files_column").String() : load;
  const CsvTable table =
      ReadCsvTable(record.File().parent_path() / record.At("file").String(),
                   [&](const ColumnTitles& titles) {
                     return !titles.FindAlike(load).empty() &&
                            !titles.FindAlike(files).empty();
                   });
  const std::size_t column = table.At(load);
  table.CheckDecimalMarks({column});
  const NamedFrames names(frames);
  std::vector<std::size_t> rows(table.rows.size());
  if (const auto by_name = FindFilesColumn(record, table, names)) {
    rows = RowsByName(table, *by_name, frames, names);
  } else if (table.rows.size() == frames.size()) {
    std::iota(rows.begin(), rows.end(), std::size_t{0});
  } else {
    ThrowInputError(
        table.path,
        "the load record has " + Counted(table.rows.size(), "row") + " for " +
            Counted(frames.size(), "frame") + "; " +
            Remedy(table, column, frames.size()) +
            ", or name the column of the file names (\"files_column\")");
  }
  std::vector<double> loads;
  loads.reserve(rows.size());
  for (const std::size_t row : rows) {
    loads.push_back(table.Number(table.rows[row], column)
                        .value_or(std::numeric_limits<double>::quiet_NaN()));
  }
  return loads;
}

}  // namespace elastimate
