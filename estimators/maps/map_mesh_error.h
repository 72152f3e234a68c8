#ifndef ELASTIMATE_ESTIMATORS_MAPS_MAP_MESH_ERROR_H_
#define ELASTIMATE_ESTIMATORS_MAPS_MAP_MESH_ERROR_H_

#include <Eigen/Core>
#include <vector>

#include "elastimate/core/scene/scene.h"
#include "elastimate/estimators/maps/field_prior.h"
#include "elastimate/estimators/maps/field_sensitivity.h"
#include "elastimate/estimators/maps/level_fit.h"
#include "elastimate/estimators/maps/map_errors.h"
#include "elastimate/estimators/maps/map_problem.h"
#include "elastimate/estimators/maps/smooth_map.h"

namespace elastimate {

/// What the quadratic elements of a map may miss, by the rule of fits of few
/// parameters: c = 1/2 of what they changed from linear ones.  With du, the
/// change of the displacements of the model,
///
///   |c Pi du|^2   is how much of a square sum the elements may explain,
///   c d           is the error of a smooth map that du changes by d
///                 (ChangesOfMap),
///   c^2 d d^T + (b |du|)^2 (Z^T Z)^-1,   b = 0.03 (2 / m)^(1/2),
///                 is the covariance of m levels and nu whose fit changes by d,
///
/// where |d nu| is not below 0.2 of the mean of |d ln E| over the volume.
class MapMeshError {
 public:
  /// `linear` has the linear elements that those of the model of `problem`
  /// refine.  Both must outlive this object.
  MapMeshError(const Scene& linear, SolverKind solver,
               const MapProblem& problem);

  /// The functions below move the model of the problem to the fit.  They take a
  /// factorisation with linear elements, and where these have no solution, what
  /// they return is zero.

  /// Returns |c Pi du|^2.
  [[nodiscard]] double SquareSum(const LevelFit& fit);
  /// Returns the covariance of ln E of each part and the LogStiffnessRatio of
  /// nu.  Cost: a fit with linear elements.
  [[nodiscard]] Eigen::MatrixXd CovarianceOf(
      const FieldPrior& prior, const std::vector<int>& part_of_element,
      const LevelFit& fit);
  Work WorkDone() const { return coarse_.WorkDone(); }
  /// Returns c d, one column.
  [[nodiscard]] MapChanges ErrorOf(const FieldPrior& prior,
                                   const SmoothMap& map);

 private:
  // Returns du at a state; zero where a model has no solution.
  Eigen::VectorXd ChangeOfRows(const MapState& state, double noise);

  const MapProblem& problem_;
  FieldSensitivity coarse_;
};

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_MAPS_MAP_MESH_ERROR_H_
