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
  double limit;       ///< Which it should not exceed.
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
  /// that leave k parameters less to explain n observations.  In place of k ln
  /// n at least the quantile for 0.99 of chi^2 of k (m - 1) degrees of freedom,
  /// which the scatter of all m members of both groups has [Scheffe, Biometrika
  /// 40 (1953) 87]: no two of their means are farther apart.
  std::size_t num_taken = 0;
};

/// Only groups whose variables are all within their largest errors are
/// compared, which some are after others became one; only materials of one law,
/// with the same known values and bounds, become one.  Preconditions: valid
/// materials, and a positive definite covariance of their free parameters.
/// O(num_materials^3 k^3 + num_materials p^2) for p variables.
MergePlan PlanMerges(const std::vector<Material>& materials,
                     const MaterialParameters& parameters,
                     const Eigen::VectorXd& largest_errors,
                     VariableEstimate estimate, double num_observations);

/// (x - x_0)^T C^-1 (x - x_0) of variables x_0 that the members of each group
/// share, which are given for each group: the sum of d^2 over the path where
/// they are those of a plan.
double DistanceOfGroups(const MaterialGroups& groups,
                        const MaterialParameters& parameters,
                        const VariableEstimate& estimate,
                        const Eigen::VectorXd& variables_of_groups);

/// What becoming one material hides of the members of a group, for each of
/// their variables.
struct MemberSpread {
  /// The mean square of x_i - x of the members i, weighted by 1 / C_ii, as far
  /// as it is more than noise explains,
  ///
  ///   max(0, sum w_i ((x_i - x)^2 - var(x_i - x)) / sum w_i)
  ///
  /// [DerSimonian & Laird, Control. Clin. Trials 7 (1986) 177, with correlated
  /// errors]: a region of the material is that much more uncertain than their
  /// mean.  At least the largest w (x_rest - x)^2
  /// of members that may be others than the rest of them (see errors), by which
  /// these pull it.
  Eigen::VectorXd variance;
  /// The largest |x_i - x_j| of two members, with 1.96 of its errors.
  Eigen::VectorXd largest_differences;
  /// The error of each member's variables where those of the group stand for
  /// it, k x num_members: the root of
  ///
  ///   (1 - w) C + w (C_ii + (x_i - x)^2),   w = 1 / (1 + exp((k ln n - d^2) /
  ///   2)),
  ///
  /// in which w is the probability that it is another than the rest of them,
  /// at the distance d from it, by the Bayesian information criterion [Hoeting
  /// et al., Statist. Sci. 14 (1999) 382].
  Eigen::MatrixXd errors;
};

/// Returns the spread of each group by n observations; zeros for a single
/// member.
/// O(num_members^2 p^2 k + p^3).
std::vector<MemberSpread> SpreadOfMembers(
    const MaterialGroups& groups, const MaterialParameters& parameters,
    const VariableEstimate& estimate, const Eigen::MatrixXd& noise_covariance,
    double num_observations);

/// One material for each group; none where one of all is isotropic, and nothing
/// of it given.
std::vector<Material> MaterialsOfGroups(const std::vector<Material>& materials,
                                        const MaterialGroups& groups);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_MATERIAL_FIT_MERGE_PLAN_H_
