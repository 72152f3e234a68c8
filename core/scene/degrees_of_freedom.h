#ifndef ELASTIMATE_CORE_SCENE_DEGREES_OF_FREEDOM_H_
#define ELASTIMATE_CORE_SCENE_DEGREES_OF_FREEDOM_H_

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "elastimate/core/scene/scene.h"

namespace elastimate {

/// The free degrees of freedom in ascending order.  Row i of a vector over the
/// free ones is row `free[i]` of a vector over all, whose rows are dimension *
/// node + component.
struct DegreesOfFreedom {
  int dimension;  ///< The components of a node: 2 or 3.
  std::vector<Eigen::Index> free;
  /// The place in `free` of each of the dimension * num_nodes degrees of
  /// freedom, or -1 when it is held.
  std::vector<Eigen::Index> place;

  explicit DegreesOfFreedom(const Supports& supports);

  Eigen::Index NumFree() const { return Eigen::Index(free.size()); }
  Eigen::Index NumAll() const { return Eigen::Index(place.size()); }

  /// Returns the free rows of `all` (num_all x n): num_free x n.
  Eigen::MatrixXd Restrict(const Eigen::MatrixXd& all) const;
  /// Returns `values` (num_free x n) in the free rows and zeros in the held:
  /// num_all x n.
  Eigen::MatrixXd Extend(const Eigen::MatrixXd& values) const;
};

/// Returns the displacement of the held degrees of freedom, zero in the free
/// rows: dimension * num_nodes values.
[[nodiscard]] Eigen::VectorXd HeldDisplacement(const Supports& supports);

/// The load cases by the degrees of freedom that they hold, which decide
/// whether they can share the factor of a stiffness.
struct HeldGroups {
  std::vector<std::size_t> of_case;       ///< The group of each load case.
  std::vector<Eigen::Index> first_cases;  ///< The first of each group.
};
[[nodiscard]] HeldGroups GroupByHeld(const Scene& scene);

/// Keeps the values (num_dofs x num_load_cases) in the rows that each load case
/// holds, and sets the others to zero.
[[nodiscard]] Eigen::MatrixXd OfHeld(const Scene& scene,
                                     const Eigen::MatrixXd& values);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_SCENE_DEGREES_OF_FREEDOM_H_
