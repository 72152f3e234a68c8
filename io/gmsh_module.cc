#include "elastimate/io/gmsh_module.h"

#include <stdexcept>
#include <string>

#include "elastimate/core/module.h"

namespace elastimate {
namespace {

template <typename Function>
Function* Find(const char* name) {
  std::string why;
  Function* const function =
      FindInModule<Function>(ELASTIMATE_GMSH_MODULE, name, why);
  if (function == nullptr) {
    throw std::runtime_error(
        "the module " ELASTIMATE_GMSH_MODULE
        ", which reads Gmsh files and meshes organs, is not found (" +
        why + "); install it, or name its folder in LD_LIBRARY_PATH");
  }
  return function;
}

}  // namespace

const GmshModule& LoadGmshModule() {
  static const GmshModule module = {
      Find<decltype(elastimate_read_gmsh_mesh)>("elastimate_read_gmsh_mesh"),
      Find<decltype(elastimate_mesh_organ)>("elastimate_mesh_organ")};
  return module;
}

}  // namespace elastimate
