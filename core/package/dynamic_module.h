#ifndef ELASTIMATE_CORE_PACKAGE_DYNAMIC_MODULE_H_
#define ELASTIMATE_CORE_PACKAGE_DYNAMIC_MODULE_H_

#include <string>

namespace elastimate {

/// Returns the function called `function` of a module, a shared library that is
/// loaded only when it is used because it takes long to load.  The module is
/// looked for as FindPackageFile says, then in the system's folders.  Returns
/// null when it is not found, and `why` then says what the system says.
void* FindInModule(const std::string& module, const char* function,
                   std::string& why);

/// Returns the function as one of this type.
template <typename Function>
Function* FindInModule(const std::string& module, const char* function,
                       std::string& why) {
  return reinterpret_cast<Function*>(FindInModule(module, function, why));
}

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_PACKAGE_DYNAMIC_MODULE_H_
