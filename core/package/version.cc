#include "elastimate/core/package/version.h"

#include "elastimate/generated/build_settings.h"

namespace elastimate {

std::string Version() { return ELASTIMATE_VERSION; }

}  // namespace elastimate
