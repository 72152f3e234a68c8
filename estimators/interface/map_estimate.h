#ifndef ELASTIMATE_ESTIMATORS_INTERFACE_MAP_ESTIMATE_H_
#define ELASTIMATE_ESTIMATORS_INTERFACE_MAP_ESTIMATE_H_

#include <Eigen/Core>
#include <optional>
#include <string_view>
#include <vector>

#include "elastimate/core/algebra/eigen_abi.h"
#include "elastimate/core/scene/camera.h"
#include "elastimate/core/solvers/stiffness_solver.h"
#include "elastimate/estimators/interface/finding.h"

namespace elastimate {

/// What the measurement says about how a modulus is distributed in a body.
enum class MapVerdict {
  kHomogeneous,  ///< It is the same everywhere, as far as the data tell.
  kRegions,      ///< It is constant in each of two or three regions.
  kField,        ///< It varies smoothly.
  /// Each element has a modulus of its own: there is nothing that says how
  /// these belong together (EstimateLocalMap).
  kElements,
};

/// "homogeneous", "regions", "field" or "elements".
[[nodiscard]] std::string_view MapVerdictName(MapVerdict verdict);

/// A region of one modulus.
struct MapRegion {
  double youngs_modulus;  ///< [pressure]
  double standard_error;  ///< Of E [pressure].
  double volume;          ///< [length^3]
  /// The diameter of a disc or a ball as large as its largest connected part
  /// [length].
  double diameter;
  /// Whether it is at least three resolution lengths wide.  What surrounds
  /// another one has its part in its modulus.
  bool is_resolved;
};

/// A map of Young's modulus: a value for each element, with its error and with
/// the length that the data resolve there.
struct MapEstimate {
  /// Starts out as a failure, so that it cannot be mistaken for a result.
  Status status = Status::kNumericalFailure;
  std::vector<Finding> findings;
  MapVerdict verdict = MapVerdict::kHomogeneous;
  /// ln of the evidence of a smooth field and of regions, over that of a
  /// homogeneous body, as if the elements missed nothing.  Both below 3 mean
  /// that the body is homogeneous.  Not numbers for MapVerdict::kElements,
  /// which has no standard errors, resolution lengths and regions either.
  double field_log_evidence = 0;
  double region_log_evidence = 0;
  /// gamma: how many parameters of the field the data support beside its level.
  double supported_parameters = 0;
  /// By the verdict, num_elements values [pressure].
  Eigen::VectorXd youngs_modulus;
  Eigen::VectorXd youngs_modulus_standard_error;
  /// The size of what the data resolve around each element [length], at most
  /// that of the body.
  Eigen::VectorXd resolution_length;
  /// The regions in the order of their moduli; one where the body is
  /// homogeneous, none where it is a field.
  std::vector<MapRegion> regions;
  /// The elements that the boundary between two regions cuts, with one modulus,
  /// where they have one between those of both.
  std::optional<MapRegion> boundary;
  /// From 0 on, and -1 for elements of the boundary; empty for a field.
  std::vector<int> region_of_element;
  /// The geometric mean of E over the volume [pressure].
  double mean_youngs_modulus = 0;
  double poisson_ratio = 0;
  /// The covariance of the mean of E and of nu.  The row and the column of nu
  /// are zero if it is known.
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
  /// The part of the covariance that comes from what the elements may miss;
  /// zero where nothing is missed, or nothing known of that.
  Eigen::Matrix2d mesh_covariance = Eigen::Matrix2d::Zero();
  /// The standard deviation of the noise of a component, given or found
  /// [length].
  double noise_sd = 0;
  /// |measured - model| / |measured| of the observed displacements.
  double displacement_residual = 0;
  /// The displacement of a scene of unknown motion
  /// (Estimate::fitted_displacement); empty for other scenes.
  Eigen::MatrixXd fitted_displacement;
  std::vector<Camera> cameras;  ///< Those that see it (Estimate::cameras).
  /// Whether loads or resultants tell the unit of E.  Displacements alone tell
  /// its ratios: the map is then for a homogeneous start of E = 1.
  bool is_scale_known = true;
  int element_order = 1;  ///< Of the elements of the fit.
  Work work;

  bool IsUsable() const { return status == Status::kOk; }
};

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_INTERFACE_MAP_ESTIMATE_H_
