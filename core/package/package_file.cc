#include "elastimate/core/package/package_file.h"

#include <dlfcn.h>
#include <link.h>
#include <unistd.h>

#include <cstddef>
#include <vector>

namespace elastimate {
namespace {

/// Returns the handle by which the dynamic linker knows the program or shared
/// library that holds this code; null when it says nothing.
void* OwnHandle() {
  Dl_info info{};
  link_map* map = nullptr;
  if (dladdr1(reinterpret_cast<void*>(&FindPackageFile), &info,
              reinterpret_cast<void**>(&map), RTLD_DL_LINKMAP) == 0 ||
      map == nullptr) {
    return nullptr;
  }
  const bool is_program = map->l_name == nullptr || map->l_name[0] == '\0';
  return dlopen(is_program ? nullptr : map->l_name, RTLD_LAZY | RTLD_NOLOAD);
}

std::vector<std::string> SearchedFolders() {
  std::vector<std::string> folders;
  void* const handle = OwnHandle();
  Dl_serinfo size{};
  if (handle != nullptr && dlinfo(handle, RTLD_DI_SERINFOSIZE, &size) == 0) {
    std::vector<std::max_align_t> buffer(
        size.dls_size / sizeof(std::max_align_t) + 1);
    auto* const info = reinterpret_cast<Dl_serinfo*>(buffer.data());
    *info = size;
    if (dlinfo(handle, RTLD_DI_SERINFO, info) == 0) {
      for (unsigned i = 0; i < info->dls_cnt; ++i) {
        folders.emplace_back(info->dls_serpath[i].dls_name);
      }
    }
  }
  if (handle != nullptr) {
    dlclose(handle);
  }
  folders.emplace_back(ELASTIMATE_INSTALLED_FILES);
  return folders;
}

}  // namespace

std::string FindPackageFile(const std::string& name) {
  for (const std::string& folder : SearchedFolders()) {
    std::string path = folder + "/" + name;
    if (access(path.c_str(), R_OK) == 0) {
      return path;
    }
  }
  return "";
}

}  // namespace elastimate
