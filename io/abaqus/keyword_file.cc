#include "elastimate/io/abaqus/keyword_file.h"

#include <algorithm>
#include <boost/algorithm/string/case_conv.hpp>
#include <boost/algorithm/string/erase.hpp>
#include <boost/algorithm/string/trim.hpp>
#include <utility>

#include "elastimate/io/text/input_error.h"
#include "elastimate/io/text/text_file.h"
#include "elastimate/io/text/trimmed.h"

namespace elastimate {
namespace {

std::string PlainKeyword(std::string_view text) {
  std::string name(text);
  boost::to_upper(name);
  boost::erase_all(name, " ");
  boost::erase_all(name, "\t");
  return name;
}

void ParseOptions(const std::vector<std::string_view>& cells,
                  KeywordBlock& block) {
  for (const std::string_view cell : cells) {
    const std::size_t equals = std::min(cell.find('='), cell.size());
    std::string value(Trimmed(cell.substr(std::min(equals + 1, cell.size()))));
    boost::trim_if(value, boost::is_any_of("\""));
    block.options[PlainKeyword(cell.substr(0, equals))] = value;
  }
}

/// Appends the keywords of files.
class FileParser {
 public:
  explicit FileParser(KeywordFile& file) : file_(file) {}

  void Parse(const std::filesystem::path& path) {
    const std::filesystem::path& kept = file_.paths.emplace_back(path);
    open_.push_back(&kept);
    std::string_view rest = file_.texts.emplace_back(ReadTextFile(path));
    for (std::size_t number = 1; !rest.empty(); ++number) {
      const std::size_t end = std::min(rest.find('\n'), rest.size());
      const std::string_view line = Trimmed(rest.substr(0, end));
      rest.remove_prefix(std::min(end + 1, rest.size()));
      if (!line.empty() && line.substr(0, 2) != "**") {
        ParseLine(line, number);
      }
    }
    if (is_keyword_open_) {
      file_.blocks.back().Fail(
          "the file ends within this keyword; write it again");
    }
    open_.pop_back();
  }

  void CheckEnd() const {
    if (is_in_step_) {
      file_.blocks.back().Fail(
          "this *STEP has no *END STEP; the file was cut, write it again");
    }
  }

 private:
  void ParseLine(std::string_view line, std::size_t number) {
    if (is_keyword_open_ || line.front() == '*') {
      ParseKeyword(line, number);
    } else if (is_in_step_) {
      return;
    } else if (is_skipped_ || file_.blocks.empty()) {
      ThrowInputError(*open_.back(),
                      "line " + std::to_string(number) +
                          ": there are data without a keyword; give an Abaqus "
                          "input file, which begins with a keyword like *NODE");
    } else {
      file_.blocks.back().data.push_back({line, number});
    }
  }

  void ParseKeyword(std::string_view line, std::size_t number) {
    std::vector<std::string_view> cells = KeywordCells(line);
    if (!is_keyword_open_) {
      const std::string name =
          PlainKeyword(cells.empty() ? line : cells[0]).substr(1);
      is_skipped_ = false;
      if (is_in_step_) {
        is_in_step_ = name != "ENDSTEP";
        is_skipped_ = !is_in_step_;
        return;
      }
      file_.blocks.push_back({name, {}, open_.back(), number, {}});
      cells.erase(cells.begin(), cells.begin() + (cells.empty() ? 0 : 1));
    }
    ParseOptions(cells, file_.blocks.back());
    is_keyword_open_ = line.back() == ',';
    if (!is_keyword_open_) {
      Finish();
    }
  }

  void Finish() {
    const std::string& name = file_.blocks.back().name;
    is_in_step_ = name == "STEP";
    if (name == "INCLUDE") {
      const KeywordBlock block = std::move(file_.blocks.back());
      file_.blocks.pop_back();
      Include(block);
    } else if (name == "NODE" || name == "ELEMENT" || name == "NSET" ||
               name == "ELSET") {
      const KeywordBlock block = file_.blocks.back();
      if (block.Has("INPUT")) {
        Include(block);
      }
    }
  }

  void Include(const KeywordBlock& block) {
    std::string input = block.Option("INPUT");
    if (input.empty()) {
      block.Fail("*" + block.name + " names no file; give INPUT=FILE");
    }
    std::replace(input.begin(), input.end(), '\\', '/');  // Of Windows.
    const std::filesystem::path path = block.file->parent_path() / input;
    const auto is_same = [&](const std::filesystem::path* open) {
      return open->lexically_normal() == path.lexically_normal();
    };
    constexpr std::size_t kMostLevels = 20;
    if (open_.size() > kMostLevels ||
        std::any_of(open_.begin(), open_.end(), is_same)) {
      block.Fail("the file includes itself; leave that out");
    }
    Parse(path);
    // Data behind *INCLUDE go on with the keyword of the included file.
  }

  KeywordFile& file_;
  std::vector<const std::filesystem::path*> open_;
  bool is_keyword_open_ = false;
  bool is_in_step_ = false;
  bool is_skipped_ = false;  ///< What stands behind *END STEP.
};

}  // namespace

std::string KeywordBlock::Option(const std::string& name_of_option) const {
  const auto found = options.find(name_of_option);
  return found == options.end() ? "" : found->second;
}

void KeywordBlock::FailAt(std::size_t at, const std::string& sentence) const {
  ThrowInputError(*file, "line " + std::to_string(at) + ": " + sentence);
}

KeywordFile ReadKeywordFile(const std::filesystem::path& path) {
  KeywordFile file;
  FileParser parser(file);
  parser.Parse(path);
  parser.CheckEnd();
  return file;
}

std::vector<std::string_view> KeywordCells(std::string_view line) {
  std::vector<std::string_view> cells;
  bool is_quoted = false;
  std::size_t first = 0;
  for (std::size_t i = 0; i <= line.size(); ++i) {
    if (i < line.size() && line[i] == '"') {
      is_quoted = !is_quoted;
    }
    if (i == line.size() || (line[i] == ',' && !is_quoted)) {
      if (i < line.size() || first < line.size()) {
        cells.push_back(Trimmed(line.substr(first, i - first)));
      }
      first = i + 1;
    }
  }
  return cells;
}

}  // namespace elastimate
