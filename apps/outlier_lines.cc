#include "apps/outlier_lines.h"

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>

#include "elastimate/io/text/printable.h"

namespace elastimate {
namespace {

using Numbers = std::vector<std::size_t>;

// Returns the place of an outlier in a file of text, if it is in one.
std::optional<std::pair<std::filesystem::path, std::size_t>> LineOf(
    const Outlier& outlier, const std::vector<FileLines>& files) {
  auto place = static_cast<std::size_t>(outlier.index);
  for (const FileLines& file : files) {
    if (place < file.lines.size()) {
      return std::pair(file.file, file.lines[place]);
    }
    place -= file.lines.size();
  }
  return std::nullopt;
}

std::string ListOf(const Numbers& numbers) {
  // A sentence with more numbers than this is not read to the end.
  constexpr std::size_t kMost = 10;
  std::string list;
  for (std::size_t i = 0; i < numbers.size() && i < kMost; ++i) {
    list += (i == 0 ? "" : ", ") + std::to_string(numbers[i]);
  }
  return list + (numbers.size() > kMost ? ", ..." : "");
}

std::string SentenceOf(const std::filesystem::path& file,
                       const Numbers& numbers, const std::string& place,
                       const std::string& places) {
  return PrintablePath(file) + ": " +
         (numbers.size() == 1
              ? "an outlier is " + place
              : std::to_string(numbers.size()) + " outliers are " + places) +
         " " + ListOf(numbers);
}

}  // namespace

std::vector<std::string> OutlierLines(const std::vector<Outlier>& outliers,
                                      const SceneReading& reading) {
  std::map<std::filesystem::path, Numbers> lines_of_files;
  Numbers nodes;
  for (const Outlier& outlier : outliers) {
    const auto& files = reading.measured_lines.at(outlier.load_case);
    if (const auto line = LineOf(outlier, files)) {
      lines_of_files[line->first].push_back(line->second);
    } else if (!outlier.is_point) {
      nodes.push_back(reading.nodes.numbers.at(outlier.index));
    }
  }
  std::vector<std::string> sentences;
  sentences.reserve(lines_of_files.size() + 1);
  for (const auto& [file, lines] : lines_of_files) {
    sentences.push_back(SentenceOf(file, lines, "on line", "on the lines"));
  }
  if (!nodes.empty()) {
    const std::string& program = reading.nodes.program;
    sentences.push_back(
        SentenceOf(reading.nodes.file, nodes, "at the node", "at the nodes") +
        (program.empty() ? ", counted from 0 as the file does"
                         : " of " + program));
  }
  return sentences;
}

}  // namespace elastimate
