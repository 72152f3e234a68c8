#ifndef ELASTIMATE_APPS_FLAG_PARSER_H_
#define ELASTIMATE_APPS_FLAG_PARSER_H_

#include <string>
#include <vector>

namespace elastimate {

/// A flag that a command takes.
struct CommandFlag {
  std::string name;
  /// The meaning of the flag to the command.  Where this is empty, the help has
  /// the description with which the flag is defined.
  std::string meaning = {};
};

/// Flags that stand together in the help.
struct FlagGroup {
  std::string title;
  std::vector<CommandFlag> flags;
};

/// A command, the flags it takes, and what it is called with.
struct Command {
  std::string name;
  std::string arguments;  ///< For people, such as "SCENE...".
  std::string summary;
  std::vector<FlagGroup> groups;
};

/// A program and all its commands.
struct Program {
  std::string name;
  std::vector<Command> commands;
};

/// The command of this name.  Throws std::invalid_argument when there is none.
const Command& FindCommand(const Program& program, const std::string& name);

/// Sets the flags of `command` from `arguments` and returns the other ones, to
/// which belongs all that follows "--".
/// Throws std::invalid_argument for a flag that it does not take, one that is
/// given two values, a value that is not of the flag's type or not finite, and
/// an empty argument.
std::vector<std::string> ParseFlags(const Program& program,
                                    const Command& command,
                                    const std::vector<std::string>& arguments);

/// Tells whether the flag was given.
bool IsGiven(const std::string& flag);

/// Returns the flag with its value, such as "--nu=0.3".
std::string AsGiven(const std::string& flag);

/// Returns a list of all commands, without their flags.
std::string CommandsHelp(const Program& program);

/// Returns the usage of one command, with a line for each of its flags, by
/// groups.
std::string CommandHelp(const Program& program, const Command& command);

/// Returns the command that arguments name beside what asks for help, or null
/// where they name none.  Throws std::invalid_argument for one that does not
/// exist.
const Command* CommandToExplain(const Program& program,
                                const std::vector<std::string>& arguments);

/// Tells whether the arguments ask for help, by "help", or by "--help" or "-h"
/// before any "--".
bool AsksForHelp(const std::vector<std::string>& arguments);

}  // namespace elastimate

#endif  // ELASTIMATE_APPS_FLAG_PARSER_H_
