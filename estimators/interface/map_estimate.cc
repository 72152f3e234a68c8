#include "elastimate/estimators/interface/map_estimate.h"

namespace elastimate {

std::string_view MapVerdictName(MapVerdict verdict) {
  switch (verdict) {
    case MapVerdict::kHomogeneous:
      return "homogeneous";
    case MapVerdict::kRegions:
      return "regions";
    case MapVerdict::kField:
      return "field";
    case MapVerdict::kElements:
      break;
  }
  return "elements";
}

}  // namespace elastimate
