#include <ceres/version.h>
#include <glog/logging.h>
#include <unistd.h>

#include <Eigen/Core>
#include <algorithm>
#include <cctype>
#include <csignal>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <new>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "apps/commands.h"
#include "apps/flags.h"
#include "apps/linear_algebra.h"
#include "apps/outputs.h"
#include "apps/series.h"
#include "apps/signals.h"
#include "elastimate/core/package/version.h"
#include "elastimate/io/text/printable.h"
#include "elastimate/petsc/start_petsc.h"

namespace elastimate {
namespace {

constexpr int kNoEstimate = 2;

[[noreturn]] void EndForLackOfMemory() {
  std::cerr << "elastimate: there is not enough memory for this mesh; use a "
               "coarser one, or --order=1 and --estimator=closed-form, which "
               "need the least memory\n";
  _exit(kNoEstimate);
}

/// While this is true, an end of the program is not of its own making.
bool is_at_work = false;

/// Some libraries do not report that they get no memory: they throw where
/// nobody can catch it, or end the program (OpenMP, the multigrid of ML).
void WatchForLackOfMemory() {
  is_at_work = true;
  std::atexit([] {
    if (is_at_work) {
      EndForLackOfMemory();
    }
  });
  std::set_terminate([] {
    try {
      if (const std::exception_ptr error = std::current_exception()) {
        std::rethrow_exception(error);
      }
    } catch (const std::bad_alloc&) {
      EndForLackOfMemory();
    } catch (...) {  // NOLINT(bugprone-empty-catch): aborts, as it should.
    }
    std::abort();
  });
}

// Quotes an argument as a shell needs it.
std::string ForShell(const std::string& argument) {
  const bool is_plain =
      std::all_of(argument.begin(), argument.end(), [](char character) {
        return std::isalnum(static_cast<unsigned char>(character)) != 0 ||
               std::string("-_=+./,:@%").find(character) != std::string::npos;
      });
  std::string quoted;
  for (const char character : argument) {
    quoted += character == '\'' ? "'\\''" : std::string(1, character);
  }
  return is_plain ? argument : "'" + quoted + "'";
}

// Returns the line by which a shell runs a command.
std::string CommandLine(const std::string& name,
                        const std::vector<std::string>& arguments) {
  std::string line = "elastimate " + name;
  for (const std::string& argument : arguments) {
    line += " " + ForShell(Printable(argument, kLongestPath));
  }
  return line;
}

int RunCommand(const std::string& name,
               const std::vector<std::string>& arguments) {
  const Command& command = FindCommand(Elastimate(), name);
  const std::vector<std::string> others =
      ParseFlags(Elastimate(), command, arguments);
  ReserveBlasMemory();
  if (name == "estimate") {
    return RunEstimate(others);
  }
  if (name == "validate") {
    return RunValidate(others);
  }
  if (name == "report") {
    return RunReport(others, CommandLine(name, arguments));
  }
  if (name == "simulate") {
    return RunSimulate(others);
  }
  if (name == "plan") {
    return RunPlan(others);
  }
  if (name == "scene") {
    return RunScene(others);
  }
  if (name == "check") {
    return RunCheck(others);
  }
  if (name == "generate") {
    return RunGenerate(others);
  }
  if (name == "materials") {
    return RunMaterials(others);
  }
  if (name == "completion") {
    return RunCompletion(others);
  }
  if (name == "doctor") {
    return RunDoctor(others);
  }
  return RunEstimators(others);
}

int Run(const std::vector<std::string>& arguments) {
  if (arguments.empty()) {
    throw std::invalid_argument("no command is given; see elastimate --help");
  }
  if (AsksForHelp(arguments)) {
    WriteStandardOutput(HelpFor(arguments));
    return 0;
  }
  if (arguments[0] == "--version") {
    std::ostringstream text;
    text << "elastimate " << Version() << "\nBLAS: " << DescribeBlas()
         << "\nCeres Solver: " << CERES_VERSION_STRING
         << "\nEigen: " << EIGEN_WORLD_VERSION << "." << EIGEN_MAJOR_VERSION
         << "." << EIGEN_MINOR_VERSION << "\n";
    WriteStandardOutput(text.str());
    return 0;
  }
  return RunCommand(arguments[0], {arguments.begin() + 1, arguments.end()});
}

// Runs the command on a rank other than 0, until it has sent its frames to rank
// 0.
void RunForFrames(const std::vector<std::string>& arguments) {
  try {
    if (arguments.empty() ||
        (arguments[0] != "estimate" && arguments[0] != "report") ||
        Run(arguments) != kFramesSent) {
      RefuseOnOtherRanks();
    }
  } catch (const std::invalid_argument& error) {
    SendReadiness(0, error.what());
  }
}

}  // namespace

std::string ButGot(const std::vector<std::string>& arguments) {
  std::string end = "; it got";
  for (const std::string& argument : arguments) {
    end += " " + Printable(argument);
  }
  return end + (arguments.empty() ? " none" : "");
}

}  // namespace elastimate

int main(int argc, char** argv) {
  elastimate::UseBlasKernelsOfProcessor(argv);
  elastimate::OpenClosedStandardStreams();
  // A pipe or a file that takes no more is told by the call that writes to it.
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
  elastimate::CleanUpOnSignals();
  // The status of an estimate says what Ceres would have warned of.
  FLAGS_minloglevel = google::GLOG_FATAL;
  FLAGS_logtostderr = true;
  google::InitGoogleLogging(argv[0]);
  elastimate::WatchForLackOfMemory();
  elastimate::StartPetscWhenNeeded();
  int exit_code = elastimate::kNoEstimate;
  try {
    const std::vector<std::string> arguments = {argv + 1, argv + argc};
    exit_code =
        elastimate::StartRanks([&] { elastimate::RunForFrames(arguments); })
            ? elastimate::Run(arguments)
            : 0;
  } catch (const std::bad_alloc&) {
    elastimate::EndForLackOfMemory();
  } catch (const std::exception& error) {
    std::cerr << "elastimate: "
              << elastimate::Printable(error.what(),
                                       elastimate::kLongestSentence)
              << "\n";
  }
  elastimate::is_at_work = false;
  return exit_code;
}
