#include "elastimate/core/package/dynamic_module.h"

#include <dlfcn.h>

#include "elastimate/core/package/package_file.h"

namespace elastimate {

void* FindInModule(const std::string& module, const char* function,
                   std::string& why) {
  why.clear();
  const std::string path = FindPackageFile(module);
  void* const library = dlopen(path.empty() ? module.c_str() : path.c_str(),
                               RTLD_LAZY | RTLD_LOCAL);
  void* const found = library == nullptr ? nullptr : dlsym(library, function);
  if (found == nullptr) {
    why = dlerror();
  }
  return found;
}

}  // namespace elastimate
