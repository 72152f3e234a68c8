#ifndef ELASTIMATE_APPS_COMMANDS_H_
#define ELASTIMATE_APPS_COMMANDS_H_

#include <string>
#include <vector>

namespace elastimate {

// The commands of the program.  Each takes the arguments that are no flags,
// reads its flags, and returns the exit code; wrong input throws
// std::invalid_argument.

int RunEstimate(const std::vector<std::string>& arguments);
int RunValidate(const std::vector<std::string>& arguments);
/// Does what RunEstimate does, with a page for --out; `command` is the line
/// that asks for it.
int RunReport(const std::vector<std::string>& arguments,
              const std::string& command);
int RunSimulate(const std::vector<std::string>& arguments);
int RunPlan(const std::vector<std::string>& arguments);
int RunScene(const std::vector<std::string>& arguments);
int RunCheck(const std::vector<std::string>& arguments);
int RunGenerate(const std::vector<std::string>& arguments);
int RunEstimators(const std::vector<std::string>& arguments);
int RunMaterials(const std::vector<std::string>& arguments);
int RunCompletion(const std::vector<std::string>& arguments);
int RunDoctor(const std::vector<std::string>& arguments);

/// Checks the flags that estimate and simulate share, and sets the threads.
void ApplyComputingFlags();

/// Throws std::invalid_argument unless there are no arguments.
void CheckNoArguments(const std::string& command,
                      const std::vector<std::string>& arguments);

/// Ends a sentence on wrong arguments: "; it got a b".
std::string ButGot(const std::vector<std::string>& arguments);

}  // namespace elastimate

#endif  // ELASTIMATE_APPS_COMMANDS_H_
