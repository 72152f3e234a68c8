#ifndef ELASTIMATE_IO_ABAQUS_KEYWORD_FILE_H_
#define ELASTIMATE_IO_ABAQUS_KEYWORD_FILE_H_

#include <cstddef>
#include <filesystem>
#include <list>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace elastimate {

/// A line of data.
struct KeywordData {
  std::string_view text;
  std::size_t line;  ///< From 1 on.
};

/// A keyword of an Abaqus input file and the data below it.
struct KeywordBlock {
  std::string name;  ///< In capital letters without spaces: "SOLIDSECTION".
  /// The values of the parameters, without quotes, by their names in capital
  /// letters; empty where there is none.
  std::map<std::string, std::string> options;
  const std::filesystem::path* file;
  std::size_t line;
  std::vector<KeywordData> data;

  bool Has(const std::string& option) const {
    return options.count(option) > 0;
  }
  /// Returns the value of a parameter, or an empty one.
  std::string Option(const std::string& name_of_option) const;
  /// Throws std::invalid_argument: "FILE: line 3: SENTENCE".
  [[noreturn]] void Fail(const std::string& sentence) const {
    FailAt(line, sentence);
  }
  [[noreturn]] void FailAt(std::size_t at, const std::string& sentence) const;
};

/// The keywords of an Abaqus input file and of those that it includes, up to
/// its first step.  Views and pointers refer to what it holds.
struct KeywordFile {
  std::list<std::filesystem::path> paths;
  std::list<std::string> texts;
  std::vector<KeywordBlock> blocks;
};

/// Reads the file.  Comments (**) and blank lines are left out; a keyword line
/// goes on where it ends with a comma.  *INCLUDE, and the parameter INPUT of
/// *NODE, *ELEMENT, *NSET and *ELSET, name files relative to the one that they
/// stand in.  Throws std::invalid_argument, naming the file and
/// the line, where it begins with data, a file includes itself, or a step does
/// not end, which shows a file that was cut.  O(size of the files).
KeywordFile ReadKeywordFile(const std::filesystem::path& path);

/// Returns what stands between commas, without the spaces around it.  A comma
/// at the end of the line begins no cell.
std::vector<std::string_view> KeywordCells(std::string_view line);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_ABAQUS_KEYWORD_FILE_H_
