#ifndef ELASTIMATE_APPS_LINEAR_ALGEBRA_H_
#define ELASTIMATE_APPS_LINEAR_ALGEBRA_H_

#include <cstddef>
#include <functional>
#include <string>

namespace elastimate {

/// Describes the BLAS that this process really uses: its configuration, and the
/// file from which dgemm comes.
std::string DescribeBlas();

/// Starts the program anew with kernels of the BLAS that this processor has,
/// where OpenBLAS does not know the processor, as it is newer, and has taken
/// those of 2004, with which a factorisation takes half as long again. OpenBLAS
/// chooses when it is loaded.  OPENBLAS_CORETYPE in the environment has the
/// last word.  The new start also has OpenMP's threads wait without work,
/// unless OMP_WAIT_POLICY says otherwise.
void UseBlasKernelsOfProcessor(char** argv);

/// Sets the threads of OpenMP and those of the BLAS; of the latter, at most as
/// many as fit into the memory that the process may take.
void SetThreads(int num_threads);

/// Divides 0 .. count - 1 into as many blocks as there are threads
/// (SetThreads), and calls work(begin, end) for all at the same time; linear
/// algebra then uses one thread in each.  After all have ended, it rethrows the
/// exception of the first block that threw.
void ForBlocks(
    std::size_t count,
    const std::function<void(std::size_t begin, std::size_t end)>& work);

/// Has the BLAS take the memory with which it works, for which it would wait
/// forever when it is not there.  Throws std::runtime_error where the process
/// may not take this much and what a small scene needs (ulimit -v).
///
/// The other threads of the BLAS start before the program does.  So that they
/// find their memory, this file starts the program anew, with fewer threads,
/// where the process may take too little memory for all.
void ReserveBlasMemory();

}  // namespace elastimate

#endif  // ELASTIMATE_APPS_LINEAR_ALGEBRA_H_
