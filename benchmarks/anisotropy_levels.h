#ifndef ELASTIMATE_BENCHMARKS_ANISOTROPY_LEVELS_H_
#define ELASTIMATE_BENCHMARKS_ANISOTROPY_LEVELS_H_

#include <vector>

#include "benchmarks/material_levels.h"

namespace elastimate {

/// A bar of 1 x 1 x 2 of 3 x 3 x 5 hexahedra, held at z = 0 and loaded at the
/// other end, transversely isotropic (E_T = 10 000, E_L three times as large,
/// unless the level says otherwise) with an axis at 35 degrees to its length:
/// fitted by its law, by an isotropic one, by nine moduli and by 21, about axes
/// that are wrong, and under more load cases.
std::vector<MaterialLevel> AnisotropyLevels();

}  // namespace elastimate

#endif  // ELASTIMATE_BENCHMARKS_ANISOTROPY_LEVELS_H_
