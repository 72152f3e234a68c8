#ifndef ELASTIMATE_ESTIMATORS_MATERIAL_FIT_REFINED_FIT_H_
#define ELASTIMATE_ESTIMATORS_MATERIAL_FIT_REFINED_FIT_H_

#include <Eigen/Core>
#include <optional>

#include "elastimate/core/scene/scene.h"
#include "elastimate/estimators/interface/estimator.h"
#include "elastimate/estimators/material_fit/space_fit.h"

namespace elastimate {

/// Whether errors contain the curvature of the misfit.
enum class MisfitCurvature { kConsidered, kIgnored };

/// The fit of a measured scene, whose specimen is no assembly of its elements.
/// The parameters are fitted with finer and finer elements, each fit started at
/// the last one:
///
/// 1. the elements of the mesh, where these are linear;
/// 2. quadratic elements of the same mesh;
/// 3. quadratic elements of the mesh divided once (8 children of each
///    tetrahedron or hexahedron, 4 of each triangle or quadrilateral).
///
/// The finest fit is reported, corrected by a part of the last change, of which
/// a part is the mesh error (MeshErrorOf).  Outliers are those of the second
/// fit (LeaveOutliersOut).
///
/// EstimatorOptions::refinement says where it ends.  By default it stops at the
/// second fit where noise has a larger part in the error of each parameter than
/// the mesh, and where the divided mesh would have more elements than are
/// solved for here.  Half of what is notable (Limits) is then part of the error
/// at least, since some changes are small by accident.
///
/// Where a support ends within quadratic elements (Supports::in_doubt), the
/// second and third fit are made with all of the nodes in doubt held and with
/// all of them free.  The estimate is the mean, and half of the difference an
/// error.  If the mesh is not divided, free nodes explain more and the step is
/// short, one solution and a linear step find the minimum with held nodes
/// (SpaceFit::ChangeByHolding).  A second fit would double time and memory.
///
/// The estimate is refused with FindingCode::kComputedByLinearElements where
/// linear elements explain the measurement so much better than quadratic ones
/// that they must have computed it.  At large strains, where a wrong law may
/// have the same effect, the difference of both is an error instead.  Where
/// motions are unknown or bounds are given, nothing tells.
///
/// The curvature of the misfit bends intervals and adds to errors.  At large
/// strains, to look at it takes more factorisations than the fit, which a fit
/// that is only compared with others can do without.
///
/// Preconditions are those of Estimator::Run; the supports hold the specimen.
MaterialFit FitRefined(
    const Scene& scene, const EstimatorOptions& options, Descent descent,
    const std::optional<Eigen::VectorXd>& start,
    MisfitCurvature curvature = MisfitCurvature::kConsidered);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_MATERIAL_FIT_REFINED_FIT_H_
