#ifndef ELASTIMATE_CORE_MATERIALS_STIFFNESS_FACTORS_H_
#define ELASTIMATE_CORE_MATERIALS_STIFFNESS_FACTORS_H_

#include <Eigen/Core>
#include <vector>

#include "elastimate/core/materials/law.h"

namespace elastimate {

/// The moduli of any positive definite stiffness, by the factors
///
///   S = L D L^T,   x = (ln D_a of S(a, a), L_ba of S(a, b)),
///
/// of its blocks, L with ones on the diagonal: the stiffness is positive
/// definite by construction, and the unit of pressure changes ln D only.
/// x is in the order of the entries, one for each modulus.
Eigen::VectorXd ModuliOfFactors(const std::vector<BlockEntry>& entries,
                                const Eigen::VectorXd& factors);

/// d theta / d x, num_moduli x num_moduli.
Eigen::MatrixXd ModuliOfFactorsJacobian(const std::vector<BlockEntry>& entries,
                                        const Eigen::VectorXd& factors);

/// Whether the stiffness of a law at these parameters is positive definite, as
/// that of an isotropic one in its range is.
bool IsStiffnessPositiveDefinite(const Law& law,
                                 const Eigen::VectorXd& parameters,
                                 SectionModel model);

/// x of theta; not numbers where the stiffness is not positive definite.
Eigen::VectorXd FactorsOfModuli(const std::vector<BlockEntry>& entries,
                                const Eigen::VectorXd& moduli);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_MATERIALS_STIFFNESS_FACTORS_H_
