#ifndef ELASTIMATE_IO_DIC_POINT_GAPS_H_
#define ELASTIMATE_IO_DIC_POINT_GAPS_H_

#include <Eigen/Core>
#include <vector>

#include "elastimate/core/algebra/eigen_abi.h"

namespace elastimate {

/// A gap of more than two places between the measured points of a grid.
struct PointGap {
  Eigen::Index num_places;
  Eigen::Vector2d center;  ///< [length]
  bool is_filled;          ///< With nodes that were not measured.
};

/// Gaps between measured points, where either the camera lost points or the
/// specimen ends.
struct PointGaps {
  std::vector<bool> is_filled;  ///< By gap; an empty list fills none.
  std::vector<PointGap> found;  ///< The largest first.
};

}  // namespace elastimate

#endif  // ELASTIMATE_IO_DIC_POINT_GAPS_H_
