#ifndef ELASTIMATE_CORE_PACKAGE_VERSION_H_
#define ELASTIMATE_CORE_PACKAGE_VERSION_H_

#include <string>

namespace elastimate {

/// Returns the version of the library that runs, such as "0.1.0".  The macro
/// ELASTIMATE_VERSION (elastimate/generated/build_settings.h) is that of the
/// headers that a source was compiled with.
[[nodiscard]] std::string Version();

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_PACKAGE_VERSION_H_
