#include "elastimate/io/points/point_grid.h"

#include <vtkCellArray.h>
#include <vtkCellType.h>
#include <vtkNew.h>
#include <vtkPoints.h>

#include <vector>

namespace elastimate {
namespace {

int CellTypeOfVertices(ElementKind kind) {
  if (IsSimplex(kind)) {
    return DimensionOf(kind) == 3 ? VTK_TETRA : VTK_TRIANGLE;
  }
  return DimensionOf(kind) == 3 ? VTK_HEXAHEDRON : VTK_QUAD;
}

}  // namespace

void SetCells(const Mesh& mesh, vtkUnstructuredGrid* grid) {
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  points->SetNumberOfPoints(mesh.NumNodes());
  for (Eigen::Index node = 0; node < mesh.NumNodes(); ++node) {
    points->SetPoint(node, ToSpace(mesh.nodes.col(node)).data());
  }
  vtkNew<vtkCellArray> cells;
  const int num_vertices = mesh.Topology().num_vertices;
  std::vector<vtkIdType> vertices(num_vertices);
  for (Eigen::Index element = 0; element < mesh.NumElements(); ++element) {
    for (int i = 0; i < num_vertices; ++i) {
      vertices[i] = mesh.elements(i, element);
    }
    cells->InsertNextCell(num_vertices, vertices.data());
  }
  grid->SetPoints(points);
  grid->SetCells(CellTypeOfVertices(mesh.kind), cells);
}

}  // namespace elastimate
