#include "elastimate/core/module.h"

#include <dlfcn.h>

namespace elastimate {

void* FindInModule(const std::string& module, const char* function,
                   std::string& why) {
  why.clear();
  for (const std::string& file :
       {module, ELASTIMATE_INSTALLED_LIBRARIES "/" + module}) {
    void* const library = dlopen(file.c_str(), RTLD_LAZY | RTLD_LOCAL);
    void* const found = library == nullptr ? nullptr : dlsym(library, function);
    if (found != nullptr) {
      why.clear();
      return found;
    }
    why += (why.empty() ? "" : "; ") + std::string(dlerror());
  }
  return nullptr;
}

}  // namespace elastimate
