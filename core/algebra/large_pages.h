#ifndef ELASTIMATE_CORE_ALGEBRA_LARGE_PAGES_H_
#define ELASTIMATE_CORE_ALGEBRA_LARGE_PAGES_H_

#ifdef __linux__
#include <sys/mman.h>
#endif

#include <Eigen/Core>
#include <cstdint>

namespace elastimate {

/// Resizes `matrix`, without setting its values, and asks the operating system
/// to map new memory in large pages: to map it in small ones takes longer than
/// the element pass that fills it.  A mere resize where the system has no large
/// pages, and nothing for a matrix of the right shape.
inline void ResizeInLargePages(Eigen::Index num_rows, Eigen::Index num_columns,
                               Eigen::MatrixXd& matrix) {
  if (matrix.rows() == num_rows && matrix.cols() == num_columns) {
    return;
  }
  matrix.resize(num_rows, num_columns);
#ifdef MADV_HUGEPAGE
  constexpr std::uintptr_t kPageSize = std::uintptr_t{1} << 21;
  auto* const data = reinterpret_cast<char*>(matrix.data());
  const auto begin = reinterpret_cast<std::uintptr_t>(data);
  const auto end = begin + sizeof(double) * std::uintptr_t(matrix.size());
  const std::uintptr_t first_page = (begin + kPageSize - 1) / kPageSize;
  const std::uintptr_t end_page = end / kPageSize;
  if (first_page < end_page) {
    // Advice: where the system does not take it, nothing is lost.
    madvise(data + (first_page * kPageSize - begin),
            (end_page - first_page) * kPageSize, MADV_HUGEPAGE);
  }
#endif
}

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_ALGEBRA_LARGE_PAGES_H_
