#ifndef ELASTIMATE_IO_POINTS_POINT_LOCATOR_H_
#define ELASTIMATE_IO_POINTS_POINT_LOCATOR_H_

#include <Eigen/Core>
#include <memory>

#include "elastimate/core/mesh/mesh.h"
#include "elastimate/core/mesh/mesh_points.h"

namespace elastimate {

/// Points with the elements of a mesh in which they lie.
struct LocatedPoints {
  /// The given points, or the nearest points of the mesh where they lie
  /// outside.
  MeshPoints points;
  Eigen::VectorXd distance;  ///< From the given points [length]; zero inside.
};

/// How far outside a mesh a measured point may lie where nothing else is said,
/// over the diagonal of the bounding box of the mesh.
inline constexpr double kUsualPointTolerance = 1e-3;

/// Finds the elements of a mesh in which points lie, by VTK's cell locator.
class PointLocator {
 public:
  /// Keeps a copy of the mesh.  Precondition: a valid mesh.  O(num_elements).
  explicit PointLocator(const Mesh& mesh);
  ~PointLocator();
  PointLocator(PointLocator&&) noexcept;
  PointLocator& operator=(PointLocator&&) noexcept;

  /// `positions` are dimension x n, finite.  A point within several elements
  /// belongs to one of them.  About O(n).
  LocatedPoints Locate(const Eigen::MatrixXd& positions) const;

 private:
  struct Grid;
  std::unique_ptr<Grid> grid_;
};

}  // namespace elastimate

#endif  // ELASTIMATE_IO_POINTS_POINT_LOCATOR_H_
