#include "elastimate/io/vtk/pvtu_mesh.h"

#include <vtkAppendFilter.h>
#include <vtkCellData.h>
#include <vtkDataSetAttributes.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkSmartPointer.h>
#include <vtkStaticPointLocator.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <cmath>
#include <pugixml.hpp>
#include <set>
#include <string>
#include <vector>

#include "elastimate/io/text/input_error.h"
#include "elastimate/io/text/input_file.h"
#include "elastimate/io/vtk/vtk_grid.h"
#include "elastimate/io/vtk/vtu_grid.h"

namespace elastimate {
namespace {

namespace fs = std::filesystem;

struct Piece {
  fs::path path;
  vtkSmartPointer<vtkUnstructuredGrid> grid;
};

// Removes cells that belong to another piece.  VTK takes only bytes for the
// marks of such cells, but other programs write numbers of any type.
void RemoveGhostCells(vtkUnstructuredGrid* grid) {
  const char* const name = vtkDataSetAttributes::GhostArrayName();
  vtkDataArray* const marks = grid->GetCellData()->GetArray(name);
  if (marks != nullptr) {
    vtkNew<vtkUnsignedCharArray> bytes;
    bytes->SetName(name);
    for (vtkIdType i = 0; i < grid->GetNumberOfCells(); ++i) {
      bytes->InsertNextValue(marks->GetComponent(i, 0) != 0
                                 ? vtkDataSetAttributes::DUPLICATECELL
                                 : 0);
    }
    grid->GetCellData()->RemoveArray(name);
    grid->GetCellData()->AddArray(bytes);
  }
  grid->GetPointData()->RemoveArray(name);
  grid->RemoveGhostCells();
  grid->GetCellData()->RemoveArray(name);
}

std::vector<Piece> ReadPieces(const fs::path& path) {
  pugi::xml_document document;
  if (const auto parsed = document.load_file(path.c_str()); !parsed) {
    ThrowDamagedFile(path, parsed.description());
  }
  std::vector<Piece> pieces;
  const pugi::xml_node grid =
      document.child("VTKFile").child("PUnstructuredGrid");
  for (const pugi::xml_node& piece : grid.children("Piece")) {
    const std::string name = piece.attribute("Source").value();
    if (name.empty()) {
      ThrowDamagedFile(path, "a piece has no Source");
    }
    const fs::path file = path.parent_path() / name;
    CheckReadable(file);
    const vtkSmartPointer<vtkUnstructuredGrid> of_piece = ReadVtuGrid(file);
    // Filters of VTK trust that the parts of a grid agree, and this checks it.
    if (!ToMeshFile(file, of_piece).nodes.allFinite()) {
      ThrowDamagedVtk(file, "a position is not finite");
    }
    RemoveGhostCells(of_piece);
    // A process without cells may have written no arrays, either.
    if (of_piece->GetNumberOfCells() > 0) {
      pieces.push_back({file, of_piece});
    }
  }
  if (pieces.empty()) {
    ThrowDamagedFile(path, "it names no piece with cells");
  }
  return pieces;
}

vtkSmartPointer<vtkUnstructuredGrid> Join(const std::vector<Piece>& pieces) {
  vtkNew<vtkAppendFilter> filter;
  filter->MergePointsOn();
  for (const Piece& piece : pieces) {
    filter->AddInputData(piece.grid);
  }
  filter->Update();
  const vtkSmartPointer<vtkUnstructuredGrid> joined = filter->GetOutput();
  joined->SetFieldData(pieces[0].grid->GetFieldData());
  return joined;
}

// Returns the point of the whole grid at each point of a piece.
std::vector<vtkIdType> PointsOf(const Piece& piece,
                                vtkStaticPointLocator* locator) {
  std::vector<vtkIdType> points(piece.grid->GetNumberOfPoints());
  std::set<vtkIdType> others;
  for (vtkIdType i = 0; i < vtkIdType(points.size()); ++i) {
    points[i] = locator->FindClosestPoint(piece.grid->GetPoint(i));
    if (!others.insert(points[i]).second) {
      const double* const x = piece.grid->GetPoint(i);
      ThrowInputError(piece.path,
                      "two points are at (" + std::to_string(x[0]) + ", " +
                          std::to_string(x[1]) + ", " + std::to_string(x[2]) +
                          "), so it is unclear which one the other pieces "
                          "share; write the whole grid as one .vtu file");
    }
  }
  return points;
}

bool Agree(const Piece& piece, const std::vector<vtkIdType>& points,
           vtkDataArray* whole) {
  constexpr double kTolerance = 1e-3;
  vtkDataArray* const own =
      piece.grid->GetPointData()->GetArray(whole->GetName());
  double largest = 0;
  double difference = 0;
  for (int k = 0; k < whole->GetNumberOfComponents(); ++k) {
    for (vtkIdType i = 0; i < vtkIdType(points.size()); ++i) {
      const double value = own->GetComponent(i, k);
      // Comparisons with what is not a number are false.
      largest = std::max(largest, std::abs(value));
      difference = std::max(
          difference, std::abs(value - whole->GetComponent(points[i], k)));
    }
  }
  return difference <= kTolerance * largest;
}

// Removes the point arrays on which pieces disagree, and returns their names.
std::vector<std::string> RemoveWhatDisagrees(const std::vector<Piece>& pieces,
                                             vtkUnstructuredGrid* whole) {
  vtkNew<vtkStaticPointLocator> locator;
  locator->SetDataSet(whole);
  locator->BuildLocator();
  std::set<std::string> names;
  for (const Piece& piece : pieces) {
    const std::vector<vtkIdType> points = PointsOf(piece, locator);
    for (int i = 0; i < whole->GetPointData()->GetNumberOfArrays(); ++i) {
      vtkDataArray* const array = whole->GetPointData()->GetArray(i);
      if (array != nullptr && array->GetName() != nullptr &&
          !Agree(piece, points, array)) {
        names.insert(array->GetName());
      }
    }
  }
  for (const std::string& name : names) {
    whole->GetPointData()->RemoveArray(name.c_str());
  }
  return {names.begin(), names.end()};
}

}  // namespace

MeshFile ReadPvtuMesh(const fs::path& path) {
  const std::vector<Piece> pieces = ReadPieces(path);
  if (pieces.size() == 1) {
    return ToMeshFile(path, pieces[0].grid);
  }
  const vtkSmartPointer<vtkUnstructuredGrid> whole = Join(pieces);
  const std::vector<std::string> left_out = RemoveWhatDisagrees(pieces, whole);
  MeshFile mesh = ToMeshFile(path, whole);
  for (const std::string& name : left_out) {
    mesh.notices.push_back(PrintablePath(path) + ": the array '" +
                           Printable(name) +
                           "' is left out, as pieces have different values of "
                           "it at points that they share");
  }
  return mesh;
}

}  // namespace elastimate
