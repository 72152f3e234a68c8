#include "apps/flags.h"

#include <gflags/gflags.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

DEFINE_string(estimator, "closed-form",
              "method; 'elastimate estimators' lists them");
DEFINE_double(nu, 0, "Poisson's ratio, when it is known [-]");
DEFINE_double(nu_min, 0, "lower bound on Poisson's ratio [-]");
DEFINE_double(nu_max, 0, "upper bound on Poisson's ratio [-]");
DEFINE_double(youngs, 0, "Young's modulus [pressure]");
DEFINE_double(youngs_min, 0, "lower bound on Young's modulus [pressure]");
DEFINE_double(youngs_max, 0, "upper bound on Young's modulus [pressure]");
DEFINE_double(noise_sd, 0,
              "standard deviation of the measured displacement per component "
              "[length]; overrides that of the scene");
DEFINE_double(noise, 0,
              "norm of the added noise relative to that of the free "
              "displacement [-]");
DEFINE_string(noise_law, "uniform", "uniform or gaussian");
DEFINE_string(loss, "none", "treatment of outliers: none, huber or cauchy");
DEFINE_int32(order, 1, "element order; 1 in this version");
DEFINE_int32(threads, 0,
             "largest number of threads of the linear algebra; 0 for all "
             "processors");
DEFINE_uint64(seed, 1,
              "seed of random numbers (the noise of simulate; the estimators "
              "are deterministic)");
DEFINE_string(json, "", "report as JSON to this file, - for standard output");
DEFINE_string(out, "", "VTU file to write");
DEFINE_string(cells, "5,5,2", "cells of the cuboid along x,y,z");
DEFINE_string(size, "1,1,0.4", "edge lengths of the cuboid [length]");
DEFINE_string(force, "0,0,-30", "force on every free node [force]");
DEFINE_int32(tetrahedra, 1970, "number of tetrahedra of the organ, about");
DEFINE_double(length, 0.2, "length of the organ [length]");

namespace elastimate {
namespace {

// "name" and "value" of --name=value; a flag without a value is an error,
// since none is a switch.
std::pair<std::string, std::string> SplitFlag(const std::string& argument) {
  const std::size_t name_start = argument.find_first_not_of('-');
  const std::size_t equals = argument.find('=');
  if (name_start == std::string::npos) {
    throw std::invalid_argument("'" + argument + "' is not a flag");
  }
  const std::string name = argument.substr(name_start, equals - name_start);
  return {name, equals == std::string::npos ? "" : argument.substr(equals + 1)};
}

void SetFlag(const std::string& name, const std::string& value) {
  gflags::CommandLineFlagInfo info;
  gflags::GetCommandLineFlagInfo(name.c_str(), &info);
  const bool accepted =
      !value.empty() &&
      !gflags::SetCommandLineOption(name.c_str(), value.c_str()).empty();
  const bool finite = info.type != "double" || !accepted ||
                      std::isfinite(std::strtod(value.c_str(), nullptr));
  if (!accepted || !finite) {
    const std::string kind = info.type == "double"   ? "a finite number"
                             : info.type == "int32"  ? "an integer"
                             : info.type == "uint64" ? "an integer from 0 on"
                                                     : "a value";
    throw std::invalid_argument("--" + name + " needs " + kind + ", as in --" +
                                name + "=...; it got '" + value + "'");
  }
}

}  // namespace

const std::vector<Command>& Commands() {
  static const std::vector<Command> commands = {
      {"estimate",
       "SCENE...",
       "Young's modulus and Poisson's ratio of a scene (VTK, Gmsh or "
       "scene.json); several files are further load cases",
       {"estimator", "nu", "nu_min", "nu_max", "youngs_min", "youngs_max",
        "order", "noise_sd", "loss", "threads", "seed", "json", "out"}},
      {"simulate",
       "SCENE",
       "displacements of a scene for given parameters, with noise if wanted",
       {"youngs", "nu", "order", "noise", "noise_law", "seed", "threads",
        "out"}},
      {"generate",
       "cuboid|organ",
       "an example geometry with supports and forces",
       {"cells", "size", "tetrahedra", "length", "force", "out"}},
      {"estimators", "", "lists the estimators", {}}};
  return commands;
}

std::vector<std::string> ParseFlags(const Command& command,
                                    const std::vector<std::string>& arguments) {
  std::vector<std::string> others;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const std::string& argument = arguments[i];
    if (argument.size() < 2 || argument[0] != '-') {
      others.push_back(argument);
      continue;
    }
    auto [name, value] = SplitFlag(argument);
    if (std::find(command.flags.begin(), command.flags.end(), name) ==
        command.flags.end()) {
      gflags::CommandLineFlagInfo info;
      const bool elsewhere =
          std::any_of(Commands().begin(), Commands().end(),
                      [&name = name](const Command& other) {
                        return std::find(other.flags.begin(), other.flags.end(),
                                         name) != other.flags.end();
                      });
      throw std::invalid_argument(
          (elsewhere ? "elastimate " + command.name + " takes no flag --"
                     : "unknown flag --") +
          name + "; see elastimate --help");
    }
    // --name value, as gflags has it.
    if (argument.find('=') == std::string::npos && i + 1 < arguments.size()) {
      value = arguments[++i];
    }
    SetFlag(name, value);
  }
  return others;
}

bool IsGiven(const std::string& flag) {
  gflags::CommandLineFlagInfo info;
  return gflags::GetCommandLineFlagInfo(flag.c_str(), &info) &&
         !info.is_default;
}

std::string Help() {
  std::ostringstream help;
  help << "elastimate: Young's modulus and Poisson's ratio from a mesh, known "
          "loads and\nmeasured displacements.\n";
  for (const Command& command : Commands()) {
    help << "\nelastimate " << command.name << " " << command.arguments
         << "\n    " << command.summary << "\n";
    for (const std::string& flag : command.flags) {
      gflags::CommandLineFlagInfo info;
      gflags::GetCommandLineFlagInfo(flag.c_str(), &info);
      // A default of 0 stands for "not given", except where it means itself.
      const bool shows_default =
          !info.default_value.empty() && info.default_value != "0";
      help << "      --" << flag << "  " << info.description
           << (shows_default ? " (default " + info.default_value + ")" : "")
           << "\n";
    }
  }
  help << "\nelastimate --help | --version\n"
          "\nExit code: 0 usable estimate; 1 the result is not usable, the "
          "status says why;\n2 wrong input or flags.\n";
  return help.str();
}

}  // namespace elastimate
