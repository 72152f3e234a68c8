#ifndef ELASTIMATE_CORE_MECHANICS_STIFFNESS_TRACES_H_
#define ELASTIMATE_CORE_MECHANICS_STIFFNESS_TRACES_H_

#include <Eigen/Core>
#include <vector>

#include "elastimate/core/mechanics/internal_forces.h"
#include "elastimate/core/mesh/mesh.h"
#include "elastimate/core/scene/degrees_of_freedom.h"
#include "elastimate/core/scene/scene.h"

namespace elastimate {

/// How displacement noise grows in the force residual of any materials, whose
/// stiffness is sum_k theta_k K_k: the traces over the free degrees of freedom
///
///   T_kl = sum over i, j of (K_k)_ij (K_l)_ij  [length^2].
///
/// For independent noise of standard deviation sigma in the free components of
/// q, E[(K_k q).(K_l q)] = (K_k q0).(K_l q0) + sigma^2 T_kl.  T depends on the
/// mesh and its supports only.  Precondition: a valid mesh.
///
/// Exact, through the node graph: about the time of five element passes for
/// each modulus.  O(num_elements) time, and as much memory for each modulus.
[[nodiscard]] Eigen::MatrixXd StiffnessTraces(
    const Mesh& mesh, const InternalForces& forces,
    const DegreesOfFreedom& degrees_of_freedom);

/// Makes `probes`, of num_dofs rows, columns of random signs z in the free
/// rows, zero in the held ones.  Deterministic.
void SetTraceProbes(const ComponentMask& held,
                    Eigen::Ref<Eigen::MatrixXd> probes);

/// An unbiased estimate of StiffnessTraces from the products K_k z of probes z,
/// num_dofs x num_probes for each modulus: the mean of z^T K_k K_l z
/// (Hutchinson 1990), with two of them of relative standard error below about 1
/// / sqrt(num_free).  O(num_nodes num_moduli^2).
[[nodiscard]] Eigen::MatrixXd EstimateStiffnessTraces(
    const DegreesOfFreedom& degrees_of_freedom,
    const std::vector<Eigen::MatrixXd>& products);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_MECHANICS_STIFFNESS_TRACES_H_
