#ifndef ELASTIMATE_ESTIMATORS_MISFIT_MESH_ERROR_H_
#define ELASTIMATE_ESTIMATORS_MISFIT_MESH_ERROR_H_

#include <Eigen/Core>

#include "elastimate/estimators/interface/free_parameters.h"

namespace elastimate {

/// What a fit with finer elements changed.
struct SpaceChange {
  /// d = x_fine - x_coarse of the variables at the two minima.
  Eigen::VectorXd variables;
  /// u_fine(x_fine) - u_coarse(x_fine) in the rows of the misfit.
  Eigen::VectorXd rows;
  /// Whether the coarse elements are quadratic, as those of the divided mesh
  /// that made them finer; else they are linear, and the fine ones quadratic
  /// ones of the same mesh.
  bool is_of_quadratic = false;
  /// Whether no finer fit is made because this change is small: half of what
  /// is notable is then part of the error, since some changes are small by
  /// accident.
  bool is_kept_for_its_size = false;
  /// Half of the way to the minimum on the other support ends that there may
  /// be; empty where there are none.
  Eigen::VectorXd by_supports = {};
};

/// The mesh error of the fine one of two fits: what finer elements still would
/// change.
struct MeshError {
  Eigen::VectorXd correction;  ///< What is added to the variables x_fine.
  Eigen::MatrixXd covariance;  ///< What it adds to that of the variables.
  /// The part of the covariance that the ends of supports have.
  Eigen::MatrixXd of_supports;
};

/// A fraction of the change from the coarse to the fine elements, calibrated on
/// ten shapes and tested on ten others:
///
///   x = x_fine + k d,
///   Cov = c^2 d d^T + G diag(b^2 ||du||^2 I, b^2 dR^2) G^T,
///   G = (S^T S)^-1 S^T,
///
/// with du the displacement rows of the change and dR the rows of its
/// resultants.  The second term holds what the first misses where the change of
/// a variable is small by accident.  For m variables
///
///   quadratic elements on the divided mesh:   k = c = 1/2, b = 0.075 sqrt(2/m)
///   the same where Poisson's ratio is given:  k = c = 0.35, b = 0
///   quadratic elements on the same mesh:      k = 0, c = 1/2, b = 0.03
///   sqrt(2/m)
///
/// and on the same mesh the change of each ratio counts as 0.2 of the largest
/// change of a modulus at least, since linear elements may have Poisson's ratio
/// right by accident while their modulus is off.
///
/// Support ends in doubt add h to the correction and h h^T to the covariance,
/// h being half of the way to the minimum on the other ends.
///
/// `sensitivities` is S, the derivatives of the rows at the fine fit, and
/// `inverse` (S^T S)^-1; `num_displacements` rows come before those of
/// resultants.  O(num_rows m^2).
MeshError MeshErrorOf(const SpaceChange& change, const FreeParameters& free,
                      const Eigen::MatrixXd& sensitivities,
                      const Eigen::MatrixXd& inverse,
                      Eigen::Index num_displacements);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_MISFIT_MESH_ERROR_H_
