#ifndef ELASTIMATE_APPS_LINEAR_ALGEBRA_H_
#define ELASTIMATE_APPS_LINEAR_ALGEBRA_H_

#include <string>

namespace elastimate {

/// The BLAS that is really in use by this process: its configuration, and the
/// file that dgemm comes from.
std::string DescribeBlas();

/// Limits the threads of the BLAS, which are at most as many as fit into the
/// memory that the process may take.
void SetBlasThreads(int num_threads);

/// Has the BLAS take the memory it works with, which it would wait for forever
/// when it is not there.  Throws std::runtime_error where the process may not
/// take that much and what a small scene needs (ulimit -v).
///
/// So that its other threads, which start before the program does, find theirs,
/// this file starts the program anew, with fewer of them, where the process may
/// take too little memory for all.
void ReserveBlasMemory();

}  // namespace elastimate

#endif  // ELASTIMATE_APPS_LINEAR_ALGEBRA_H_
