// README.md and docs/ show output, flags and names of the program.  These tests
// check that the program agrees with them.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "elastimate/estimators/interface/finding.h"
#include "elastimate/estimators/registry.h"
#include "elastimate/io/scene/scene_reader.h"
#include "tests/program.h"

namespace elastimate {
namespace {

using nlohmann::json;

// Numbers in sample outputs may differ by this much, relative to their size,
// since another BLAS rounds otherwise.
constexpr double kRounding = 1e-2;

std::filesystem::path Source(const std::string& name) {
  return std::filesystem::path(ELASTIMATE_SOURCE) / name;
}

/// Returns the blocks of code of that language; "" stands for no language.
std::vector<std::string> Blocks(const std::string& document,
                                const std::string& language) {
  std::vector<std::string> blocks;
  std::istringstream text(testing::ReadText(Source(document)));
  bool is_inside = false;
  bool is_wanted = false;
  for (std::string line; std::getline(text, line);) {
    if (line.rfind("```", 0) == 0) {
      is_inside = !is_inside;
      is_wanted = is_inside && line.substr(3) == language;
      if (is_wanted) {
        blocks.emplace_back();
      }
    } else if (is_wanted) {
      blocks.back() += line + "\n";
    }
  }
  return blocks;
}

std::vector<std::string> Lines(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) {
    lines.push_back(line);
  }
  return lines;
}

/// The texts may differ only by what rounding does to their numbers.
void ExpectAlike(const std::string& actual, const std::string& expected) {
  std::istringstream actual_words(actual);
  std::istringstream expected_words(expected);
  std::string word;
  for (std::string wanted; expected_words >> wanted;) {
    ASSERT_TRUE(actual_words >> word) << "\n" << actual << "\n" << expected;
    char* end = nullptr;
    const double number = std::strtod(wanted.c_str(), &end);
    if (end == wanted.c_str()) {
      EXPECT_EQ(word, wanted) << "\n" << actual << "\n" << expected;
    } else {
      EXPECT_NEAR(std::atof(word.c_str()), number, kRounding * std::abs(number))
          << "\n"
          << actual << "\n"
          << expected;
    }
  }
  EXPECT_FALSE(actual_words >> word) << "\n" << actual << "\n" << expected;
}

/// The two have the same keys and alike values, except that times and counts of
/// work may differ.
void ExpectAlike(const json& actual, const json& expected) {
  ASSERT_STREQ(actual.type_name(), expected.type_name())
      << actual << " " << expected;
  if (expected.is_structured()) {
    ASSERT_EQ(actual.size(), expected.size()) << actual << " " << expected;
    for (const auto& [key, value] : expected.items()) {
      if (key == "seconds" || key == "work") {
        continue;
      }
      SCOPED_TRACE(key);
      if (expected.is_object()) {
        ASSERT_TRUE(actual.contains(key));
        ExpectAlike(actual[key], value);
      } else {
        ExpectAlike(actual[std::stoul(key)], value);
      }
    }
  } else if (expected.is_number()) {
    EXPECT_NEAR(actual.get<double>(), expected.get<double>(),
                kRounding * std::abs(expected.get<double>()));
  } else if (expected.is_string()) {
    ExpectAlike(actual.get<std::string>(), expected.get<std::string>());
  } else {
    EXPECT_EQ(actual, expected);
  }
}

/// Returns the names of small letters, '-' and '_' that follow the prefix.
std::set<std::string> NamesAfter(const std::string& prefix,
                                 const std::string& text) {
  std::set<std::string> names;
  for (std::size_t i = text.find(prefix); i != std::string::npos;
       i = text.find(prefix, i + 1)) {
    const std::size_t first = i + prefix.size();
    const std::size_t end =
        std::min(text.find_first_not_of("abcdefghijklmnopqrstuvwxyz-_", first),
                 text.size());
    if (end > first) {
      names.insert(text.substr(first, end - first));
    }
  }
  return names;
}

class Documentation : public testing::ProgramTest {
 protected:
  void SetUp() override {
    testing::ProgramTest::SetUp();
    std::filesystem::create_symlink(Source("examples"), folder_ / "examples");
  }

  /// Runs the commands with which blocks of the documents begin, and expects
  /// the output below them; returns how many there are.
  std::size_t ExpectOutputs(const std::vector<std::string>& documents) const {
    const std::string prompt = "$ elastimate ";
    std::size_t num_samples = 0;
    for (const std::string& document : documents) {
      for (const std::string& block : Blocks(document, "")) {
        if (block.rfind(prompt, 0) != 0) {
          continue;
        }
        ++num_samples;
        const std::vector<std::string> expected = Lines(block);
        const std::vector<std::string> actual =
            Lines(Succeed(expected[0].substr(prompt.size())).output);
        EXPECT_EQ(actual.size() + 1, expected.size()) << block;
        for (std::size_t i = 0; i < actual.size() && i + 1 < expected.size();
             ++i) {
          const std::string label = expected[i + 1].substr(0, 5);
          // Lines with these labels hold times, which differ from run to run.
          if (label == "work " || label == "time " || label == "rung ") {
            EXPECT_EQ(actual[i].substr(0, 5), label);
          } else {
            ExpectAlike(actual[i], expected[i + 1]);
          }
        }
      }
    }
    return num_samples;
  }

  /// Runs commands of a shell, which finds the program by its name, and returns
  /// what they print.
  std::string RunCommands(const std::string& commands) const {
    const std::string programs =
        std::filesystem::path(ELASTIMATE_PROGRAM).parent_path().string();
    testing::WriteText(folder_ / "commands.sh",
                       "export PATH='" + programs + "':\"$PATH\"\n" + commands);
    const std::string command =
        "cd '" + folder_.string() + "' && sh commands.sh >output 2>errors";
    EXPECT_EQ(std::system(command.c_str()), 0)
        << testing::ReadText(folder_ / "errors");
    return testing::ReadText(folder_ / "output");
  }
};

/// These commands take some ten seconds.
class DocumentationLong : public Documentation {};

TEST_F(Documentation, HasTheOutputOfTheProgram) {
  testing::WriteText(folder_ / "plate.json",
                     Blocks("docs/measurements.md", "json").at(1));
  testing::WriteText(folder_ / "bar.json",
                     Blocks("docs/plan.md", "json").at(0));
  EXPECT_GE(ExpectOutputs({"README.md", "docs/measurements.md",
                           "docs/materials.md", "docs/plan.md"}),
            8U);
}

TEST_F(DocumentationLong, HasTheOutputOfLargeDeformations) {
  EXPECT_EQ(Blocks("docs/large_deformations.md", "json").at(0),
            testing::ReadText(Source("examples/bent_arm/scene.json")));
  EXPECT_EQ(ExpectOutputs({"docs/large_deformations.md",
                           "examples/cook_membrane/README.md"}),
            2U);
}

TEST_F(DocumentationLong, HasTheDataOfLargeDeformations) {
  const auto displacement_of = [](const std::filesystem::path& path) {
    return ReadScene({path}, Measurement::kRequired)
        .scene.load_cases.at(0)
        .points.displacement;
  };
  for (const std::string example :
       {"examples/bent_arm/", "examples/cook_membrane/"}) {
    RunCommands(Blocks(example + "README.md", "").at(0));
    const std::filesystem::path scene = folder_ / "scene.json";
    testing::WriteText(scene,
                       testing::ReadText(Source(example + "scene.json")));
    EXPECT_TRUE(displacement_of(scene).isApprox(
        displacement_of(Source(example + "scene.json")), 1e-6));
  }
}

// Stresses of an incompressible material are linear in the moduli.  Least
// squares of these, with errors of 5 %, give the numbers below.
TEST_F(DocumentationLong, FitsTheRubberOfTreloar) {
  RunCommands(Blocks("examples/rubber_treloar/README.md", "").at(0));
  const auto value = [this](const std::string& report, std::size_t i) {
    return json::parse(
               testing::ReadText(folder_ / report))["parameters"][i]["value"]
        .get<double>();
  };
  EXPECT_NEAR(value("mooney_rivlin.report", 0), 0.18678, 3e-4);
  EXPECT_NEAR(value("mooney_rivlin.report", 1), 0.00296, 1e-4);
  EXPECT_NEAR(value("yeoh.report", 0), 0.19732, 4e-4);
  EXPECT_NEAR(value("yeoh.report", 1), -0.00142, 5e-5);
  EXPECT_NEAR(value("yeoh.report", 2), 3.84e-5, 2e-6);
}

TEST_F(Documentation, HasTheSceneOfTheSteelPlate) {
  const std::vector<std::string> scenes =
      Blocks("docs/measurements.md", "json");
  ASSERT_EQ(scenes.size(), 2U);
  EXPECT_EQ(scenes[0],
            testing::ReadText(Source("examples/steel_plate/plate.json")));
}

TEST_F(Documentation, HasTheReportOfTheProgram) {
  const std::vector<std::string> reports = Blocks("docs/report.md", "json");
  ASSERT_EQ(reports.size(), 1U);
  ExpectAlike(Succeed("estimate examples/scenes/organ.vtu "
                      "--estimator=reduced-fe --json=-")
                  .Json(),
              json::parse(reports[0]));
}

TEST_F(Documentation, HasTheCommandsOfTheTenBlocks) {
  const std::vector<std::string> blocks =
      Blocks("examples/ten_blocks/README.md", "");
  ASSERT_EQ(blocks.size(), 4U);
  EXPECT_THAT(
      RunCommands(blocks[0]),
      ::testing::HasSubstr("the data do not determine E of region 10 ("));
  EXPECT_GT(std::filesystem::file_size(folder_ / "ten_blocks.png"), 10000U);
  EXPECT_THAT(RunCommands(blocks[2]),
              ::testing::HasSubstr("a field that varies smoothly"));
}

// What the README says of the estimate of this scene is checked by
// HasTheOutputOfTheProgram.
TEST_F(Documentation, HasTheSceneOfTheBlock) {
  const std::vector<std::string> scenes = Blocks("README.md", "json");
  ASSERT_EQ(scenes.size(), 1U);
  EXPECT_EQ(scenes[0], testing::ReadText(Source("examples/block/scene.json")));
}

TEST_F(Documentation, HasEveryFlag) {
  std::set<std::string> flags =
      NamesAfter("--", Blocks("docs/command_line.md", "").at(0));
  EXPECT_EQ(flags.erase("help") + flags.erase("version"), 2U);
  std::set<std::string> of_help;
  for (const std::string command :
       {"estimate", "simulate", "plan", "validate", "generate", "materials",
        "scene", "check"}) {
    of_help.merge(NamesAfter("\n  --", Succeed(command + " --help").output));
  }
  EXPECT_EQ(flags, of_help);
}

TEST_F(Documentation, HasEveryFinding) {
  std::vector<std::string> codes;
  for (const FindingCode code : AllFindingCodes()) {
    codes.emplace_back(FindingCodeName(code));
  }
  EXPECT_EQ(NamesAfter("\n| `", testing::ReadText(Source("docs/findings.md"))),
            std::set<std::string>(codes.begin(), codes.end()));
}

TEST_F(Documentation, HasEveryLaw) {
  EXPECT_EQ(NamesAfter("\n| `", testing::ReadText(Source("docs/materials.md"))),
            NamesAfter("\n", "\n" + Succeed("materials").output));
}

TEST_F(Documentation, HasTheFilesOfTheThreeRegions) {
  const std::vector<std::string> samples = Blocks("docs/materials.md", "json");
  const std::string folder = "examples/three_regions/";
  for (const std::string name : {"scene.json", "parameters.json"}) {
    EXPECT_THAT(samples,
                ::testing::Contains(testing::ReadText(Source(folder + name))));
  }
}

TEST_F(Documentation, HasTheCommandsOfTheThreeRegions) {
  const std::vector<std::string> blocks =
      Blocks("examples/three_regions/README.md", "");
  ASSERT_EQ(blocks.size(), 2U);
  const std::string prompt = "elastimate ";
  for (std::string block : blocks) {
    for (std::size_t i = block.find("\\\n"); i != std::string::npos;
         i = block.find("\\\n")) {
      block.erase(i, 2);
    }
    for (const std::string& line : Lines(block)) {
      ASSERT_EQ(line.substr(0, prompt.size()), prompt);
      Succeed(line.substr(prompt.size()));
    }
  }
  const auto displacement_of = [](const std::filesystem::path& path) {
    return ReadScene({path}, Measurement::kRequired)
        .scene.load_cases.at(0)
        .displacement;
  };
  EXPECT_TRUE(
      displacement_of(folder_ / "block.vtu")
          .isApprox(displacement_of(Source("examples/three_regions/block.vtu")),
                    1e-9));
}

TEST_F(Documentation, HasEveryEstimator) {
  const std::set<std::string> names =
      NamesAfter("\n", "\n" + Succeed("estimators").output);
  for (const std::string document : {"README.md", "docs/estimators.md"}) {
    EXPECT_EQ(NamesAfter("\n| `", testing::ReadText(Source(document))), names)
        << document;
  }
}

TEST_F(Documentation, SaysWhatEachEstimatorTakes) {
  const std::string text = testing::ReadText(Source("docs/estimators.md"));
  for (const std::string_view name : EstimatorNames()) {
    const Capabilities takes = MakeEstimator(name)->WhatItTakes();
    std::string row = "\n| " + std::string(name) + " |";
    for (const auto& [is_set, word] :
         {std::pair(takes.needs_all_displacements, " needed |"),
          std::pair(takes.needs_supports, " needed |"),
          std::pair(takes.takes_bounds, " taken |"),
          std::pair(takes.takes_losses, " taken |"),
          std::pair(takes.takes_degree, " taken |"),
          std::pair(takes.takes_materials, " taken |"),
          std::pair(takes.takes_free_axes, " taken |"),
          std::pair(takes.takes_unknown_motion, " taken |"),
          std::pair(takes.takes_supports_of_cases, " taken |")}) {
      row += is_set ? word : " |";
    }
    EXPECT_NE(text.find(row + "\n"), std::string::npos) << row;
  }
}

}  // namespace
}  // namespace elastimate
