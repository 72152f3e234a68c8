#ifndef ELASTIMATE_IO_POINTS_POINT_GRID_H_
#define ELASTIMATE_IO_POINTS_POINT_GRID_H_

#include <vtkUnstructuredGrid.h>

#include <Eigen/Core>

#include "elastimate/core/mesh/mesh.h"

namespace elastimate {

/// How far outside a point may be and still counts as inside, of reference
/// coordinates and of the diagonal of the mesh.
inline constexpr double kRoundingOfPlaces = 1e-9;

/// With z = 0 in the plane.
inline Eigen::Vector3d ToSpace(const Eigen::Ref<const Eigen::VectorXd>& x) {
  Eigen::Vector3d in_space = Eigen::Vector3d::Zero();
  in_space.head(x.size()) = x;
  return in_space;
}

/// Makes `grid` the elements of order 1 with the vertices of the mesh.
void SetCells(const Mesh& mesh, vtkUnstructuredGrid* grid);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_POINTS_POINT_GRID_H_
