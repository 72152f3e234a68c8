#ifndef ELASTIMATE_CORE_SOLVERS_FREE_MEMORY_H_
#define ELASTIMATE_CORE_SOLVERS_FREE_MEMORY_H_

#include <cstdlib>

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace elastimate {

/// Returns freed memory to the system; does nothing without glibc.  The set-up
/// of multigrid leaves so many holes in the heap that the process would keep a
/// third more than it uses.
inline void ReturnFreeMemory() {
#ifdef __GLIBC__
  malloc_trim(0);
#endif
}

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_SOLVERS_FREE_MEMORY_H_
