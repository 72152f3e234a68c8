#include "elastimate/io/vtk/legacy_vtk_reader.h"

#include <vtkNew.h>
#include <vtkUnstructuredGrid.h>
#include <vtkUnstructuredGridReader.h>

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>

#include "elastimate/io/text/input_error.h"
#include "elastimate/io/vtk/vtk_grid.h"
#include "elastimate/io/vtk/vtk_messages.h"

namespace elastimate {
namespace {

bool IsLetter(char c) {
  return std::isalpha(static_cast<unsigned char>(c)) != 0;
}

/// Returns the name of the array that begins after this line, or an empty
/// string.
std::string ArrayName(const std::string& line) {
  static const std::set<std::string> kKinds = {
      "SCALARS",      "VECTORS",       "NORMALS",
      "TENSORS",      "TENSORS6",      "GLOBAL_IDS",
      "PEDIGREE_IDS", "COLOR_SCALARS", "TEXTURE_COORDINATES"};
  std::istringstream words(line);
  std::string first;
  std::string second;
  words >> first >> second;
  std::transform(first.begin(), first.end(), first.begin(),
                 [](unsigned char c) { return std::toupper(c); });
  if (kKinds.count(first) > 0) {
    return second;
  }
  // A FIELD has lines like "force 3 6 int".
  std::istringstream field(line);
  int num_components = 0;
  int num_tuples = 0;
  std::string name;
  std::string type;
  std::string rest;
  return field >> name >> num_components >> num_tuples >> type &&
                 IsLetter(type[0]) && !(field >> rest)
             ? name
             : "";
}

/// Finds damage that VTK does not report: it takes the last of several arrays
/// of one name, and reads types of cells from beyond their end.
void CheckHeaders(const std::filesystem::path& path, std::int64_t num_cells) {
  constexpr std::size_t kLongestLine = 1000;
  std::ifstream file(path, std::ios::binary);
  std::set<std::string> names;  // Of point data, or of cell data.
  for (std::string line; std::getline(file, line);) {
    line.erase(line.find_last_not_of(" \t\r") + 1);
    // Most lines are numbers, or bytes of them.
    if (line.empty() || line.size() > kLongestLine ||
        !(IsLetter(line.front()) || IsLetter(line.back()))) {
      continue;
    }
    std::string section = line.substr(0, 10);
    std::transform(section.begin(), section.end(), section.begin(),
                   [](unsigned char c) { return std::toupper(c); });
    if (section == "POINT_DATA" || section == "CELL_DATA ") {
      names.clear();
    } else if (section == "CELL_TYPES") {
      if (std::strtoll(&line[section.size()], nullptr, 10) != num_cells) {
        ThrowDamagedVtk(path, "it has " + std::to_string(num_cells) +
                                  " cells, but not as many cell types");
      }
    } else if (const std::string name = ArrayName(line);
               !name.empty() && !names.insert(name).second) {
      ThrowDamagedVtk(path, "it has two arrays '" + name.substr(0, 40) + "'");
    }
  }
}

}  // namespace

MeshFile ReadByLegacyVtk(const std::filesystem::path& path) {
  // Much that is wrong is a mere warning for VTK.
  const VtkMessages messages(VtkMessages::Warnings::kAreErrors);
  try {
    vtkNew<vtkUnstructuredGridReader> reader;
    reader->ReadAllVectorsOn();
    reader->ReadAllScalarsOn();
    reader->ReadAllFieldsOn();
    reader->ReadAllNormalsOn();
    reader->ReadAllTensorsOn();
    ReadByVtk(path, messages, reader.Get());
    CheckHeaders(path, reader->GetOutput()->GetNumberOfCells());
    return ToMeshFile(path, reader->GetOutput());
  } catch (const std::length_error&) {
    ThrowDamagedVtk(path, "its sizes exceed the memory");
  }
}

}  // namespace elastimate
