#ifndef ELASTIMATE_APPS_LINEAR_ALGEBRA_H_
#define ELASTIMATE_APPS_LINEAR_ALGEBRA_H_

#include <string>

namespace elastimate {

/// The BLAS that is really in use by this process: its configuration, and the
/// file that dgemm comes from.
std::string DescribeBlas();

/// Limits the threads of the BLAS.
void SetBlasThreads(int num_threads);

}  // namespace elastimate

#endif  // ELASTIMATE_APPS_LINEAR_ALGEBRA_H_
