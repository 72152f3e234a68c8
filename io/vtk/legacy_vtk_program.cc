// The program elastimate-legacy-vtk: reads a legacy VTK file.

#include "elastimate/io/helper/mesh_program.h"
#include "elastimate/io/vtk/legacy_vtk_reader.h"

int main(int argc, char** argv) {
  return elastimate::RunMeshProgram(
      argc, argv, [](const std::vector<std::string>& arguments) {
        return elastimate::ReadByLegacyVtk(arguments.at(0));
      });
}
