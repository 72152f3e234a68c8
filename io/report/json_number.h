#ifndef ELASTIMATE_IO_REPORT_JSON_NUMBER_H_
#define ELASTIMATE_IO_REPORT_JSON_NUMBER_H_

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

namespace elastimate {

/// Returns the number as JSON, or null where it is unknown or not finite, which
/// JSON cannot say.
inline nlohmann::ordered_json OrNull(const std::optional<double>& value) {
  return value && std::isfinite(*value) ? nlohmann::ordered_json(*value)
                                        : nlohmann::ordered_json(nullptr);
}

}  // namespace elastimate

#endif  // ELASTIMATE_IO_REPORT_JSON_NUMBER_H_
