#include "apps/outputs.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cctype>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "apps/flags.h"
#include "apps/signals.h"
#include "elastimate/io/text/file_output.h"
#include "elastimate/io/text/printable.h"

namespace elastimate {
namespace {

namespace fs = std::filesystem;

std::string LowercaseExtension(const fs::path& path) {
  std::string extension = path.extension().string();
  for (char& character : extension) {
    character =
        static_cast<char>(std::tolower(static_cast<unsigned char>(character)));
  }
  return extension;
}

// Returns the input, and whatever a scene.json might name: its mesh and its
// fields.
std::vector<fs::path> FilesBehind(const fs::path& input) {
  using Json = nlohmann::json;
  std::vector<fs::path> files = {input};
  // A pipe is not read here, since it could not be read twice.
  if (LowercaseExtension(input) == ".json" && fs::is_regular_file(input)) {
    const auto collect = [&](int, Json::parse_event_t event, Json& value) {
      if (event == Json::parse_event_t::value && value.is_string()) {
        files.push_back(input.parent_path() / value.get<std::string>());
      }
      return true;
    };
    std::ifstream text(input);
    // The reader says what is wrong with the text.
    const Json ignored = Json::parse(text, collect, false);
  }
  return files;
}

// Tells whether the stream goes to the file.  A terminal or /dev/null may well
// be both.
bool IsStream(const fs::path& path, int stream) {
  struct stat file = {};
  struct stat output = {};
  return stat(path.c_str(), &file) == 0 && fstat(stream, &output) == 0 &&
         !S_ISCHR(output.st_mode) && file.st_dev == output.st_dev &&
         file.st_ino == output.st_ino;
}

void CheckOutputFlag(const std::string& flag, const std::string& file,
                     const std::vector<std::string>& inputs) {
  const std::string given = "--" + flag + "=" + PrintablePath(file);
  for (const std::string& input : inputs) {
    for (const fs::path& behind : FilesBehind(input)) {
      if (AreSameFile(file, behind)) {
        throw std::invalid_argument(given + " would overwrite the input " +
                                    PrintablePath(behind) +
                                    "; choose another file");
      }
    }
  }
  if (IsStream(file, STDOUT_FILENO)) {
    throw std::invalid_argument(
        given + " is where standard output goes; choose another file" +
        (flag == "json" ? ", or --json=-" : ""));
  }
  if (IsStream(file, STDERR_FILENO)) {
    throw std::invalid_argument(
        given + " is where standard error goes; choose another file");
  }
  CheckWritable(file);
}

// Ends a sentence on the name of a file.
std::string EndsOfNames(OutFormats formats) {
  switch (formats) {
    case OutFormats::kVtu:
      break;
    case OutFormats::kVtuOrTable:
      return ".vtu for a scene, or in .csv for a table of points";
    case OutFormats::kTable:
      return ".csv, as a table is written";
    case OutFormats::kJson:
      return ".json, as a scene is written";
    case OutFormats::kPage:
      return ".html, as a page is written";
  }
  return ".vtu, as a VTU file is written";
}

}  // namespace

void OpenClosedStandardStreams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (fcntl(stream, F_GETFD) == -1) {
      // This takes the lowest free descriptor, which is the stream's.  It is
      // opened for reading, so that what is written there does not seem to
      // arrive.
      open("/dev/null", O_RDONLY);
    }
  }
}

bool HasExtension(const std::string& file, const std::string& extension) {
  return LowercaseExtension(file) == extension;
}

void CheckOutputFlags(const std::vector<std::string>& inputs,
                      OutFormats formats) {
  if (!FLAGS_out.empty()) {
    const bool takes_vtu =
        formats == OutFormats::kVtu || formats == OutFormats::kVtuOrTable;
    const bool takes_table =
        formats == OutFormats::kTable || formats == OutFormats::kVtuOrTable;
    const bool is_right =
        (takes_vtu && HasExtension(FLAGS_out, ".vtu")) ||
        (takes_table && HasExtension(FLAGS_out, ".csv")) ||
        (formats == OutFormats::kJson && HasExtension(FLAGS_out, ".json")) ||
        (formats == OutFormats::kPage && HasExtension(FLAGS_out, ".html"));
    if (!is_right) {
      throw std::invalid_argument("--out=" + PrintablePath(FLAGS_out) +
                                  "; the name must end in " +
                                  EndsOfNames(formats));
    }
  }
  if (FLAGS_series == "-") {
    throw std::invalid_argument(
        "--series=- names no file; give one, as in --series=frames.csv");
  }
  std::vector<std::pair<std::string, std::string>> others;
  for (const auto& [flag, file] :
       {std::pair{"out", FLAGS_out}, std::pair{"json", FLAGS_json},
        std::pair{"series", FLAGS_series}}) {
    if (file.empty() || (file == "-" && std::string(flag) == "json")) {
      continue;
    }
    CheckOutputFlag(flag, file, inputs);
    for (const auto& [other_flag, other_file] : others) {
      if (AreSameFile(file, other_file)) {
        throw std::invalid_argument(
            "--" + std::string(flag) + "=" + PrintablePath(file) + " and --" +
            other_flag + "=" + PrintablePath(other_file) +
            " name the same file; choose two");
      }
    }
    others.emplace_back(flag, file);
  }
}

void WriteStandardOutput(const std::string& text) {
  errno = 0;
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() ||
      std::fflush(stdout) != 0) {
    if (errno == EPIPE) {
      EndByClosedPipe();
    }
    throw std::invalid_argument("the standard output cannot be written (" +
                                std::string(strerror(errno)) +
                                "); send it to another place");
  }
}

void PrintNotices(const std::vector<std::string>& notices) {
  for (const std::string& notice : notices) {
    std::cerr << "elastimate: notice: " << Printable(notice, kLongestSentence)
              << "\n";
  }
}

}  // namespace elastimate
