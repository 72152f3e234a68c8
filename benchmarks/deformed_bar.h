#ifndef ELASTIMATE_BENCHMARKS_DEFORMED_BAR_H_
#define ELASTIMATE_BENCHMARKS_DEFORMED_BAR_H_

#include <Eigen/Core>
#include <string>

#include "elastimate/core/scene/scene.h"

namespace elastimate {

/// What a force on the end of a bar does to it.
enum class BarLoad {
  kBending,  ///< The force is across, and its size is the end's turn [degrees].
  kStretch,  ///< The force is along, and its size is the elongation [%].
};

/// "bending" or "stretch".
std::string BarLoadName(BarLoad load);

/// E [pressure] and nu of the bar.
inline const Eigen::Vector2d kBarParameters(1e4, 0.3);

/// Returns a bar of 1 x 1 x 6, of 2 x 2 x 6 cells of five quadratic tetrahedra,
/// clamped at z = 0, of a law of large strains with the parameters above.  Its
/// load case has the dead force that deforms it by `size`, and the displacement
/// without noise.  Throws std::runtime_error where no equilibrium is found.
Scene DeformedBar(BarLoad load, const std::string& law, double size);

/// Returns the covariance of (E / E_true, nu) that no unbiased estimator from
/// the displacement of all free nodes is below, for noise of standard deviation
/// one [1 / length^2].
Eigen::Matrix2d UnitCramerRao(const Scene& bar);

}  // namespace elastimate

#endif  // ELASTIMATE_BENCHMARKS_DEFORMED_BAR_H_
