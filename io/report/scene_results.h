#ifndef ELASTIMATE_IO_REPORT_SCENE_RESULTS_H_
#define ELASTIMATE_IO_REPORT_SCENE_RESULTS_H_

#include <Eigen/Core>
#include <vector>

#include "elastimate/core/scene/scene.h"
#include "elastimate/core/solvers/stiffness_solver.h"
#include "elastimate/estimators/interface/estimate.h"
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

/// Returns the scene with what the estimate makes of it, for each load case (k
/// > 1 with suffix `_k`).  `modelled` is the scene that was estimated: `scene`,
/// or one with finer elements (QuadraticScene, FinerScene), whose values are
/// shown at the nodes of `scene`, and over its elements as means.  Supports of
/// unknown motion are where the fit found them.  Displacements are those of the
/// finest elements of the fit (Estimate::mesh_divisions) at its parameters, as
/// they were before the correction for what the elements miss.
///
/// With a physical E and nu and a specimen that is held, the fields are:
/// `fitted_displacement`, as the camera sees it that the fit found, if there is
/// one (Estimate::cameras); `displacement_residual` (measured minus fitted
/// where observed, else zero); where finer elements than those of `scene` were
/// fitted, `mesh_error` (their displacement minus that of the elements of
/// `scene`, at the same parameters and supports); `outlier` (1 at nodes whose
/// measurement was left out, where there are some); `reaction_force` at the
/// held degrees of freedom; and per cell the `strain_energy_density` of the
/// fitted displacement.  The reactions of a QuadraticScene have half of the
/// reaction at each mid-edge node added at either end of its edge, which keeps
/// resultant and moment (MiddleNodes).
///
/// When nothing holds the specimen, these are `force_residual` and
/// `strain_energy_density` of the measured displacement, with linear elements.
/// Otherwise the scene alone is returned.
SceneResults ResultsOf(const Scene& scene, const Scene& modelled,
                       const Estimate& estimate, SolverKind solver);

}  // namespace elastimate

#endif  // ELASTIMATE_IO_REPORT_SCENE_RESULTS_H_
