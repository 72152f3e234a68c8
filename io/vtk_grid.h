#ifndef ELASTIMATE_IO_VTK_GRID_H_
#define ELASTIMATE_IO_VTK_GRID_H_

#include <vtkCellArray.h>
#include <vtkSmartPointer.h>

#include <Eigen/Core>
#include <vector>

#include "elastimate/io/mesh_file.h"

namespace elastimate {

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

}  // namespace elastimate

#endif  // ELASTIMATE_IO_VTK_GRID_H_
