#ifndef ELASTIMATE_CORE_PACKAGE_DYNAMIC_MODULE_H_
#define ELASTIMATE_CORE_PACKAGE_DYNAMIC_MODULE_H_

#include <string>

namespace elastimate {

/// The function called `function` of a module, a shared library that is loaded
/// when it is used because it takes long to load.  It is looked for as
/// FindPackageFile says, then in the system's folders.  Null when it is not
/// found, and `why` is what the system says then.
void* FindInModule(const std::string& module, const char* function,
                   std::string& why);

/// Finds a function of this type as above.
template <typename Function>
Function* FindInModule(const std::string& module, const char* function,
                       std::string& why) {
  return reinterpret_cast<Function*>(FindInModule(module, function, why));
}

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_PACKAGE_DYNAMIC_MODULE_H_
