#ifndef ELASTIMATE_TESTS_PROGRAM_H_
#define ELASTIMATE_TESTS_PROGRAM_H_

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

namespace elastimate::testing {

/// Holds what a run of the program left.
struct ProgramRun {
  int exit_code;
  std::string output;  ///< Standard output.
  std::string errors;  ///< Standard error.

  nlohmann::json Json() const { return nlohmann::json::parse(output); }
};

inline std::string ReadText(const std::filesystem::path& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

inline void WriteText(const std::filesystem::path& path,
                      const std::string& text) {
  std::ofstream(path) << text;
}

/// The test has an empty folder of its own, which is the current one of the
/// program and is removed afterwards.
class ProgramTest : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string pattern =
        (std::filesystem::temp_directory_path() / "elastimate-XXXXXX").string();
    ASSERT_NE(mkdtemp(pattern.data()), nullptr);
    folder_ = pattern;
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  /// Runs the built program with these arguments, as a shell reads them, and
  /// with its standard output sent elsewhere if wanted.
  ProgramRun Run(const std::string& arguments,
                 const std::string& output = ">.output") const {
    WriteText(folder_ / ".output", "");
    const std::string command = "cd '" + folder_.string() +
                                "' && '" ELASTIMATE_PROGRAM "' " + arguments +
                                " 2>.errors </dev/null " + output;
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1,
            ReadText(folder_ / ".output"), ReadText(folder_ / ".errors")};
  }

  /// Runs it and demands success.
  ProgramRun Succeed(const std::string& arguments) const {
    ProgramRun run = Run(arguments);
    EXPECT_EQ(run.exit_code, 0) << arguments << "\n" << run.errors;
    return run;
  }

  /// Runs it and demands exit code 2, one line of error that contains `says`,
  /// nothing on standard output, and all files as they were.
  void Refuse(const std::string& arguments, const std::string& says,
              const std::string& output = ">.output") const {
    SCOPED_TRACE(arguments + " " + output);
    const auto before = Files();
    const ProgramRun run = Run(arguments, output);
    EXPECT_EQ(run.exit_code, 2) << run.errors;
    EXPECT_NE(run.errors.find(says), std::string::npos) << run.errors;
    const std::string prefix =
        std::filesystem::path(ELASTIMATE_PROGRAM).filename().string() + ": ";
    EXPECT_EQ(run.errors.find(prefix), 0U) << run.errors;
    EXPECT_EQ(run.errors.find(prefix + prefix), std::string::npos)
        << run.errors;
    EXPECT_EQ(std::count(run.errors.begin(), run.errors.end(), '\n'), 1)
        << run.errors;
    EXPECT_EQ(run.output, "");
    const auto after = Files();
    for (const auto& [name, content] : before) {
      const auto file = after.find(name);
      EXPECT_TRUE(file != after.end() && file->second == content)
          << name << ": "
          << (file == after.end() ? "removed" : file->second.substr(0, 1000));
    }
    EXPECT_EQ(after.size(), before.size());
  }

  /// Returns the content of every file, or where a link leads, without the
  /// files of the standard streams.
  std::map<std::string, std::string> Files() const {
    std::map<std::string, std::string> files;
    for (const auto& entry :
         std::filesystem::recursive_directory_iterator(folder_)) {
      const std::string name = entry.path().string();
      if (entry.is_symlink()) {  // It may name an open file of the program.
        files[name] = std::filesystem::read_symlink(entry.path()).string();
      } else if (entry.is_regular_file() &&
                 entry.path().filename() != ".output" &&
                 entry.path().filename() != ".errors") {
        files[name] = ReadText(name);
      }
    }
    return files;
  }

  std::filesystem::path folder_;
};

}  // namespace elastimate::testing

#endif  // ELASTIMATE_TESTS_PROGRAM_H_
