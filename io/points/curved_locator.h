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
/// the nearest points: among the straight simplices that the elements are cut
/// into those around a point, and in their elements the nearest point, by
/// projection onto the simplex that is tangent to the element at the last one
/// (Gauss-Newton; inside the element Newton's method).
class CurvedLocator {
 public:
  /// Keeps a copy of the mesh.  Precondition: valid, but for the order of
  /// nodes and for those that no element uses, and of a curved kind.
  explicit CurvedLocator(const Mesh& mesh);

  /// The nearest place; the distance is zero, but for 1e-9 of the extent,
  /// within the mesh.  `x` has z = 0 in the plane.
  CurvedPlace Find(Eigen::Vector3d x) const;

 private:
  /// The nearest place in the elements of simplices within `reach` of x.
  CurvedPlace NearestWithin(Eigen::Vector3d x, double reach) const;

  Mesh mesh_;
  vtkNew<vtkUnstructuredGrid> simplices_;
  vtkNew<vtkStaticCellLocator> locator_;
  Eigen::Index num_cuts_;
  /// Where in its element the centre of each simplex is, dimension x n.
  Eigen::MatrixXd starts_;
  /// A bound on how far elements are from their simplices.
  double margin_ = 0;
  double rounding_;
};

}  // namespace elastimate

#endif  // ELASTIMATE_IO_POINTS_CURVED_LOCATOR_H_
