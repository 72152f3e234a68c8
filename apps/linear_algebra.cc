#include "apps/linear_algebra.h"

#include <dlfcn.h>

// What cblas.h of OpenBLAS declares; other BLAS have a cblas.h without it.
extern "C" {
char* openblas_get_config();
void openblas_set_num_threads(int num_threads);
}

namespace elastimate {

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

void SetBlasThreads(int num_threads) { openblas_set_num_threads(num_threads); }

}  // namespace elastimate
