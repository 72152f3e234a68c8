#include <ceres/version.h>
#include <glog/logging.h>

#include <Eigen/Core>
#include <iostream>
#include <new>
#include <stdexcept>
#include <string>
#include <vector>

#include "apps/commands.h"
#include "apps/flags.h"
#include "apps/linear_algebra.h"
#include "elastimate/io/report.h"

namespace elastimate {
namespace {

constexpr int kNotUsable = 1;
constexpr int kWrongInput = 2;

int RunCommand(const std::string& name,
               const std::vector<std::string>& arguments) {
  for (const Command& command : Commands()) {
    if (command.name != name) {
      continue;
    }
    const std::vector<std::string> others = ParseFlags(command, arguments);
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
  throw std::invalid_argument("unknown command '" + name +
                              "'; see elastimate --help");
}

int Run(const std::vector<std::string>& arguments) {
  if (arguments.empty()) {
    throw std::invalid_argument("give a command; see elastimate --help");
  }
  for (const std::string& argument : arguments) {
    if (argument == "--help" || argument == "-h" || argument == "help") {
      std::cout << Help();
      return 0;
    }
  }
  if (arguments[0] == "--version") {
    std::cout << "elastimate " << Version() << "\nBLAS: " << DescribeBlas()
              << "\nCeres Solver: " << CERES_VERSION_STRING
              << "\nEigen: " << EIGEN_WORLD_VERSION << "."
              << EIGEN_MAJOR_VERSION << "." << EIGEN_MINOR_VERSION << "\n";
    return 0;
  }
  return RunCommand(arguments[0], {arguments.begin() + 1, arguments.end()});
}

}  // namespace
}  // namespace elastimate

int main(int argc, char** argv) {
  FLAGS_logtostderr = true;
  google::InitGoogleLogging(argv[0]);
  try {
    return elastimate::Run({argv + 1, argv + argc});
  } catch (const std::invalid_argument& error) {
    std::cerr << "elastimate: " << error.what() << "\n";
    return elastimate::kWrongInput;
  } catch (const std::bad_alloc&) {
    std::cerr << "elastimate: there is not enough memory for this scene; "
                 "coarsen the mesh, or use closed-form\n";
    return elastimate::kNotUsable;
  } catch (const std::exception& error) {
    std::cerr << "elastimate: " << error.what() << "\n";
    return elastimate::kNotUsable;
  }
}
