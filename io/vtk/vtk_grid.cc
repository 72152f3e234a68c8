#include "elastimate/io/vtk/vtk_grid.h"

#include <vtkCell.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkCellTypes.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkGenericCell.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkSmartPointer.h>
#include <vtkTypeInt64Array.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "elastimate/core/algebra/large_pages.h"
#include "elastimate/io/mesh/cut_cells.h"
#include "elastimate/io/mesh/simplices.h"
#include "elastimate/io/text/input_error.h"
#include "elastimate/io/text/printable.h"
#include "elastimate/io/vtk/vtk_cells.h"

namespace elastimate {
namespace {

/// An unstructured grid as a VTK file holds it: whether its parts agree is not
/// checked.
struct VtkGrid {
  Eigen::Matrix3Xd points;
  std::vector<unsigned char> cell_types;
  vtkSmartPointer<vtkCellArray> cells;  ///< Stored in 64 bits; null when there
                                        ///< are none.
  std::vector<FileArray> point_arrays;
  std::vector<FileArray> cell_arrays;
};

/// Copies the values of an array of any numeric type, and converts them on the
/// way, so that no second copy is needed.
template <typename Value>
void CopyValues(vtkDataArray* array, Value* to) {
  switch (array->GetDataType()) {
    vtkTemplateMacro(
        std::copy_n(static_cast<const VTK_TT*>(array->GetVoidPointer(0)),
                    array->GetNumberOfValues(), to));
    default: {  // Bits.
      vtkNew<vtkDoubleArray> doubles;
      doubles->DeepCopy(array);
      std::copy_n(doubles->GetPointer(0), doubles->GetNumberOfValues(), to);
    }
  }
}

/// Returns one column per tuple.
Eigen::MatrixXd ToMatrix(vtkDataArray* array) {
  Eigen::MatrixXd matrix;
  ResizeInLargePages(array->GetNumberOfComponents(), array->GetNumberOfTuples(),
                     matrix);
  CopyValues(array, matrix.data());
  return matrix;
}

/// Returns the named numeric arrays; strings are left out.
std::vector<FileArray> ToArrays(vtkDataSetAttributes* attributes) {
  std::vector<FileArray> arrays;
  for (int i = 0; i < attributes->GetNumberOfArrays(); ++i) {
    vtkDataArray* array = attributes->GetArray(i);
    if (array != nullptr && array->GetName() != nullptr) {
      arrays.push_back({array->GetName(), ToMatrix(array)});
    }
  }
  return arrays;
}

vtkSmartPointer<vtkTypeInt64Array> ToVtkArray(
    const std::vector<std::int64_t>& values) {
  auto array = vtkSmartPointer<vtkTypeInt64Array>::New();
  array->SetNumberOfValues(vtkIdType(values.size()));
  std::copy(values.begin(), values.end(), array->GetPointer(0));
  return array;
}

VtkGrid ToVtkGrid(vtkUnstructuredGrid* from) {
  VtkGrid grid;
  if (from->GetPoints() != nullptr) {
    grid.points.resize(3, from->GetNumberOfPoints());
    CopyValues(from->GetPoints()->GetData(), grid.points.data());
  }
  if (from->GetCells() != nullptr && from->GetCellTypesArray() != nullptr) {
    grid.cell_types.resize(from->GetCellTypesArray()->GetNumberOfValues());
    CopyValues(from->GetCellTypesArray(), grid.cell_types.data());
    grid.cells = from->GetCells();
    grid.cells->ConvertTo64BitStorage();
  }
  grid.point_arrays = ToArrays(from->GetPointData());
  grid.cell_arrays = ToArrays(from->GetCellData());
  return grid;
}

[[noreturn]] void ThrowInconsistent(const std::filesystem::path& path,
                                    const std::string& reason) {
  ThrowInputError(path, "the file is damaged (" + reason + "); write it again");
}

/// Turns "vtkQuadraticTetra" into "quadratic tetra".
std::string CellTypeName(int type) {
  const std::string class_name = vtkCellTypes::GetClassNameFromTypeId(type);
  if (class_name.rfind("vtk", 0) != 0) {
    return "cell of unknown type " + std::to_string(type);
  }
  std::string name;
  for (const char c : class_name.substr(3)) {
    if (std::isupper(static_cast<unsigned char>(c)) != 0 && !name.empty()) {
      name += ' ';
    }
    name += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  return name;
}

/// Returns the cells that may be elements.
constexpr std::array<std::pair<int, ElementKind>, 8> kCellKinds = {
    {{VTK_TETRA, ElementKind::kTet4},
     {VTK_QUADRATIC_TETRA, ElementKind::kTet10},
     {VTK_HEXAHEDRON, ElementKind::kHex8},
     {VTK_TRIQUADRATIC_HEXAHEDRON, ElementKind::kHex27},
     {VTK_TRIANGLE, ElementKind::kTri3},
     {VTK_QUADRATIC_TRIANGLE, ElementKind::kTri6},
     {VTK_QUAD, ElementKind::kQuad4},
     {VTK_BIQUADRATIC_QUAD, ElementKind::kQuad9}}};

std::optional<ElementKind> KindOfCell(int type) {
  for (const auto& [cell_type, kind] : kCellKinds) {
    if (cell_type == type) {
      return kind;
    }
  }
  return std::nullopt;
}

/// Returns 3 for a cell of unknown type, which must not be ignored.
int DimensionOfCell(int type) {
  if (const std::optional<ElementKind> kind = KindOfCell(type)) {
    return TopologyOf(*kind).dimension;
  }
  const vtkSmartPointer<vtkCell> cell =
      vtkSmartPointer<vtkCell>::Take(vtkGenericCell::InstantiateCell(type));
  return cell == nullptr || type == VTK_EMPTY_CELL ? 3
                                                   : cell->GetCellDimension();
}

void CheckOffsets(const std::filesystem::path& path, const VtkGrid& grid) {
  const vtkTypeInt64Array& offsets = *grid.cells->GetOffsetsArray64();
  const auto count = static_cast<vtkIdType>(grid.cell_types.size());
  bool consistent =
      offsets.GetNumberOfValues() == count + 1 && offsets.GetValue(0) == 0;
  for (vtkIdType cell = 0; cell < count && consistent; ++cell) {
    consistent = offsets.GetValue(cell) <= offsets.GetValue(cell + 1);
  }
  if (!consistent ||
      offsets.GetValue(count) != grid.cells->GetNumberOfConnectivityIds()) {
    ThrowInconsistent(path,
                      "its cell types, offsets and connectivity disagree");
  }
}

/// Returns the cells of dimension 3 where there are any, else those of
/// dimension 2.
std::vector<std::size_t> CellsOfHighestDimension(const VtkGrid& grid) {
  std::array<int, 256> dimension_of_type;
  dimension_of_type.fill(-1);
  int highest = 2;
  for (const unsigned char type : grid.cell_types) {
    if (dimension_of_type[type] < 0) {
      dimension_of_type[type] = DimensionOfCell(type);
      highest = std::max(highest, dimension_of_type[type]);
    }
  }
  std::vector<std::size_t> cells;
  for (std::size_t cell = 0; cell < grid.cell_types.size(); ++cell) {
    if (dimension_of_type[grid.cell_types[cell]] == highest) {
      cells.push_back(cell);
    }
  }
  return cells;
}

/// What a cell may be cut as.
struct CellToCut {
  const CellShape* shape = nullptr;  ///< Null for cells of other types.
  bool is_quadratic = false;

  int NumPoints() const {
    return shape->num_vertices + (is_quadratic ? int(shape->edges.size()) : 0);
  }
};

/// The points of these types are in the order of FileCell.
CellToCut CellToCutOf(int type) {
  switch (type) {
    case VTK_TRIANGLE:
      return {FindCellShape(2, 3), false};
    case VTK_QUAD:
      return {FindCellShape(2, 4), false};
    case VTK_TETRA:
      return {FindCellShape(3, 4), false};
    case VTK_PYRAMID:
      return {FindCellShape(3, 5), false};
    case VTK_WEDGE:
      return {FindCellShape(3, 6), false};
    case VTK_HEXAHEDRON:
      return {FindCellShape(3, 8), false};
    case VTK_QUADRATIC_TRIANGLE:
      return {FindCellShape(2, 3), true};
    case VTK_QUADRATIC_QUAD:
      return {FindCellShape(2, 4), true};
    case VTK_QUADRATIC_TETRA:
      return {FindCellShape(3, 4), true};
    case VTK_QUADRATIC_PYRAMID:
      return {FindCellShape(3, 5), true};
    case VTK_QUADRATIC_WEDGE:
      return {FindCellShape(3, 6), true};
    case VTK_QUADRATIC_HEXAHEDRON:
      return {FindCellShape(3, 8), true};
    default:
      return {};
  }
}

/// Tells whether all cells may be cut into simplices, and are not of one kind
/// otherwise.
bool AreToBeCut(const VtkGrid& grid, const std::vector<std::size_t>& cells) {
  const auto type = [&](std::size_t cell) { return grid.cell_types[cell]; };
  return std::all_of(cells.begin(), cells.end(),
                     [&](std::size_t cell) {
                       const CellToCut of_cell = CellToCutOf(type(cell));
                       return of_cell.shape != nullptr &&
                              of_cell.is_quadratic ==
                                  CellToCutOf(type(cells[0])).is_quadratic;
                     }) &&
         std::any_of(cells.begin(), cells.end(), [&](std::size_t cell) {
           return !KindOfCell(type(cell)) || type(cell) != type(cells[0]);
         });
}

/// "cell 7 is a wedge".
std::string CellName(const VtkGrid& grid, std::size_t cell) {
  return "cell " + std::to_string(cell) + " is a " +
         CellTypeName(grid.cell_types[cell]);
}

/// Returns the kind of elements that the cells are, which must be one.
ElementKind TheOneKind(const std::filesystem::path& path, const VtkGrid& grid,
                       const std::vector<std::size_t>& cells) {
  const int first_type = grid.cell_types[cells.front()];
  for (const std::size_t cell : cells) {
    const int type = grid.cell_types[cell];
    if (!KindOfCell(type) && CellToCutOf(type).shape == nullptr) {
      ThrowInputError(
          path, CellName(grid, cell) + ", but the cells of a scene are " +
                    kSupportedElements + "; mesh the specimen with these");
    }
    if (type != first_type) {
      ThrowInputError(path, CellName(grid, cell) + ", but " +
                                CellName(grid, cells.front()) +
                                "; mesh the specimen with cells of one kind, "
                                "or with all linear or all quadratic ones");
    }
  }
  return *KindOfCell(first_type);
}

/// Returns the points of a cell, of which `due` are due.
std::vector<int> PointsOfCell(const std::filesystem::path& path,
                              const VtkGrid& grid, std::size_t cell, int due) {
  const vtkTypeInt64Array& offsets = *grid.cells->GetOffsetsArray64();
  const vtkTypeInt64Array& connectivity = *grid.cells->GetConnectivityArray64();
  const auto index = static_cast<vtkIdType>(cell);
  const vtkIdType first = offsets.GetValue(index);
  const vtkIdType count = offsets.GetValue(index + 1) - first;
  if (count != due) {
    ThrowInconsistent(path, CellName(grid, cell) + " of " +
                                std::to_string(count) + " points where " +
                                std::to_string(due) + " are due");
  }
  std::vector<int> points;
  for (vtkIdType i = 0; i < count; ++i) {
    const std::int64_t point = connectivity.GetValue(first + i);
    if (point < 0 || point >= grid.points.cols()) {
      ThrowInputError(path,
                      "cell " + std::to_string(cell) + " names point " +
                          std::to_string(point) + ", but there are " +
                          std::to_string(grid.points.cols()) +
                          " points, counted from 0; correct its connectivity");
    }
    points.push_back(static_cast<int>(point));
  }
  return points;
}

/// Makes the cells the elements of the mesh, and returns the cell of each.
std::vector<std::size_t> CutElements(const VtkGrid& grid,
                                     const std::vector<std::size_t>& cells,
                                     MeshFile& mesh) {
  std::vector<FileCell> to_cut;
  for (const std::size_t cell : cells) {
    const CellToCut of_cell = CellToCutOf(grid.cell_types[cell]);
    to_cut.push_back({of_cell.shape, PointsOfCell(mesh.path, grid, cell,
                                                  of_cell.NumPoints())});
  }
  std::vector<std::size_t> cell_of_element = CutCells(
      to_cut, [&](std::size_t k) { return CellName(grid, cells[k]) + " that"; },
      mesh);
  for (std::size_t& cell : cell_of_element) {
    cell = cells[cell];
  }
  mesh.element_numbers = cell_of_element;
  return cell_of_element;
}

/// Makes the cells, of one kind, the elements of the mesh.
void CopyElements(const VtkGrid& grid, const std::vector<std::size_t>& cells,
                  MeshFile& mesh) {
  mesh.kind = TheOneKind(mesh.path, grid, cells);
  const int num_nodes = mesh.Topology().num_nodes;
  mesh.elements.resize(num_nodes, static_cast<Eigen::Index>(cells.size()));
  Eigen::Index column = 0;
  for (const std::size_t cell : cells) {
    const std::vector<int> points =
        PointsOfCell(mesh.path, grid, cell, num_nodes);
    std::copy(points.begin(), points.end(), mesh.elements.col(column).begin());
    ++column;
  }
}

/// Returns a number of the field data, if there is an array of that name.
std::optional<double> FieldNumber(const std::filesystem::path& path,
                                  const char* name, vtkFieldData* data) {
  if (data->GetAbstractArray(name) == nullptr) {
    return std::nullopt;
  }
  vtkDataArray* const array = data->GetArray(name);
  if (array == nullptr || array->GetNumberOfValues() != 1) {
    ThrowInputError(path, std::string("the field data '") + name +
                              "' are not one number; correct them");
  }
  return array->GetComponent(0, 0);
}

void CheckArrayLengths(const std::filesystem::path& path,
                       const std::vector<FileArray>& arrays,
                       Eigen::Index length) {
  for (const FileArray& array : arrays) {
    if (array.values.cols() != length) {
      ThrowInconsistent(path, "its array '" + Printable(array.name) + "' has " +
                                  std::to_string(array.values.cols()) +
                                  " rows where " + std::to_string(length) +
                                  " are due");
    }
  }
}

MeshFile ToMeshFile(const std::filesystem::path& path, VtkGrid grid) {
  MeshFile mesh;
  mesh.path = path;
  if (grid.points.cols() > std::numeric_limits<int>::max()) {
    ThrowInputError(path, "the mesh has more than 2^31 points; coarsen it");
  }
  if (grid.cell_types.empty()) {
    return mesh;
  }
  CheckOffsets(path, grid);
  std::vector<std::size_t> cells = CellsOfHighestDimension(grid);
  mesh.has_other_cells = cells.size() != grid.cell_types.size();
  CheckArrayLengths(path, grid.point_arrays, grid.points.cols());
  CheckArrayLengths(path, grid.cell_arrays,
                    static_cast<Eigen::Index>(grid.cell_types.size()));
  if (AreToBeCut(grid, cells)) {
    mesh.nodes = grid.points;
    cells = CutElements(grid, cells, mesh);
  } else if (!cells.empty()) {
    CopyElements(grid, cells, mesh);
    mesh.nodes = std::move(grid.points);
  }
  mesh.node_arrays = std::move(grid.point_arrays);
  ExtendNodeArrays(mesh);
  mesh.element_arrays = std::move(grid.cell_arrays);
  if (mesh.has_other_cells || mesh.is_cut) {
    for (FileArray& array : mesh.element_arrays) {
      array.values = Eigen::MatrixXd(array.values(Eigen::all, cells));
    }
  }
  return mesh;
}

}  // namespace

MeshFile ToMeshFile(const std::filesystem::path& path,
                    vtkUnstructuredGrid* grid) {
  MeshFile mesh = ToMeshFile(path, ToVtkGrid(grid));
  mesh.model = FieldNumber(path, "model", grid->GetFieldData());
  mesh.thickness = FieldNumber(path, "thickness", grid->GetFieldData());
  const double computed =
      FieldNumber(path, "computed", grid->GetFieldData()).value_or(0);
  mesh.origin = computed == 1   ? Origin::kComputed
                : computed == 2 ? Origin::kComputedAtLargeStrains
                                : Origin::kMeasured;
  return mesh;
}

MeshFile ToMeshFile(const std::string& name, VtkCells cells) {
  VtkGrid grid;
  grid.points = std::move(cells.points);
  grid.cell_types = std::move(cells.types);
  grid.cells = vtkSmartPointer<vtkCellArray>::New();
  grid.cells->SetData(ToVtkArray(cells.offsets).Get(),
                      ToVtkArray(cells.connectivity).Get());
  const auto num_cells = Eigen::Index(grid.cell_types.size());
  grid.cell_arrays = {{"cell", Eigen::RowVectorXd::LinSpaced(
                                   num_cells, 0, double(num_cells - 1))}};
  return ToMeshFile(std::filesystem::path(name), std::move(grid));
}

void ThrowDamagedVtk(const std::filesystem::path& path,
                     const std::string& reason) {
  ThrowInputError(path,
                  "the file is damaged or not a VTK file of an unstructured "
                  "grid (" +
                      reason + "); write it again");
}

}  // namespace elastimate
