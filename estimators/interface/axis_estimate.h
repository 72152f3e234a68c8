#ifndef ELASTIMATE_ESTIMATORS_INTERFACE_AXIS_ESTIMATE_H_
#define ELASTIMATE_ESTIMATORS_INTERFACE_AXIS_ESTIMATE_H_

#include <cstddef>
#include <vector>

#include "elastimate/core/materials/material_parameters.h"
#include "elastimate/core/scene/scene.h"
#include "elastimate/estimators/interface/estimate.h"

namespace elastimate {

/// In which people read angles.
inline constexpr double kDegreesOfRadian = 57.295779513082323;

/// Whether a material has an axis that is to be found (FreeAxisLaw).
bool HasFreeAxis(const std::vector<Material>& materials);

/// Where the parameters of a material are whose axis is to be found.
struct FreeAxisPlace {
  Eigen::Index first;
  Eigen::Index count;
};
std::vector<FreeAxisPlace> FreeAxisParameters(const MaterialParameters& all);

/// Whether an axis that is to be found is so far from itself in two sets of
/// parameters that it is another one: three of the largest errors that an axis
/// may have.
bool AreAxesApart(const MaterialParameters& all, const Eigen::VectorXd& a,
                  const Eigen::VectorXd& b);

/// The axis of each material whose axis is a parameter, from the parameters of
/// the estimate and their covariance C: the error of its direction is the
/// square root of the largest eigenvalue of J C J^T, J = d axis / d p.
/// How far its material is from isotropy is a^T (K C K^T)^-1 a, K = d a / d p,
/// of the a of FreeAxisLaw::Anisotropy: under noise, an isotropic material has
/// a minimum at some axis, next to which the error may be small.  Where
/// either is beyond its limit (Limits), there is no direction.  Empty without
/// parameters.
std::vector<AxisEstimate> AxesOf(const Scene& scene, const Estimate& estimate);

/// The axis that a parameter is a rotation of; null for others.
const AxisEstimate* AxisOfParameter(const Estimate& estimate,
                                    std::size_t place);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_INTERFACE_AXIS_ESTIMATE_H_
