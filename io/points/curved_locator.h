#ifndef ELASTIMATE_IO_POINTS_CURVED_LOCATOR_H_
#define ELASTIMATE_IO_POINTS_CURVED_LOCATOR_H_

#include <vtkGenericCell.h>
#include <vtkNew.h>
#include <vtkStaticCellLocator.h>
#include <vtkUnstructuredGrid.h>

#include <Eigen/Core>
#include <limits>

#include "elastimate/core/mesh/mesh.h"

namespace elastimate {

/// The place in a mesh that is nearest to a point.
struct CurvedPlace {
  Eigen::Index element = -1;
  Eigen::VectorXd local;  ///< Reference coordinates.
  double distance = std::numeric_limits<double>::infinity();
};

/// Finds points in curved elements, of which VTK knows neither the bounds nor
/// the nearest points.  It looks at the elements whose straight simplices, into
/// which they are cut, are around the point.  In each it finds the nearest
/// point by projection onto the simplex that is tangent to the element at the
/// last one (Gauss-Newton; inside the element Newton's method).
class CurvedLocator {
 public:
  /// Keeps a copy of the mesh.  Precondition: valid, but for the order of
  /// nodes and for those that no element uses, and of a curved kind.
  explicit CurvedLocator(const Mesh& mesh);

  /// Returns the nearest place.  Within the mesh its distance is zero to within
  /// 1e-9 of the extent.  `x` has z = 0 in the plane.
  CurvedPlace Find(Eigen::Vector3d x) const;

 private:
  /// Returns the nearest place in the elements of simplices within `reach` of
  /// x.
  CurvedPlace NearestWithin(Eigen::Vector3d x, double reach) const;

  Mesh mesh_;
  vtkNew<vtkUnstructuredGrid> simplices_;
  vtkNew<vtkStaticCellLocator> locator_;
  Eigen::Index num_cuts_;
  /// The place of the centre of each simplex in its element, dimension x n.
  Eigen::MatrixXd starts_;
  /// A bound on how far elements are from their simplices.
  double margin_ = 0;
  double rounding_;
};

}  // namespace elastimate

#endif  // ELASTIMATE_IO_POINTS_CURVED_LOCATOR_H_
