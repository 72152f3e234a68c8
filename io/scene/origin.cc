#include "elastimate/io/scene/origin.h"

namespace elastimate {

std::string_view NameOf(Origin origin) {
  return origin == Origin::kMeasured ? "measured" : "computed";
}

std::optional<Origin> OriginOfName(std::string_view name) {
  for (const Origin origin : {Origin::kMeasured, Origin::kComputed}) {
    if (NameOf(origin) == name) {
      return origin;
    }
  }
  return std::nullopt;
}

}  // namespace elastimate
