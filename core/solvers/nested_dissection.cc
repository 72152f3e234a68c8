#include "elastimate/core/solvers/nested_dissection.h"

#include <cassert>
#include <mutex>

#include "elastimate/core/solvers/cholmod_view.h"

namespace elastimate {

std::vector<std::int64_t> NestedDissection(
    const std::vector<std::int64_t>& start,
    const std::vector<std::int64_t>& row) {
  const std::size_t size = start.size() - 1;
  cholmod_common common;
  cholmod_l_start(&common);
  common.print = 0;
  cholmod_sparse pattern = SymmetricView(start, row, nullptr);
  std::vector<SuiteSparse_long> order(size);
  {
    // METIS seeds and draws from rand(), whose state threads share: at once,
    // two would have other orders, and results that differ by rounding.
    static std::mutex one_at_a_time;
    const std::lock_guard<std::mutex> lock(one_at_a_time);
    static_cast<void>(
        cholmod_l_metis(&pattern, nullptr, 0, 1, order.data(), &common));
  }
  cholmod_l_finish(&common);
  ThrowIfOutOfMemory(common);
  assert(common.status == CHOLMOD_OK);
  return {order.begin(), order.end()};
}

}  // namespace elastimate
