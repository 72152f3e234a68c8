#ifndef ELASTIMATE_ESTIMATORS_MATERIAL_FIT_MERGE_PLAN_H_
#define ELASTIMATE_ESTIMATORS_MATERIAL_FIT_MERGE_PLAN_H_

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "elastimate/core/materials/material.h"
#include "elastimate/core/materials/material_parameters.h"

namespace elastimate {

/// The variables of a fit (FreeParameters), and their covariance.
struct VariableEstimate {
  Eigen::VectorXd variables;
  Eigen::MatrixXd covariance;
};

/// Materials that are one: their places among all, ascending; groups in the
/// order of their first members.
using MaterialGroups = std::vector<std::vector<std::size_t>>;

/// A step of a plan.
struct PlannedMerge {
  std::vector<std::size_t> first;  ///< The groups that become one.
  std::vector<std::size_t> second;
  double chi_square;  ///< d^2
  double limit;       ///< k ln n, which it should not exceed.
  /// All groups after it, and their variables.
  MaterialGroups groups;
  Eigen::VectorXd variables;
};

/// Which of some materials are the same as far as their parameters show: from
/// all of them apart on, the two that are nearest become one, again and again,
/// until no two of one kind are left.  Near is the Wald distance of what is not
/// known of them,
///
///   d^2 = (x_a - x_b)^T C_(a-b)^-1 (x_a - x_b),
///
/// of chi^2 with as many degrees of freedom as there are such parameters where
/// the two are the same.  The others follow without another fit, by least
/// squares under the constraint R x = x_a - x_b = 0 [Rao 1973, 4a.9]:
///
///   x - C R^T (R C R^T)^-1 R x,   C - C R^T (R C R^T)^-1 R C.
struct MergePlan {
  std::vector<PlannedMerge> path;
  /// The first steps of the path, which lead to the least of the Bayesian
  /// information criterion [Schwarz 1978]: the sum of d^2 - k ln n over steps
  /// that leave k parameters less to explain n observations.
  std::size_t num_taken = 0;
};

/// Only materials of one law, with the same known values and bounds, become
/// one.  Preconditions: valid materials, and a positive definite covariance of
/// their free parameters.  O(num_materials^3 k^3 + num_materials p^2) for p
/// variables.
MergePlan PlanMerges(const std::vector<Material>& materials,
                     const MaterialParameters& parameters,
                     VariableEstimate estimate, double num_observations);

/// What it adds to the sum of squares over its variance that the materials of
/// each group are one, to second order: (R x)^T (R C R^T)^-1 R x, C without
/// what is no noise.
double ChiSquareOfGroups(const MaterialGroups& groups,
                         const MaterialParameters& parameters,
                         const VariableEstimate& estimate);

/// One material for each group; none where one of all is isotropic, and nothing
/// of it given.
std::vector<Material> MaterialsOfGroups(const std::vector<Material>& materials,
                                        const MaterialGroups& groups);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_MATERIAL_FIT_MERGE_PLAN_H_
