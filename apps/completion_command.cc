// The command that prints a completion script for bash.

#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "apps/commands.h"
#include "apps/flags.h"
#include "apps/outputs.h"
#include "elastimate/core/materials/laws.h"
#include "elastimate/estimators/registry.h"

namespace elastimate {
namespace {

std::string EstimatorWords() {
  std::string words;
  for (const std::string_view name : EstimatorNames()) {
    words += (words.empty() ? "" : " ") + std::string(name);
  }
  return words;
}

std::string LawWords() {
  std::string words = "auto";
  for (const Law* const law : Laws()) {
    words += " " + std::string(law->Name());
  }
  return words;
}

// Returns the flags of a command, each with the "=" that its value follows.
std::string FlagWords(const Command& command) {
  std::string words = "--help";
  for (const FlagGroup& group : command.groups) {
    for (const CommandFlag& flag : group.flags) {
      words += " --" + flag.name + "=";
    }
  }
  return words;
}

}  // namespace

int RunCompletion(const std::vector<std::string>& arguments) {
  if (arguments != std::vector<std::string>{"bash"}) {
    throw std::invalid_argument(
        "completion takes the name of a shell, which is bash" +
        ButGot(arguments));
  }
  std::string commands;
  std::ostringstream cases;
  for (const Command& command : Elastimate().commands) {
    commands += (commands.empty() ? "" : " ") + command.name;
    cases << "    " << command.name << ") words='" << FlagWords(command)
          << "' ;;\n";
  }
  std::ostringstream script;
  // Bash takes "--flag=value" for three words.
  script << "# elastimate(1) completion\n"
            "_elastimate() {\n"
            "  local current=${COMP_WORDS[COMP_CWORD]} words flag\n"
            "  if [ \"$COMP_CWORD\" -eq 1 ]; then\n"
            "    COMPREPLY=($(compgen -W '"
         << commands
         << " help --help --version' -- \"$current\"))\n"
            "    return\n"
            "  fi\n"
            "  flag=${COMP_WORDS[COMP_CWORD-1]}\n"
            "  if [ \"$current\" = '=' ]; then\n"
            "    current=''\n"
            "  elif [ \"$flag\" = '=' ]; then\n"
            "    flag=${COMP_WORDS[COMP_CWORD-2]}\n"
            "  fi\n"
            "  case $flag in\n"
            "    --estimator) words='"
         << EstimatorWords()
         << "' ;;\n"
            "    --material) words='"
         << LawWords()
         << "' ;;\n"
            "    *) words='' ;;\n"
            "  esac\n"
            "  if [ -n \"$words\" ]; then\n"
            "    COMPREPLY=($(compgen -W \"$words\" -- \"$current\"))\n"
            "    return\n"
            "  fi\n"
            "  case ${COMP_WORDS[1]} in\n"
         << cases.str()
         << "  esac\n"
            "  if [ \"${current#-}\" != \"$current\" ]; then\n"
            "    COMPREPLY=($(compgen -W \"$words\" -- \"$current\"))\n"
            "    case ${COMPREPLY[0]} in *=) compopt -o nospace ;; esac\n"
            "  else\n"
            "    COMPREPLY=($(compgen -f -- \"$current\"))\n"
            "    compopt -o filenames\n"
            "  fi\n"
            "}\n"
            "complete -F _elastimate elastimate\n";
  WriteStandardOutput(script.str());
  return 0;
}

}  // namespace elastimate
