#ifndef ELASTIMATE_ESTIMATORS_MAPS_ESTIMATE_MAP_H_
#define ELASTIMATE_ESTIMATORS_MAPS_ESTIMATE_MAP_H_

#include "elastimate/core/scene/scene.h"
#include "elastimate/estimators/interface/estimator.h"
#include "elastimate/estimators/interface/map_estimate.h"

namespace elastimate {

/// Estimates Young's modulus of every element, and one Poisson's ratio, of an
/// isotropic body from its loads and measured displacements.  There is nothing
/// to choose:
///
/// 1. a homogeneous body is fitted (FitLevels);
/// 2. a smooth field, whose length (of two), size and noise maximise the
///    evidence (FitSmoothMap), with the resolution of each element
///    (ResolutionLengths) and, if it is the verdict, the error (DescribeMap);
/// 3. the field is sharpened (SharpenMap), divided into two or three regions,
///    and these are fitted (FitRegions);
/// 4. the one of the greatest evidence is the verdict; a body is homogeneous
///    unless ln B of another one is at least 3.
///
/// Nodes, points, resultants, supports that moved by unknown amounts, free
/// rigid motions and several load cases count as in a fit of few parameters.
/// Displacements of Origin::kMeasured are fitted with quadratic elements,
/// because what linear ones miss would look like structure.  Errors then
/// include what quadratic ones may miss (MapMeshError), and a body whose
/// structure explains no more than that is homogeneous.  Of `options`, a known
/// Poisson's ratio and the solver count.  Materials of the scene do not.
///
///   const MapEstimate map = EstimateMap(scene, {});
///   if (map.IsUsable() && map.verdict == MapVerdict::kRegions) {
///     std::cout << map.regions[1].youngs_modulus;
///   }
///
/// Where the best map differs from the measurement by more than the given
/// noise, the noise is found as if it had not been given, and a finding says
/// so.
///
/// Preconditions are those of Estimator::Run; the supports hold the specimen.
/// Numerical outcomes are statuses.  The same input gives the same bits.  Cost:
/// about 50 factorisations, and a few times gamma solves (see the functions
/// above), many at once.
[[nodiscard]] MapEstimate EstimateMap(const Scene& scene,
                                      const EstimatorOptions& options);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_MAPS_ESTIMATE_MAP_H_
