#include <ceres/version.h>
#include <glog/logging.h>

#include <Eigen/Core>
#include <csignal>
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
#include "elastimate/io/report.h"

namespace elastimate {
namespace {

constexpr int kNoEstimate = 2;

int RunCommand(const std::string& name,
               const std::vector<std::string>& arguments) {
  const Command& command = FindCommand(Elastimate(), name);
  const std::vector<std::string> others =
      ParseFlags(Elastimate(), command, arguments);
  ReserveBlasMemory();
  if (name == "estimate") {
    return RunEstimate(others);
  }
  if (name == "simulate") {
    return RunSimulate(others);
  }
  if (name == "generate") {
    return RunGenerate(others);
  }
  return RunEstimators(others);
}

int Run(const std::vector<std::string>& arguments) {
  if (arguments.empty()) {
    throw std::invalid_argument("give a command; see elastimate --help");
  }
  if (AsksForHelp(arguments)) {
    WriteStandardOutput(Help());
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

}  // namespace

std::string ButGot(const std::vector<std::string>& arguments) {
  std::string end = "; it got";
  for (const std::string& argument : arguments) {
    end += " " + argument;
  }
  return end + (arguments.empty() ? " none" : "");
}

}  // namespace elastimate

int main(int argc, char** argv) {
  elastimate::OpenClosedStandardStreams();
  // Output that nobody reads, or that grows too large, is an error like any
  // other.
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
  // The status of an estimate says what Ceres would have warned of.
  FLAGS_minloglevel = google::GLOG_FATAL;
  FLAGS_logtostderr = true;
  google::InitGoogleLogging(argv[0]);
  try {
    return elastimate::Run({argv + 1, argv + argc});
  } catch (const std::bad_alloc&) {
    std::cerr << "elastimate: there is not enough memory for this mesh; "
                 "coarsen it, or estimate with --order=1 and "
                 "--estimator=closed-form, which need the least\n";
  } catch (const std::exception& error) {
    std::cerr << "elastimate: " << error.what() << "\n";
  }
  return elastimate::kNoEstimate;
}
