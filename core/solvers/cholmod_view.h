#ifndef ELASTIMATE_CORE_SOLVERS_CHOLMOD_VIEW_H_
#define ELASTIMATE_CORE_SOLVERS_CHOLMOD_VIEW_H_

#include <cholmod.h>

#include <cstddef>
#include <cstdint>
#include <new>
#include <vector>

namespace elastimate {

static_assert(sizeof(SuiteSparse_long) == sizeof(std::int64_t));

/// A view of arrays of the caller as a symmetric matrix of which the lower
/// triangle is stored, or of its pattern where there are no values; CHOLMOD
/// does not write to it.
inline cholmod_sparse SymmetricView(
    const std::vector<std::int64_t>& column_start,
    const std::vector<std::int64_t>& row, const double* values) {
  cholmod_sparse view{};
  view.nrow = view.ncol = column_start.size() - 1;
  view.nzmax = row.size();
  view.p = const_cast<std::int64_t*>(column_start.data());
  view.i = const_cast<std::int64_t*>(row.data());
  view.x = const_cast<double*>(values);
  view.stype = -1;
  view.itype = CHOLMOD_LONG;
  view.xtype = values == nullptr ? CHOLMOD_PATTERN : CHOLMOD_REAL;
  view.dtype = CHOLMOD_DOUBLE;
  view.sorted = 1;
  view.packed = 1;
  return view;
}

/// Throws std::bad_alloc where the last call has found too little memory.
inline void ThrowIfOutOfMemory(const cholmod_common& common) {
  if (common.status == CHOLMOD_OUT_OF_MEMORY ||
      common.status == CHOLMOD_TOO_LARGE) {
    throw std::bad_alloc();
  }
}

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_SOLVERS_CHOLMOD_VIEW_H_
