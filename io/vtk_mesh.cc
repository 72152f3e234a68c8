#include "elastimate/io/vtk_mesh.h"

#include <vtkCellType.h>
#include <vtkCellTypes.h>

#include <cctype>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "elastimate/io/input_error.h"
#include "elastimate/io/vtk_grid.h"
#include "elastimate/io/vtk_reader.h"

namespace elastimate {
namespace {

[[noreturn]] void ThrowInconsistent(const std::filesystem::path& path,
                                    const std::string& reason) {
  ThrowInputError(path, "the file is damaged (" + reason + "); write it again");
}

/// "vtkQuadraticTetra" as "quadratic tetra".
std::string CellTypeName(std::int64_t type) {
  const std::string class_name =
      type < 0 || type > 255
          ? ""
          : vtkCellTypes::GetClassNameFromTypeId(static_cast<int>(type));
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

bool IsIgnoredCell(std::int64_t type) {
  return type == VTK_VERTEX || type == VTK_POLY_VERTEX || type == VTK_LINE ||
         type == VTK_POLY_LINE || type == VTK_TRIANGLE;
}

void CheckOffsets(const std::filesystem::path& path, const VtkGrid& grid) {
  const std::size_t count = grid.cell_types.size();
  bool consistent = grid.offsets.size() == count + 1 && grid.offsets[0] == 0;
  for (std::size_t cell = 0; cell < count && consistent; ++cell) {
    consistent = grid.offsets[cell] <= grid.offsets[cell + 1];
  }
  if (!consistent || grid.offsets[count] !=
                         static_cast<std::int64_t>(grid.connectivity.size())) {
    ThrowInconsistent(path,
                      "its cell types, offsets and connectivity disagree");
  }
}

/// The cells that are tetrahedra.
std::vector<std::size_t> FindTetrahedra(const std::filesystem::path& path,
                                        const VtkGrid& grid) {
  std::vector<std::size_t> tetrahedra;
  tetrahedra.reserve(grid.cell_types.size());
  for (std::size_t cell = 0; cell < grid.cell_types.size(); ++cell) {
    const std::int64_t type = grid.cell_types[cell];
    if (type == VTK_TETRA) {
      if (grid.offsets[cell + 1] - grid.offsets[cell] != 4) {
        ThrowInconsistent(path, "cell " + std::to_string(cell) +
                                    " is a tetrahedron without four points");
      }
      tetrahedra.push_back(cell);
    } else if (!IsIgnoredCell(type)) {
      ThrowInputError(path, "cell " + std::to_string(cell) + " is a " +
                                CellTypeName(type) +
                                ", but only linear tetrahedra are supported; "
                                "mesh the specimen with those");
    }
  }
  return tetrahedra;
}

void CopyTetrahedra(const VtkGrid& grid,
                    const std::vector<std::size_t>& tetrahedra,
                    MeshFile& mesh) {
  const std::int64_t num_points = grid.points.cols();
  mesh.tetrahedra.resize(4, static_cast<Eigen::Index>(tetrahedra.size()));
  Eigen::Index column = 0;
  for (const std::size_t cell : tetrahedra) {
    for (int corner = 0; corner < 4; ++corner) {
      const std::int64_t node = grid.connectivity[grid.offsets[cell] + corner];
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

void CheckArrayLengths(const std::filesystem::path& path,
                       const std::vector<FileArray>& arrays,
                       Eigen::Index length) {
  for (const FileArray& array : arrays) {
    if (array.values.cols() != length) {
      ThrowInconsistent(path, "its array '" + array.name + "' has " +
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
  const std::vector<std::size_t> tetrahedra = FindTetrahedra(path, grid);
  CopyTetrahedra(grid, tetrahedra, mesh);
  CheckArrayLengths(path, grid.point_arrays, grid.points.cols());
  CheckArrayLengths(path, grid.cell_arrays,
                    static_cast<Eigen::Index>(grid.cell_types.size()));
  mesh.nodes = std::move(grid.points);
  mesh.node_arrays = std::move(grid.point_arrays);
  mesh.tetrahedron_arrays = std::move(grid.cell_arrays);
  mesh.has_other_cells = tetrahedra.size() != grid.cell_types.size();
  if (mesh.has_other_cells) {
    for (FileArray& array : mesh.tetrahedron_arrays) {
      array.values = Eigen::MatrixXd(array.values(Eigen::all, tetrahedra));
    }
  }
  return mesh;
}

}  // namespace

MeshFile ReadVtuMesh(const std::filesystem::path& path) {
  return ToMeshFile(path, ReadXmlVtk(path));
}

MeshFile ReadLegacyVtkMesh(const std::filesystem::path& path) {
  return ToMeshFile(path, ReadLegacyVtk(path));
}

}  // namespace elastimate
