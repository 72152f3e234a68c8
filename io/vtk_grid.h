#ifndef ELASTIMATE_IO_VTK_GRID_H_
#define ELASTIMATE_IO_VTK_GRID_H_

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "elastimate/io/mesh_file.h"

namespace elastimate {

/// An unstructured grid as a VTK file holds it: whether its parts agree is not
/// checked.
struct VtkGrid {
  Eigen::Matrix3Xd points;
  std::vector<std::int64_t> cell_types;
  std::vector<std::int64_t> offsets;  ///< Of each cell in `connectivity`, and
                                      ///< of its end.
  std::vector<std::int64_t> connectivity;
  std::vector<FileArray> point_arrays;
  std::vector<FileArray> cell_arrays;
};

}  // namespace elastimate

#endif  // ELASTIMATE_IO_VTK_GRID_H_
