#ifndef ELASTIMATE_CORE_MECHANICS_STIFFNESS_TRACES_H_
#define ELASTIMATE_CORE_MECHANICS_STIFFNESS_TRACES_H_

#include <Eigen/Core>
#include <vector>

#include "elastimate/core/mechanics/internal_forces.h"
#include "elastimate/core/mesh/mesh.h"
#include "elastimate/core/mesh/node_graph.h"
#include "elastimate/core/scene/degrees_of_freedom.h"
#include "elastimate/core/scene/scene.h"

namespace elastimate {

/// Returns the traces that say how displacement noise grows in the force
/// residual of any materials, whose stiffness is sum_k theta_k K_k.  They run
/// over the free degrees of freedom:
///
///   T_kl = sum over i, j of (K_k)_ij (K_l)_ij  [length^2].
///
/// For independent noise of standard deviation sigma in the free components of
/// q, E[(K_k q).(K_l q)] = (K_k q0).(K_l q0) + sigma^2 T_kl.  T depends on the
/// mesh and its supports only.  Precondition: a valid mesh.
///
/// The traces are exact, by way of the node graph.  They take about the time of
/// five element passes for each modulus: O(num_elements) time, and as much
/// memory for each modulus.
[[nodiscard]] Eigen::MatrixXd StiffnessTraces(
    const Mesh& mesh, const InternalForces& forces,
    const DegreesOfFreedom& degrees_of_freedom);

/// Returns these traces of matrices whose blocks for each pair of the graph are
/// given (InternalForces::Blocks), one for each modulus.  O(num_pairs
/// num_moduli^2).
[[nodiscard]] Eigen::MatrixXd StiffnessTraces(
    const NodeGraph& graph, const DegreesOfFreedom& degrees_of_freedom,
    std::vector<Eigen::MatrixXd> blocks);

/// Fills the columns of `probes`, of num_dofs rows, with random signs z in the
/// free rows and zeros in the held ones.  The signs are the same in every run.
void SetTraceProbes(const ComponentMask& held,
                    Eigen::Ref<Eigen::MatrixXd> probes);

/// Returns an unbiased estimate of StiffnessTraces from the products K_k z of
/// probes z, num_dofs x num_probes for each modulus: the mean of z^T K_k K_l z
/// (Hutchinson 1990).  With two probes its relative standard error is below
/// about 1 / sqrt(num_free).  O(num_nodes num_moduli^2).
[[nodiscard]] Eigen::MatrixXd EstimateStiffnessTraces(
    const DegreesOfFreedom& degrees_of_freedom,
    const std::vector<Eigen::MatrixXd>& products);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_MECHANICS_STIFFNESS_TRACES_H_
