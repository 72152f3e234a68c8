#ifndef ELASTIMATE_APPS_FLAGS_H_
#define ELASTIMATE_APPS_FLAGS_H_

#include <gflags/gflags_declare.h>

#include <string>
#include <vector>

DECLARE_string(estimator);
DECLARE_double(nu);
DECLARE_double(nu_min);
DECLARE_double(nu_max);
DECLARE_double(youngs);
DECLARE_double(youngs_min);
DECLARE_double(youngs_max);
DECLARE_double(noise_sd);
DECLARE_double(noise);
DECLARE_string(noise_law);
DECLARE_string(loss);
DECLARE_int32(degree);
DECLARE_int32(order);
DECLARE_int32(threads);
DECLARE_uint64(seed);
DECLARE_string(json);
DECLARE_string(out);
DECLARE_string(cells);
DECLARE_string(size);
DECLARE_string(force);
DECLARE_int32(tetrahedra);
DECLARE_double(length);

namespace elastimate {

/// A command, the flags it takes, and what it is called with.
struct Command {
  std::string name;
  std::string arguments;  ///< For people, such as "SCENE...".
  std::string summary;
  std::vector<std::string> flags;
};

const std::vector<Command>& Commands();

/// Sets the flags of `command` from `arguments` and returns the other ones.
/// Throws std::invalid_argument for a flag that it does not take, one that is
/// given two values, a value that is not of the flag's type or not finite, and
/// an empty argument.
std::vector<std::string> ParseFlags(const Command& command,
                                    const std::vector<std::string>& arguments);

/// Whether the flag was given.
bool IsGiven(const std::string& flag);

/// The flag with its value, such as "--nu=0.3".
std::string AsGiven(const std::string& flag);

/// Usage of all commands and the meaning of their flags.
std::string Help();

}  // namespace elastimate

#endif  // ELASTIMATE_APPS_FLAGS_H_
