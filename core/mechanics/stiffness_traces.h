#ifndef ELASTIMATE_CORE_MECHANICS_STIFFNESS_TRACES_H_
#define ELASTIMATE_CORE_MECHANICS_STIFFNESS_TRACES_H_

#include <Eigen/Core>

#include "elastimate/core/mesh/mesh.h"
#include "elastimate/core/scene/degrees_of_freedom.h"
#include "elastimate/core/scene/scene.h"

namespace elastimate {

/// How displacement noise grows in the force residual: the traces
/// t_XY = sum over the free degrees of freedom i, j of X_ij Y_ij,
///
///   T = [t_HH t_HJ; t_HJ t_JJ]  [length^2].
///
/// For independent noise of standard deviation sigma in the free components of
/// q, E ||H q||^2 = ||H q0||^2 + sigma^2 t_HH, and so on.  T depends on the
/// mesh and its supports only.  Precondition: a valid mesh.
///
/// Exact, through the node graph: about the time of ten element passes.
/// O(num_elements) time and memory.
[[nodiscard]] Eigen::Matrix2d StiffnessTraces(
    const Mesh& mesh, const DegreesOfFreedom& degrees_of_freedom);

/// Makes `probes`, of num_dofs rows, columns of random signs z in the free
/// rows, zero in the held ones.  Deterministic.
void SetTraceProbes(const ComponentMask& held,
                    Eigen::Ref<Eigen::MatrixXd> probes);

/// An unbiased estimate of StiffnessTraces from the products H z and J z of
/// probes: the mean of z^T X Y z (Hutchinson 1990), with two of them of
/// relative standard error below about 1 / sqrt(num_free).  O(num_nodes).
[[nodiscard]] Eigen::Matrix2d EstimateStiffnessTraces(
    const ComponentMask& held, const Eigen::Ref<const Eigen::MatrixXd>& h,
    const Eigen::Ref<const Eigen::MatrixXd>& j);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_MECHANICS_STIFFNESS_TRACES_H_
