#ifndef ELASTIMATE_CORE_PACKAGE_PACKAGE_FILE_H_
#define ELASTIMATE_CORE_PACKAGE_PACKAGE_FILE_H_

#include <string>

namespace elastimate {

/// Returns the path of a module or helper program of this package.  It is
/// looked for first in the folders where the program, or the shared library,
/// that holds this code looks for libraries (LD_LIBRARY_PATH and its run path,
/// which CMake's targets of the package set), then where the build was to be
/// installed.  Empty when it is in none of them.
std::string FindPackageFile(const std::string& name);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_PACKAGE_PACKAGE_FILE_H_
