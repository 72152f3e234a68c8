#include "elastimate/io/vtk/pvtu_mesh.h"

#include <vtkAppendFilter.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkSmartPointer.h>
#include <vtkStaticPointLocator.h>
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
    of_piece->RemoveGhostCells();
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
      ThrowInputError(piece.path,
                      "point " + std::to_string(i) +
                          " lies where another point of this piece does, and "
                          "the pieces of a .pvtu file are joined where their "
                          "points are at the same place; write the whole grid "
                          "as one .vtu file");
    }
  }
  return points;
}

void CheckValues(const Piece& piece, const std::vector<vtkIdType>& points,
                 vtkDataArray* whole) {
  constexpr double kTolerance = 1e-3;
  vtkDataArray* const own =
      piece.grid->GetPointData()->GetArray(whole->GetName());
  for (int component = 0; component < whole->GetNumberOfComponents();
       ++component) {
    const double* const range = whole->GetFiniteRange(component);
    const double largest = std::max(std::abs(range[0]), std::abs(range[1]));
    for (vtkIdType i = 0; i < vtkIdType(points.size()); ++i) {
      const double difference =
          std::abs(own->GetComponent(i, component) -
                   whole->GetComponent(points[i], component));
      if (difference > kTolerance * largest) {
        ThrowInputError(
            piece.path,
            "the array '" + std::string(whole->GetName()) +
                "' has another value at point " + std::to_string(i) +
                " than another piece has at the same place; write values that "
                "agree, or leave the array out");
      }
    }
  }
}

void CheckJoints(const std::vector<Piece>& pieces, vtkUnstructuredGrid* whole) {
  vtkNew<vtkStaticPointLocator> locator;
  locator->SetDataSet(whole);
  locator->BuildLocator();
  for (const Piece& piece : pieces) {
    const std::vector<vtkIdType> points = PointsOf(piece, locator);
    for (int i = 0; i < whole->GetPointData()->GetNumberOfArrays(); ++i) {
      if (vtkDataArray* const array = whole->GetPointData()->GetArray(i)) {
        CheckValues(piece, points, array);
      }
    }
  }
}

}  // namespace

MeshFile ReadPvtuMesh(const fs::path& path) {
  const std::vector<Piece> pieces = ReadPieces(path);
  const vtkSmartPointer<vtkUnstructuredGrid> whole = Join(pieces);
  CheckJoints(pieces, whole);
  return ToMeshFile(path, whole);
}

}  // namespace elastimate
