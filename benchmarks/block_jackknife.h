#ifndef ELASTIMATE_BENCHMARKS_BLOCK_JACKKNIFE_H_
#define ELASTIMATE_BENCHMARKS_BLOCK_JACKKNIFE_H_

#include <Eigen/Core>
#include <optional>

#include "elastimate/core/scene/scene.h"
#include "elastimate/estimators/interface/estimator.h"

namespace elastimate {

/// Standard errors of E (relative) and nu of a planar scene by a jackknife over
/// blocks: the extent of the mesh is cut into n x n rectangles, and what was
/// measured at the nodes of each is left out in turn [Kuensch, Annals of
/// Statistics 17 (1989) 1217],
///
///   s^2 = (G - 1) / G sum_g (theta_g - mean)^2 over G blocks with nodes.
///
/// It asks nothing of noise but that it is not alike beyond a block.  It says
/// too much where some blocks know more than others, as those at the ends do,
/// and does not see what all blocks share, such as the error of a load cell.
/// Empty when one of the G estimates is not usable.
std::optional<Eigen::Vector2d> BlockJackknife(const Estimator& estimator,
                                              const Scene& scene, int n);

}  // namespace elastimate

#endif  // ELASTIMATE_BENCHMARKS_BLOCK_JACKKNIFE_H_
