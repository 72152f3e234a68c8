#ifndef ELASTIMATE_BENCHMARKS_METADATA_H_
#define ELASTIMATE_BENCHMARKS_METADATA_H_

#include <nlohmann/json.hpp>
#include <string>

namespace elastimate {

/// What a result depends on beside the study: the command, the date, the
/// commit that was built ("unknown" outside of a repository), the compiler with
/// its flags, and the machine.
nlohmann::ordered_json DescribeRun(const std::string& command);

}  // namespace elastimate

#endif  // ELASTIMATE_BENCHMARKS_METADATA_H_
