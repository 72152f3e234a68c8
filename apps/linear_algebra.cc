#include "apps/linear_algebra.h"

#include <dlfcn.h>
#include <omp.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <future>
#include <stdexcept>
#include <string>
#include <vector>

// cblas.h of OpenBLAS declares these functions; other BLAS have a cblas.h
// without them.
extern "C" {
char* openblas_get_config();
int openblas_get_num_threads();
void openblas_set_num_threads(int num_threads);
void dgemm_(const char* transpose_a, const char* transpose_b, const int* m,
            const int* n, const int* k, const double* alpha, const double* a,
            const int* lda, const double* b, const int* ldb, const double* beta,
            double* c, const int* ldc);
}

namespace elastimate {
namespace {

/// OpenBLAS 0.3 takes at most this much of the address space for each thread.
constexpr rlim_t kBlasMemory = rlim_t{1} << 27;

/// A small scene takes this much beside it.  Not all libraries can bear to get
/// less.
constexpr rlim_t kSmallSceneMemory = rlim_t{1} << 25;

/// Returns RLIM_INFINITY where there is no limit (ulimit -v).
rlim_t AddressSpace() {
  rlimit limit{};
  getrlimit(RLIMIT_AS, &limit);
  return limit.rlim_cur;
}

/// Returns how many threads take a quarter of the memory that the process may
/// take, one at least.
int LargestNumThreads() {
  const rlim_t memory = AddressSpace();
  return memory == RLIM_INFINITY
             ? CPU_SETSIZE
             : static_cast<int>(std::clamp<rlim_t>(memory / (4 * kBlasMemory),
                                                   1, CPU_SETSIZE));
}

int NumProcessors() {
  cpu_set_t processors;
  CPU_ZERO(&processors);
  sched_getaffinity(0, sizeof processors, &processors);
  return CPU_COUNT(&processors);
}

/// Limits a number of threads in the environment, which is `otherwise` where it
/// is not there, to the largest number that may be.  Returns true when that
/// changes it.
bool LimitThreads(const std::string& name, int otherwise,
                  std::vector<std::string>& variables) {
  const std::string begin = name + "=";
  const auto old = std::find_if(
      variables.begin(), variables.end(),
      [&](const std::string& text) { return text.rfind(begin, 0) == 0; });
  const int given =
      old == variables.end() ? 0 : std::atoi(old->c_str() + begin.size());
  const int largest = LargestNumThreads();
  if ((given > 0 ? given : otherwise) <= largest) {
    return false;
  }
  if (old != variables.end()) {
    variables.erase(old);
  }
  variables.push_back(begin + std::to_string(largest));
  return true;
}

/// Starts the program anew with fewer threads where they need more memory than
/// there may be.  This runs ahead of all libraries: OpenBLAS starts its threads
/// when it is loaded, and each tries forever to get its memory.
[[maybe_unused]] void FitThreadsToMemory(int /*argc*/, char** argv,
                                         char** environment) {
  if (AddressSpace() == RLIM_INFINITY) {
    return;
  }
  std::vector<std::string> variables;
  for (char** variable = environment; *variable != nullptr; ++variable) {
    variables.emplace_back(*variable);
  }
  const bool blas_changes =
      LimitThreads("OPENBLAS_NUM_THREADS", NumProcessors(), variables);
  // CHOLMOD takes four, whatever OMP_NUM_THREADS says.
  const bool others_change =
      LimitThreads("OMP_THREAD_LIMIT", CPU_SETSIZE, variables);
  if (blas_changes || others_change) {
    std::vector<char*> pointers;
    for (std::string& variable : variables) {
      pointers.push_back(variable.data());
    }
    pointers.push_back(nullptr);
    // Where it cannot be started anew, it goes on with all threads.
    execve("/proc/self/exe", argv, pointers.data());
  }
}

#ifndef __SANITIZE_ADDRESS__  // It does not work with little memory.
[[gnu::section(".preinit_array"),
  gnu::used]] void (*const before_libraries)(int, char**,
                                             char**) = FitThreadsToMemory;
#endif

}  // namespace

std::string DescribeBlas() {
  // CHOLMOD's calls are bound to the first dgemm_ in the scope of the program,
  // whatever library was meant at link time.
  void* symbol = dlsym(RTLD_DEFAULT, "dgemm_");
  Dl_info info{};
  const bool found = symbol != nullptr && dladdr(symbol, &info) != 0 &&
                     info.dli_fname != nullptr;
  const std::string file = found ? info.dli_fname : "unknown";
  const bool is_openblas = file.find("openblas") != std::string::npos;
  return (is_openblas ? openblas_get_config() : std::string("not OpenBLAS")) +
         " (" + file + ")";
}

void UseBlasKernelsOfProcessor(char** argv) {
  constexpr const char* kVariable = "OPENBLAS_CORETYPE";
  const bool is_unknown = DescribeBlas().find("Prescott") != std::string::npos;
  if (!is_unknown || std::getenv(kVariable) != nullptr ||
      !__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("fma")) {
    return;
  }
  const bool has_avx512 =
      __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
      __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl");
  setenv(kVariable, has_avx512 ? "SkylakeX" : "Haswell", 1);
  // A thread that waits busily takes the processor of the one that it waits
  // for where other programs run.
  setenv("OMP_WAIT_POLICY", "passive", 0);
  // Where it cannot be started anew, it goes on with those kernels.
  execv("/proc/self/exe", argv);
}

void SetThreads(int num_threads) {
  omp_set_num_threads(num_threads);
  openblas_set_num_threads(std::min(num_threads, LargestNumThreads()));
}

void ForBlocks(
    std::size_t count,
    const std::function<void(std::size_t begin, std::size_t end)>& work) {
  const std::size_t num_blocks =
      std::min(count, static_cast<std::size_t>(std::min(omp_get_max_threads(),
                                                        LargestNumThreads())));
  if (num_blocks < 2) {
    return work(0, count);
  }
  const int num_blas_threads = openblas_get_num_threads();
  openblas_set_num_threads(1);
  std::vector<std::future<void>> blocks;
  for (std::size_t i = 0; i < num_blocks; ++i) {
    blocks.push_back(
        std::async(std::launch::async, [&work, count, num_blocks, i] {
          omp_set_num_threads(1);  // This sets the number of this thread only.
          work(count * i / num_blocks, count * (i + 1) / num_blocks);
        }));
  }
  for (const std::future<void>& block : blocks) {
    block.wait();
  }
  openblas_set_num_threads(num_blas_threads);
  for (std::future<void>& block : blocks) {
    block.get();
  }
}

void ReserveBlasMemory() {
  if (AddressSpace() == RLIM_INFINITY) {
    return;
  }
  constexpr rlim_t kNeeded = kBlasMemory + kSmallSceneMemory;
  void* const memory = mmap(nullptr, kNeeded, PROT_READ | PROT_WRITE,
                            MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (memory == MAP_FAILED) {
    throw std::runtime_error(
        "there is too little memory: even a small scene takes " +
        std::to_string(kNeeded >> 20) +
        " MiB of the address space beside the program, whose limit is " +
        std::to_string(AddressSpace() >> 20) + " MiB; raise it (ulimit -v)");
  }
  munmap(memory, kNeeded);
  // OpenBLAS keeps the memory that it has taken once.
  const int size = 64;
  const double one = 1;
  const std::vector<double> a(size * size, 0.0);
  std::vector<double> c(size * size, 0.0);
  dgemm_("N", "N", &size, &size, &size, &one, a.data(), &size, a.data(), &size,
         &one, c.data(), &size);
}

}  // namespace elastimate
