#ifndef ELASTIMATE_CORE_ALGEBRA_EIGEN_ABI_H_
#define ELASTIMATE_CORE_ALGEBRA_EIGEN_ABI_H_

#include <Eigen/Core>

#include "elastimate/generated/build_settings.h"

// Eigen takes its memory from another function, and pads its types otherwise,
// where the instructions of the processor ask for another alignment.  Each
// installed header that has matrices in it includes this one.
static_assert(
    EIGEN_DEFAULT_ALIGN_BYTES == ELASTIMATE_EIGEN_DEFAULT_ALIGN_BYTES &&
        EIGEN_MAX_STATIC_ALIGN_BYTES == ELASTIMATE_EIGEN_MAX_STATIC_ALIGN_BYTES,
    "This source aligns Eigen's matrices otherwise than the elastimate library "
    "does, so that the program would crash where one of them frees what the "
    "other has allocated.  Compile this source without -march=native, -mavx, "
    "-mavx2 and -mavx512f (or add -mno-avx behind them), or build elastimate "
    "with the same flags (-D CMAKE_CXX_FLAGS=...).");

#endif  // ELASTIMATE_CORE_ALGEBRA_EIGEN_ABI_H_
