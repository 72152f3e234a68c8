#ifndef ELASTIMATE_APPS_FLAGS_H_
#define ELASTIMATE_APPS_FLAGS_H_

#include <gflags/gflags_declare.h>

#include <string>
#include <vector>

#include "apps/flag_parser.h"

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
DECLARE_double(correlation_length);
DECLARE_double(outliers);
DECLARE_string(rigid_motion);
DECLARE_string(points);
DECLARE_string(support);
DECLARE_string(loss);
DECLARE_string(origin);
DECLARE_string(kinematics);
DECLARE_string(refine);
DECLARE_int32(degree);
DECLARE_int32(order);
DECLARE_string(model);
DECLARE_double(thickness);
DECLARE_string(regions);
DECLARE_string(material);
DECLARE_string(map);
DECLARE_string(axis);
DECLARE_string(curve);
DECLARE_string(parameters);
DECLARE_string(surface);
DECLARE_string(hold_out);
DECLARE_int32(folds);
DECLARE_string(compare);
DECLARE_string(solver);
DECLARE_int32(threads);
DECLARE_uint64(seed);
DECLARE_string(json);
DECLARE_string(series);
DECLARE_string(out);
DECLARE_string(elements);
DECLARE_string(cells);
DECLARE_string(size);
DECLARE_string(force);
DECLARE_double(hole);
DECLARE_string(ends);
DECLARE_double(elongation);
DECLARE_int32(tetrahedra);
DECLARE_double(length);

namespace elastimate {

/// The program `elastimate`.
const Program& Elastimate();

/// Returns the help for arguments that ask for it (AsksForHelp): the usage of
/// the command that they name, with the meaning of its flags, else a list of
/// the commands.  Throws std::invalid_argument where there is no such command.
std::string HelpFor(const std::vector<std::string>& arguments);

}  // namespace elastimate

#endif  // ELASTIMATE_APPS_FLAGS_H_
