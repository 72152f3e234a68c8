#include "apps/outlier_lines.h"

#include <cstddef>
#include <filesystem>
#include <map>

#include "elastimate/io/text/printable.h"

namespace elastimate {
namespace {

// A sentence with more lines than this is not read to the end.
constexpr std::size_t kMostLines = 10;

}  // namespace

std::vector<std::string> OutlierLines(
    const std::vector<Outlier>& outliers,
    const std::vector<std::vector<FileLines>>& measured_lines) {
  std::map<std::filesystem::path, std::vector<std::size_t>> lines_of_files;
  for (const Outlier& outlier : outliers) {
    auto place = static_cast<std::size_t>(outlier.index);
    for (const FileLines& file : measured_lines.at(outlier.load_case)) {
      if (place < file.lines.size()) {
        lines_of_files[file.file].push_back(file.lines[place]);
        break;
      }
      place -= file.lines.size();
    }
  }
  std::vector<std::string> sentences;
  for (const auto& [file, lines] : lines_of_files) {
    std::string list;
    for (std::size_t i = 0; i < lines.size() && i < kMostLines; ++i) {
      list += (i == 0 ? "" : ", ") + std::to_string(lines[i]);
    }
    sentences.push_back(
        PrintablePath(file) + ": " +
        (lines.size() == 1
             ? "an outlier is on line "
             : std::to_string(lines.size()) + " outliers are on the lines ") +
        list + (lines.size() > kMostLines ? ", ..." : ""));
  }
  return sentences;
}

}  // namespace elastimate
