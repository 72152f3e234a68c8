#include "elastimate/io/vtk/vtk_grid.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkCellTypes.h>
#include <vtkDoubleArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkSmartPointer.h>
#include <vtkTypeInt64Array.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "elastimate/core/algebra/large_pages.h"
#include "elastimate/io/text/input_error.h"
#include "elastimate/io/text/printable.h"

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

/// The values of an array of any numeric type, at once in the type and the
/// place where they are wanted.
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

/// One column per tuple.
Eigen::MatrixXd ToMatrix(vtkDataArray* array) {
  Eigen::MatrixXd matrix;
  ResizeInLargePages(array->GetNumberOfComponents(), array->GetNumberOfTuples(),
                     matrix);
  CopyValues(array, matrix.data());
  return matrix;
}

/// The named numeric arrays; strings are left out.
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

/// "vtkQuadraticTetra" as "quadratic tetra".
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

bool IsIgnoredCell(int type) {
  return type == VTK_VERTEX || type == VTK_POLY_VERTEX || type == VTK_LINE ||
         type == VTK_POLY_LINE || type == VTK_TRIANGLE;
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

bool IsTetrahedron(const VtkGrid& grid, std::size_t cell) {
  return grid.cell_types[cell] == VTK_TETRA;
}

/// Checks the kind of each cell.
void CheckCellTypes(const std::filesystem::path& path, const VtkGrid& grid) {
  const vtkTypeInt64Array& offsets = *grid.cells->GetOffsetsArray64();
  for (std::size_t cell = 0; cell < grid.cell_types.size(); ++cell) {
    const auto index = static_cast<vtkIdType>(cell);
    if (!IsTetrahedron(grid, cell)) {
      if (!IsIgnoredCell(grid.cell_types[cell])) {
        ThrowInputError(path, "cell " + std::to_string(cell) + " is a " +
                                  CellTypeName(grid.cell_types[cell]) +
                                  ", but only linear tetrahedra are supported; "
                                  "mesh the specimen with those");
      }
    } else if (offsets.GetValue(index + 1) - offsets.GetValue(index) != 4) {
      ThrowInconsistent(path, "cell " + std::to_string(cell) +
                                  " is a tetrahedron without four points");
    }
  }
}

void CopyTetrahedra(const VtkGrid& grid, MeshFile& mesh) {
  const vtkTypeInt64Array& offsets = *grid.cells->GetOffsetsArray64();
  const vtkTypeInt64Array& connectivity = *grid.cells->GetConnectivityArray64();
  const std::int64_t num_points = grid.points.cols();
  mesh.tetrahedra.resize(
      4, std::count(grid.cell_types.begin(), grid.cell_types.end(), VTK_TETRA));
  Eigen::Index column = 0;
  for (std::size_t cell = 0; cell < grid.cell_types.size(); ++cell) {
    if (!IsTetrahedron(grid, cell)) {
      continue;
    }
    const std::int64_t first = offsets.GetValue(static_cast<vtkIdType>(cell));
    for (int corner = 0; corner < 4; ++corner) {
      const std::int64_t node = connectivity.GetValue(first + corner);
      if (node < 0 || node >= num_points) {
        ThrowInputError(
            mesh.path, "cell " + std::to_string(cell) + " names point " +
                           std::to_string(node) + ", but the file has " +
                           std::to_string(num_points) +
                           " points, counted from 0; correct its connectivity");
      }
      mesh.tetrahedra(corner, column) = static_cast<int>(node);
    }
    ++column;
  }
}

/// Of the columns of cells, those of tetrahedra.
void KeepTetrahedra(const VtkGrid& grid, std::vector<FileArray>& arrays) {
  std::vector<std::size_t> tetrahedra;
  for (std::size_t cell = 0; cell < grid.cell_types.size(); ++cell) {
    if (IsTetrahedron(grid, cell)) {
      tetrahedra.push_back(cell);
    }
  }
  for (FileArray& array : arrays) {
    array.values = Eigen::MatrixXd(array.values(Eigen::all, tetrahedra));
  }
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
  CheckCellTypes(path, grid);
  CopyTetrahedra(grid, mesh);
  CheckArrayLengths(path, grid.point_arrays, grid.points.cols());
  CheckArrayLengths(path, grid.cell_arrays,
                    static_cast<Eigen::Index>(grid.cell_types.size()));
  mesh.nodes = std::move(grid.points);
  mesh.node_arrays = std::move(grid.point_arrays);
  mesh.tetrahedron_arrays = std::move(grid.cell_arrays);
  mesh.has_other_cells = mesh.tetrahedra.cols() !=
                         static_cast<Eigen::Index>(grid.cell_types.size());
  if (mesh.has_other_cells) {
    KeepTetrahedra(grid, mesh.tetrahedron_arrays);
  }
  return mesh;
}

}  // namespace

MeshFile ToMeshFile(const std::filesystem::path& path,
                    vtkUnstructuredGrid* grid) {
  return ToMeshFile(path, ToVtkGrid(grid));
}

void ThrowDamagedVtk(const std::filesystem::path& path,
                     const std::string& reason) {
  ThrowInputError(path,
                  "the file is damaged or not a VTK file of an unstructured "
                  "grid (" +
                      reason + "); write it again");
}

}  // namespace elastimate
