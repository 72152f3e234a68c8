// The commands that list what others take by name.

#include <cstddef>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "apps/commands.h"
#include "apps/flag_parser.h"
#include "apps/material_curve.h"
#include "apps/outputs.h"
#include "elastimate/core/materials/laws.h"
#include "elastimate/estimators/registry.h"

namespace elastimate {
namespace {

// The name, and below it the text in lines of 80 characters.
std::string ListEntry(std::string_view name, const std::string& text) {
  constexpr std::size_t kMostCharacters = 80;
  std::string entry(name);
  std::string line;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    if (line.empty() || line.size() + 1 + word.size() > kMostCharacters) {
      entry += line + "\n";
      line = "   ";
    }
    line += " " + word;
  }
  return entry + line + "\n";
}

std::string DescribeLaw(const Law& law) {
  std::string text(law.Description());
  const char* separator = ": ";
  for (const LawParameter& parameter : law.Parameters()) {
    text += separator + std::string(parameter.name);
    if (parameter.symbol != parameter.name) {
      text += " (" + std::string(parameter.symbol) + ")";
    }
    separator = ", ";
  }
  return text;
}

}  // namespace

void CheckNoArguments(const std::string& command,
                      const std::vector<std::string>& arguments) {
  if (!arguments.empty()) {
    throw std::invalid_argument(command + " takes no arguments" +
                                ButGot(arguments));
  }
}

int RunMaterials(const std::vector<std::string>& arguments) {
  CheckNoArguments("materials", arguments);
  if (IsGiven("curve")) {
    WriteMaterialCurve();
    return 0;
  }
  if (IsGiven("out")) {
    throw std::invalid_argument(
        AsGiven("out") +
        "; the list of laws is not written to a file; leave it out, or give a "
        "material by --curve");
  }
  std::string list;
  for (const Law* const law : Laws()) {
    list += ListEntry(law->Name(), DescribeLaw(*law));
  }
  WriteStandardOutput(list);
  return 0;
}

int RunEstimators(const std::vector<std::string>& arguments) {
  CheckNoArguments("estimators", arguments);
  std::string list;
  for (const std::string_view name : EstimatorNames()) {
    list += ListEntry(name, std::string(MakeEstimator(name)->Description()));
  }
  WriteStandardOutput(list);
  return 0;
}

}  // namespace elastimate
