#ifndef ELASTIMATE_CORE_LARGE_STRAIN_CROSS_GRADIENT_H_
#define ELASTIMATE_CORE_LARGE_STRAIN_CROSS_GRADIENT_H_

#include <Eigen/Core>

#include "elastimate/core/large_strain/large_strain_law.h"

namespace elastimate {

/// Sets H_33 at the first `count` points of a plate so that no traction is
/// across it, P_33 = 0, by Newton's method, and H_13, H_23, H_31 and H_32 to
/// zero.  H_33 is NaN where none is found.  About three passes of stresses and
/// tangents.
void SetCrossGradients(const LargeStrainLaw& law, const Eigen::VectorXd& moduli,
                       int count, PointMatrices& gradients);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_LARGE_STRAIN_CROSS_GRADIENT_H_
