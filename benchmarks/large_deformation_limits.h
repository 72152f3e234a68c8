#ifndef ELASTIMATE_BENCHMARKS_LARGE_DEFORMATION_LIMITS_H_
#define ELASTIMATE_BENCHMARKS_LARGE_DEFORMATION_LIMITS_H_

#include "benchmarks/table.h"

namespace elastimate {

/// Returns what the search for equilibrium says about loads below and beyond
/// limits that are known from theory: the buckling of a column, and blocks that
/// are pressed until their law gives way or until nothing is left of them.
Table LargeDeformationLimits();

}  // namespace elastimate

#endif  // ELASTIMATE_BENCHMARKS_LARGE_DEFORMATION_LIMITS_H_
