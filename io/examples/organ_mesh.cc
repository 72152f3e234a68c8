#include "elastimate/io/examples/organ_mesh.h"

#include <string>
#include <utility>

#include "elastimate/io/helper/mesh_program_call.h"

namespace elastimate {

Mesh OrganMesh(int tetrahedra) {
  MeshFile organ =
      MakeByProgram({"elastimate-organ", "Gmsh", "meshes organs", ""},
                    {std::to_string(tetrahedra)});
  Mesh mesh;
  mesh.nodes = std::move(organ.nodes);
  mesh.elements = std::move(organ.elements);
  return mesh;
}

}  // namespace elastimate
