#include "elastimate/io/vtk_mesh.h"

#include <vtkDataArraySelection.h>
#include <vtkNew.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <stdexcept>
#include <string>

#include "elastimate/io/input_error.h"
#include "elastimate/io/mesh_program_call.h"
#include "elastimate/io/vtk_grid.h"
#include "elastimate/io/vtk_messages.h"
#include "elastimate/io/xml_vtk_check.h"

namespace elastimate {

MeshFile ReadVtuMesh(const std::filesystem::path& path) {
  const VtkMessages messages(VtkMessages::Warnings::kIgnored);
  try {
    const XmlVtkFrame frame = CheckXmlVtk(path);
    if (messages.HasError() || !frame.damage.empty()) {
      ThrowDamagedVtk(
          path, messages.HasError() ? messages.FirstError() : frame.damage);
    }
    vtkNew<vtkXMLUnstructuredGridReader> reader;
    for (const std::string& name : frame.text_point_arrays) {
      reader->GetPointDataArraySelection()->DisableArray(name.c_str());
    }
    for (const std::string& name : frame.text_cell_arrays) {
      reader->GetCellDataArraySelection()->DisableArray(name.c_str());
    }
    ReadByVtk(path, messages, reader.Get());
    return ToMeshFile(path, reader->GetOutput());
  } catch (const std::length_error&) {
    ThrowDamagedVtk(path, "its sizes exceed the memory");
  }
}

MeshFile ReadLegacyVtkMesh(const std::filesystem::path& path) {
  return ReadByProgram(
      {"elastimate-legacy-vtk", "VTK", "reads .vtk files", "write it again"},
      {}, path);
}

}  // namespace elastimate
