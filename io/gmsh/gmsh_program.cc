// The program elastimate-gmsh: reads a file through the Gmsh library.

#include <stdexcept>
#include <string>
#include <vector>

#include "elastimate/io/gmsh/gmsh_reader.h"
#include "elastimate/io/helper/mesh_program.h"

namespace elastimate {
namespace {

MeshFile MakeMesh(const std::vector<std::string>& arguments) {
  if (arguments.size() != 2) {
    throw std::runtime_error("elastimate-gmsh takes 'LINK FILE'");
  }
  return ReadByGmsh(arguments[0], arguments[1]);
}

}  // namespace
}  // namespace elastimate

int main(int argc, char** argv) {
  return elastimate::RunMeshProgram(argc, argv, elastimate::MakeMesh);
}
