#ifndef ELASTIMATE_CORE_MATERIALS_STIFFNESS_FACTORS_H_
#define ELASTIMATE_CORE_MATERIALS_STIFFNESS_FACTORS_H_

#include <Eigen/Core>
#include <vector>

#include "elastimate/core/laws/law.h"

namespace elastimate {

/// Returns the moduli of any positive definite stiffness from the factors
///
///   S = L D L^T,   x = (ln D_a of S(a, a), L_ba of S(a, b)),
///
/// of its blocks, where L has ones on the diagonal.  The stiffness is positive
/// definite by construction, and the unit of pressure changes ln D only.  x is
/// in the order of the entries, one for each modulus.
Eigen::VectorXd ModuliOfFactors(const std::vector<BlockEntry>& entries,
                                const Eigen::VectorXd& factors);

/// d theta / d x, num_moduli x num_moduli.
Eigen::MatrixXd ModuliOfFactorsJacobian(const std::vector<BlockEntry>& entries,
                                        const Eigen::VectorXd& factors);

/// Tells whether the stiffness of a law at these parameters is positive
/// definite.  An isotropic one is so in the range of its parameters.
bool IsStiffnessPositiveDefinite(const Law& law,
                                 const Eigen::VectorXd& parameters,
                                 SectionModel model);

/// Returns S of theta, and theta of S.
Eigen::MatrixXd BlocksOfModuli(const std::vector<BlockEntry>& entries,
                               const Eigen::VectorXd& moduli);
Eigen::VectorXd ModuliOfBlocks(const std::vector<BlockEntry>& entries,
                               const Eigen::MatrixXd& blocks);

/// Returns x of theta, or NaN where the stiffness is not positive definite.
Eigen::VectorXd FactorsOfModuli(const std::vector<BlockEntry>& entries,
                                const Eigen::VectorXd& moduli);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_MATERIALS_STIFFNESS_FACTORS_H_
