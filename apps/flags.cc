#include "apps/flags.h"

#include <gflags/gflags.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <iomanip>
#include <map>
#include <sstream>
#include <stdexcept>

DEFINE_string(estimator, "closed-form",
              "method; 'elastimate estimators' lists them");
DEFINE_double(
    nu, 0,
    "Poisson's ratio, above -1 and below 0.5 [-]; estimate takes it as "
    "known");
DEFINE_double(nu_min, 0, "lower bound on Poisson's ratio, from -1 on [-]");
DEFINE_double(nu_max, 0, "upper bound on Poisson's ratio, up to 0.5 [-]");
DEFINE_double(youngs, 0, "Young's modulus, positive [pressure]");
DEFINE_double(youngs_min, 0,
              "lower bound on Young's modulus, positive [pressure]");
DEFINE_double(youngs_max, 0,
              "upper bound on Young's modulus, positive [pressure]");
DEFINE_double(noise_sd, 0,
              "standard deviation of the measured displacement per component, "
              "positive [length]; overrides that of the scene");
DEFINE_double(noise, 0,
              "norm of the added noise relative to that of the free "
              "displacement, from 0 on [-]; none without this flag");
DEFINE_string(noise_law, "uniform", "uniform or gaussian");
DEFINE_string(loss, "none", "treatment of outliers: none, huber or cauchy");
DEFINE_int32(degree, 2, "degree of the polynomial virtual fields, 1 to 3");
DEFINE_int32(order, 1,
             "element order: 1 for linear tetrahedra, 2 for quadratic ones on "
             "the same mesh (not with estimators of the force residual)");
DEFINE_int32(threads, 0,
             "largest number of threads of the linear algebra; 0, or without "
             "this flag, all processors");
DEFINE_uint64(seed, 1,
              "seed of random numbers, from 0 on (the noise of simulate; the "
              "estimators are deterministic)");
DEFINE_string(json, "", "report as JSON to this file, - for standard output");
DEFINE_string(out, "", "VTU file to write; its name ends in .vtu");
DEFINE_string(cells, "5,5,2",
              "of the cuboid: cells along x,y,z, integers from 1 on whose "
              "product is at most 2000000; five tetrahedra each");
DEFINE_string(size, "1,1,0.4",
              "of the cuboid: edge lengths along x,y,z, from 1e-50 to 1e50 "
              "[length]");
DEFINE_string(force, "",
              "force along x,y,z on every free node, of magnitude 1e-50 to "
              "1e50 or zero [force] (default 0,0,-30 for the cuboid, 0,0,-0.02 "
              "for the organ)");
DEFINE_int32(tetrahedra, 1970,
             "of the organ: number of tetrahedra within 5 %, from 200 to "
             "2000000");
DEFINE_double(length, 0.2,
              "of the organ: extent along x, from 1e-50 to 1e50 [length]");

namespace elastimate {
namespace {

std::string TypeOf(const std::string& flag) {
  gflags::CommandLineFlagInfo info;
  gflags::GetCommandLineFlagInfo(flag.c_str(), &info);
  return info.type;
}

bool Takes(const Command& command, const std::string& flag) {
  return std::find(command.flags.begin(), command.flags.end(), flag) !=
         command.flags.end();
}

// As people write it: gflags has all digits of 0.1.
std::string ValueText(const gflags::CommandLineFlagInfo& info,
                      const std::string& value) {
  if (info.type != "double") {
    return value;
  }
  std::ostringstream text;
  text << std::setprecision(15) << std::strtod(value.c_str(), nullptr);
  return text.str();
}

void CheckIsTaken(const Command& command, const std::string& flag) {
  if (Takes(command, flag)) {
    return;
  }
  const bool elsewhere =
      std::any_of(Commands().begin(), Commands().end(),
                  [&flag](const Command& other) { return Takes(other, flag); });
  throw std::invalid_argument(
      (elsewhere ? command.name + " takes no flag --" : "unknown flag --") +
      flag + "; see elastimate --help");
}

// In --flag VALUE a flag that follows is not the value, but -1 and - are.
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
                                 : "a value";
    throw std::invalid_argument(
        "--" + name + " needs " + kind +
        (value.empty() ? ", as in --" + name + "=VALUE" : "; it got " + value));
  }
}

// gflags would silently take the last value.
void CheckIsTheSame(const std::string& flag, const std::string& first,
                    const std::string& value) {
  if (first != value) {
    throw std::invalid_argument("--" + flag + " is given twice, as " + first +
                                " and as " + value + "; give it once");
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
        "order", "noise_sd", "loss", "degree", "threads", "seed", "json",
        "out"}},
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
  std::map<std::string, std::string> values;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const std::string& argument = arguments[i];
    if (argument.empty()) {
      throw std::invalid_argument(
          "an argument of " + command.name +
          " is empty; leave it out, or check the variable behind it");
    }
    if (argument == "-" || argument[0] != '-') {
      others.push_back(argument);
      continue;
    }
    const std::size_t equals = argument.find('=');
    // gflags takes -flag as well.
    const std::size_t start = argument.compare(0, 2, "--") == 0 ? 2 : 1;
    const std::string name = argument.substr(start, equals - start);
    CheckIsTaken(command, name);
    std::string value;
    if (equals != std::string::npos) {
      value = argument.substr(equals + 1);
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
  return "--" + flag + "=" + ValueText(info, info.current_value);
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
           << (shows_default
                   ? " (default " + ValueText(info, info.default_value) + ")"
                   : "")
           << "\n";
    }
  }
  help << "\nelastimate --help | --version\n"
          "\nExit code: 0 usable estimate; 1 the result is not usable, the "
          "status says why;\n2 wrong input or flags, nothing is written.\n";
  return help.str();
}

}  // namespace elastimate
