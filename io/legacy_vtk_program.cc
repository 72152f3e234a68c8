// The program elastimate-legacy-vtk: reads a legacy VTK file.

#include "elastimate/io/legacy_vtk_reader.h"
#include "elastimate/io/mesh_program.h"

int main(int argc, char** argv) {
  return elastimate::RunMeshProgram(
      argc, argv, [](const std::vector<std::string>& arguments) {
        return elastimate::ReadByLegacyVtk(arguments.at(0));
      });
}
