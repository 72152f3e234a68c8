#ifndef ELASTIMATE_IO_REPORT_SCENE_RESULTS_H_
#define ELASTIMATE_IO_REPORT_SCENE_RESULTS_H_

#include <Eigen/Core>
#include <vector>

#include "elastimate/io/vtk/vtu_writer.h"

namespace elastimate {

/// What an estimate makes of its scene.
struct SceneResults {
  /// At the nodes and elements of the scene, for each load case k > 1 with the
  /// suffix `_k`.
  Fields fields;
  /// For each load case, measured minus fitted displacement at its points:
  /// dimension x num_points [length], NaN where a component was not measured.
  /// Empty without a fit.
  std::vector<Eigen::MatrixXd> point_residuals;
};

}  // namespace elastimate

#endif  // ELASTIMATE_IO_REPORT_SCENE_RESULTS_H_
