#ifndef ELASTIMATE_CORE_LARGE_STRAIN_HOMOGENEOUS_DEFORMATION_H_
#define ELASTIMATE_CORE_LARGE_STRAIN_HOMOGENEOUS_DEFORMATION_H_

#include <Eigen/Core>
#include <optional>
#include <string_view>
#include <vector>

#include "elastimate/core/laws/law.h"

namespace elastimate {

/// The tests of a material in which its deformation is the same everywhere.
/// F has the given stretch x, and free stretches a, b across which there is no
/// traction.
enum class DeformationMode {
  kUniaxial,     ///< F = diag(x, a, b).
  kEquibiaxial,  ///< F = diag(x, x, a).
  kPureShear,    ///< F = diag(x, 1, a), a wide strip that is pulled.
  kSimpleShear,  ///< F = I + (x - 1) e1 e2^T.
  kVolumetric,   ///< F = diag(x, x, x).
};

inline constexpr DeformationMode kAllDeformationModes[] = {
    DeformationMode::kUniaxial, DeformationMode::kEquibiaxial,
    DeformationMode::kPureShear, DeformationMode::kSimpleShear,
    DeformationMode::kVolumetric};

/// Returns "uniaxial", "equibiaxial", "pure_shear", "simple_shear" or
/// "volumetric".
[[nodiscard]] std::string_view DeformationModeName(DeformationMode mode);

/// A homogeneous deformation of a block.
struct HomogeneousState {
  Eigen::Matrix3d gradient;  ///< H = F - I.
  /// The force per undeformed area that does the stretching: P_11, or P_12 of
  /// simple shear [pressure].
  double stress;
};

/// Returns the state of a material with these moduli at each stretch, none
/// where no stable one was found.  The law takes three dimensions; one of small
/// strains has H = F - I as its gradient.  States are followed from rest in
/// steps of at most 2 %, of a few Newton iterations each.
[[nodiscard]] std::vector<std::optional<HomogeneousState>> DeformHomogeneously(
    const Law& law, const Eigen::VectorXd& moduli, DeformationMode mode,
    const std::vector<double>& stretches);

/// Changes the diagonal entries of these axes of H until no traction is across
/// them, P_ii = 0, by Newton's method from the given ones.  Returns false where
/// none is found that is stable.
[[nodiscard]] bool ReleaseAxes(const Law& law, const Eigen::VectorXd& moduli,
                               const std::vector<int>& axes,
                               Eigen::Matrix3d& gradient);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_LARGE_STRAIN_HOMOGENEOUS_DEFORMATION_H_
