#include "elastimate/io/scene/origin.h"

namespace elastimate {

std::optional<Origin> OriginOfName(std::string_view name) {
  if (name == "measured") {
    return Origin::kMeasured;
  }
  return name == "computed" ? std::optional<Origin>(Origin::kComputed)
                            : std::nullopt;
}

}  // namespace elastimate
