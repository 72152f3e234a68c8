// The program elastimate-gmsh: reads a file through the Gmsh library, or meshes
// the organ with it.

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "elastimate/io/gmsh/gmsh_reader.h"
#include "elastimate/io/gmsh/organ_mesher.h"
#include "elastimate/io/helper/mesh_program.h"

namespace elastimate {
namespace {

MeshFile MakeMesh(const std::vector<std::string>& arguments) {
  if (arguments.size() == 3 && arguments[0] == "read") {
    return ReadByGmsh(arguments[1], arguments[2]);
  }
  if (arguments.size() != 2 || arguments[0] != "organ") {
    throw std::runtime_error(
        "elastimate-gmsh takes 'read LINK FILE' or 'organ N'");
  }
  Mesh organ = MeshOrgan(std::stoi(arguments[1]));
  MeshFile mesh;
  mesh.nodes = std::move(organ.nodes);
  mesh.elements = std::move(organ.elements);
  return mesh;
}

}  // namespace
}  // namespace elastimate

int main(int argc, char** argv) {
  return elastimate::RunMeshProgram(argc, argv, elastimate::MakeMesh);
}
