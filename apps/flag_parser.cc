#include "apps/flag_parser.h"

#include <gflags/gflags.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <iomanip>
#include <map>
#include <sstream>
#include <stdexcept>

#include "elastimate/io/text/printable.h"

namespace elastimate {
namespace {

constexpr const char* kEndOfFlags = "--";
constexpr const char* kHelpCommand = "help";

std::string TypeOf(const std::string& flag) {
  gflags::CommandLineFlagInfo info;
  gflags::GetCommandLineFlagInfo(flag.c_str(), &info);
  return info.type;
}

bool Takes(const Command& command, const std::string& flag) {
  return std::any_of(
      command.groups.begin(), command.groups.end(),
      [&flag](const FlagGroup& group) {
        return std::any_of(
            group.flags.begin(), group.flags.end(),
            [&flag](const CommandFlag& taken) { return taken.name == flag; });
      });
}

// Writes a value as people do, whereas gflags writes all digits of 0.1.
std::string ValueText(const gflags::CommandLineFlagInfo& info,
                      const std::string& value) {
  if (info.type != "double") {
    return value;
  }
  std::ostringstream text;
  text << std::setprecision(15) << std::strtod(value.c_str(), nullptr);
  return text.str();
}

void CheckIsTaken(const Program& program, const Command& command,
                  const std::string& flag) {
  if (Takes(command, flag)) {
    return;
  }
  const bool elsewhere =
      std::any_of(program.commands.begin(), program.commands.end(),
                  [&flag](const Command& other) { return Takes(other, flag); });
  throw std::invalid_argument(
      (elsewhere ? command.name + " takes no flag --" : "unknown flag --") +
      Printable(flag) + "; see " + program.name + " " + command.name +
      " --help");
}

// In --flag VALUE, an argument that is another flag is not the value, but -1
// and - may be.
bool MayBeValue(const std::string& argument) {
  return argument.size() < 2 || argument[0] != '-' || argument[1] == '.' ||
         std::isdigit(static_cast<unsigned char>(argument[1])) != 0;
}

void SetFlag(const std::string& name, const std::string& value) {
  const std::string type = TypeOf(name);
  const bool accepted =
      !value.empty() &&
      !gflags::SetCommandLineOption(name.c_str(), value.c_str()).empty();
  const bool finite = type != "double" || !accepted ||
                      std::isfinite(std::strtod(value.c_str(), nullptr));
  if (!accepted || !finite) {
    const std::string kind = type == "double"  ? "a finite number"
                             : type == "int32" ? "an integer up to 2147483647"
                             : type == "uint64"
                                 ? "an integer from 0 to 18446744073709551615"
                             : type == "bool" ? "true or false"
                                              : "a value";
    throw std::invalid_argument("--" + name + " needs " + kind +
                                (value.empty()
                                     ? ", as in --" + name + "=VALUE"
                                     : "; it got " + Printable(value)));
  }
}

// Throws for two different values, of which gflags would silently take the
// last.
void CheckIsTheSame(const std::string& flag, const std::string& first,
                    const std::string& value) {
  if (first != value) {
    throw std::invalid_argument("--" + flag + " is given twice, as " +
                                Printable(first) + " and as " +
                                Printable(value) + "; give it once");
  }
}

std::string Usage(const Program& program, const Command& command) {
  return program.name + " " + command.name +
         (command.arguments.empty() ? "" : " " + command.arguments);
}

std::size_t WidthOfFlags(const Command& command) {
  std::size_t width = 0;
  for (const FlagGroup& group : command.groups) {
    for (const CommandFlag& flag : group.flags) {
      width = std::max(width, flag.name.size());
    }
  }
  return width;
}

std::string FlagHelp(const CommandFlag& flag, std::size_t width) {
  gflags::CommandLineFlagInfo info;
  gflags::GetCommandLineFlagInfo(flag.name.c_str(), &info);
  // A default of 0 stands for "not given", except where 0 is meant.  Some
  // commands have another default, which the meaning of the flag says.
  const bool shows_default =
      !info.default_value.empty() && info.default_value != "0" &&
      info.type != "bool" &&
      flag.meaning.find("without the flag") == std::string::npos;
  return "  --" + flag.name + std::string(width - flag.name.size(), ' ') +
         "  " + (flag.meaning.empty() ? info.description : flag.meaning) +
         (shows_default
              ? " (default " + ValueText(info, info.default_value) + ")"
              : "") +
         "\n";
}

}  // namespace

const Command& FindCommand(const Program& program, const std::string& name) {
  for (const Command& command : program.commands) {
    if (command.name == name) {
      return command;
    }
  }
  throw std::invalid_argument(
      (name[0] == '-' ? "the command comes first, then its flags; '" +
                            Printable(name) + "' came first"
                      : "unknown command '" + Printable(name) + "'") +
      "; see " + program.name + " --help");
}

std::vector<std::string> ParseFlags(const Program& program,
                                    const Command& command,
                                    const std::vector<std::string>& arguments) {
  std::vector<std::string> others;
  std::map<std::string, std::string> values;
  bool is_past_flags = false;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const std::string& argument = arguments[i];
    if (argument.empty()) {
      throw std::invalid_argument(
          "an argument of " + command.name +
          " is empty; leave it out, or check the variable behind it");
    }
    if (argument == kEndOfFlags && !is_past_flags) {
      is_past_flags = true;
      continue;
    }
    if (is_past_flags || argument == "-" || argument[0] != '-') {
      others.push_back(argument);
      continue;
    }
    const std::size_t equals = argument.find('=');
    // gflags accepts -flag as well as --flag.
    const std::size_t start = argument.compare(0, 2, "--") == 0 ? 2 : 1;
    const std::string name = argument.substr(start, equals - start);
    CheckIsTaken(program, command, name);
    std::string value;
    if (equals != std::string::npos) {
      value = argument.substr(equals + 1);
    } else if (TypeOf(name) == "bool") {
      value = "true";
    } else if (i + 1 < arguments.size() && MayBeValue(arguments[i + 1])) {
      value = arguments[++i];
    }
    SetFlag(name, value);
    CheckIsTheSame(name, values.emplace(name, value).first->second, value);
  }
  return others;
}

bool IsGiven(const std::string& flag) {
  gflags::CommandLineFlagInfo info;
  return gflags::GetCommandLineFlagInfo(flag.c_str(), &info) &&
         !info.is_default;
}

std::string AsGiven(const std::string& flag) {
  gflags::CommandLineFlagInfo info;
  gflags::GetCommandLineFlagInfo(flag.c_str(), &info);
  return "--" + flag + "=" + Printable(ValueText(info, info.current_value));
}

std::string CommandsHelp(const Program& program) {
  constexpr std::size_t kWidth = 32;
  std::string help;
  for (const Command& command : program.commands) {
    const std::string usage = Usage(program, command);
    help += "  " + usage +
            (usage.size() < kWidth ? std::string(kWidth - usage.size(), ' ')
                                   : "\n" + std::string(kWidth + 2, ' ')) +
            command.summary + "\n";
  }
  return help;
}

std::string CommandHelp(const Program& program, const Command& command) {
  std::string help =
      Usage(program, command) + "\n    " + command.summary + "\n";
  const std::size_t width = WidthOfFlags(command);
  for (const FlagGroup& group : command.groups) {
    help += "\n" + (group.title.empty() ? "" : group.title + ":\n");
    for (const CommandFlag& flag : group.flags) {
      help += FlagHelp(flag, width);
    }
  }
  return help;
}

const Command* CommandToExplain(const Program& program,
                                const std::vector<std::string>& arguments) {
  const std::size_t place =
      !arguments.empty() && arguments[0] == kHelpCommand ? 1 : 0;
  return place < arguments.size() && arguments[place][0] != '-'
             ? &FindCommand(program, arguments[place])
             : nullptr;
}

bool AsksForHelp(const std::vector<std::string>& arguments) {
  return (!arguments.empty() && arguments[0] == kHelpCommand) ||
         std::any_of(arguments.begin(),
                     std::find(arguments.begin(), arguments.end(), kEndOfFlags),
                     [](const std::string& argument) {
                       return argument == "--help" || argument == "-h";
                     });
}

}  // namespace elastimate
