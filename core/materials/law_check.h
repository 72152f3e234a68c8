#ifndef ELASTIMATE_CORE_MATERIALS_LAW_CHECK_H_
#define ELASTIMATE_CORE_MATERIALS_LAW_CHECK_H_

#include <string>
#include <vector>

#include "elastimate/core/laws/law.h"

namespace elastimate {

/// Tests what the library relies on of a law, in each section that it takes,
/// and returns a sentence for each thing that is wrong; none for a right law.
///
/// At the typical parameters, and at others within 20 % of these:
///
///   P_k = dW_k / dH, and dP / dH = Tangent, against central differences;
///   P(2 H) = 2 P(H) for small strains; for large ones P(Q F) = Q P(F), and a
///   symmetric tangent at H;
///   the tangent is symmetric, positive definite on strains H = H^T, and zero
///   on rotations H = -H^T, and stress and energy are zero for H = 0;
///   d theta / d p = ModuliJacobian, against central differences;
///   ParametersOf(Moduli(p)) = p;
///   k times larger stiffnesses p make theta k times larger.
///
/// Beside that it tests the shapes of all results, the names, ranges and
/// typical values of the parameters, and that BlockEntries, if there are any,
/// are one for each modulus and positive definite at these parameters.
///
/// Deviations are relative to the largest entry of what is tested: 1e-6 of a
/// derivative, which central differences know to about 1e-9, and 1e-9 of
/// others.  Where a result has the wrong shape, what depends on it is not
/// tested.  Takes about a millisecond.
[[nodiscard]] std::vector<std::string> CheckLaw(const Law& law);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_MATERIALS_LAW_CHECK_H_
