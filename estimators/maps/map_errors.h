#ifndef ELASTIMATE_ESTIMATORS_MAPS_MAP_ERRORS_H_
#define ELASTIMATE_ESTIMATORS_MAPS_MAP_ERRORS_H_

#include <Eigen/Core>

#include "elastimate/estimators/maps/field_prior.h"
#include "elastimate/estimators/maps/map_problem.h"
#include "elastimate/estimators/maps/smooth_map.h"

namespace elastimate {

/// How well a smooth map is known.
struct MapErrors {
  /// The standard deviation of ln E of each element, with the level.
  Eigen::VectorXd log_modulus_sd;
  /// The covariance of the mean of ln E over the volume and of the
  /// LogStiffnessRatio of nu, by the linearised model.
  Eigen::Matrix2d covariance_of_means;
};

/// Changes of a map, a column for each.
struct MapChanges {
  Eigen::MatrixXd log_moduli;              ///< With the level.
  Eigen::RowVectorXd log_stiffness_ratio;  ///< Of nu.
};

/// Returns the changes by changes W of the rows, and of y by the sources B,
///
///   (I / k + H) y = A^T S^T Pi W + B,
///
/// with the flat unknowns.  The error of y is `tolerance` in the norm of that
/// system, relative.  Preconditions: the model is at the map, and Eliminate has
/// been applied to W.  Cost: solves of the system by preconditioned conjugate
/// gradients, all at once.
[[nodiscard]] MapChanges ChangesOfMap(const MapProblem& problem,
                                      const FieldPrior& prior,
                                      const SmoothMap& map,
                                      const Eigen::MatrixXd& rows,
                                      const Eigen::MatrixXd& sources,
                                      double tolerance);

/// Draws fields from the posterior of the linearised model: noise eta and zeta
/// of unit variance give
///
///   (I / k + H) y = sigma A^T S^T Pi eta + sigma zeta / k^(1/2),
///
/// and the flat unknowns with them.  A standard deviation from the 64 draws has
/// an error of 9 %.  Precondition: the model is at the map.  Cost: 64 solves of
/// the system by preconditioned conjugate gradients, all at once.
[[nodiscard]] MapErrors DescribeMap(const MapProblem& problem,
                                    const FieldPrior& prior,
                                    const SmoothMap& map);

/// Returns l_e = (V_e / R_ee)^(1/d) [length], the size of what the data resolve
/// around each element, at most that of the body.  R = A W A^-1 with
/// W = k H (I + k H)^-1 is the resolution, whose trace is gamma.  Its diagonal
/// follows from the modes of H.  The rest of the diagonal is the mean of
/// z_e (R z)_e over 64 vectors z of random signs.  It is then smoothed over
/// neighbours, because it changes little between them.  Precondition: the model
/// is at the map.  Cost: 64 solves of the system, all at once, unless all modes
/// are there.
[[nodiscard]] Eigen::VectorXd ResolutionLengths(const MapProblem& problem,
                                                const FieldPrior& prior,
                                                const SmoothMap& map);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_MAPS_MAP_ERRORS_H_
