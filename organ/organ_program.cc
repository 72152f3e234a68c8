// The program elastimate-organ N: meshes the organ with N tetrahedra.

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "elastimate/io/helper/mesh_program.h"
#include "elastimate/organ/organ_mesher.h"

namespace elastimate {
namespace {

MeshFile MakeMesh(const std::vector<std::string>& arguments) {
  if (arguments.size() != 1) {
    throw std::runtime_error("elastimate-organ takes 'N'");
  }
  Mesh organ = MeshOrgan(std::stoi(arguments[0]));
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
