#ifndef ELASTIMATE_CORE_SOLVERS_NESTED_DISSECTION_H_
#define ELASTIMATE_CORE_SOLVERS_NESTED_DISSECTION_H_

#include <cstdint>
#include <vector>

namespace elastimate {

/// Returns an order of the rows of a sparse symmetric matrix in which its
/// Cholesky factor has few entries: O(n^(4/3)) of the graph of a solid mesh,
/// O(n log n) of that of a planar one.  By METIS.  The lower triangle has the
/// rows row[start[j]], ..., row[start[j + 1] - 1] in column j, ascending.
/// Threads take turns, and each finds the same order.
/// Throws std::bad_alloc.
std::vector<std::int64_t> NestedDissection(
    const std::vector<std::int64_t>& start,
    const std::vector<std::int64_t>& row);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_SOLVERS_NESTED_DISSECTION_H_
