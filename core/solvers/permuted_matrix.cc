#include "elastimate/core/solvers/permuted_matrix.h"

#include <algorithm>
#include <numeric>

namespace elastimate {

PermutedMatrix::PermutedMatrix(const SymmetricPattern& a,
                               const std::int64_t* order)
    : source_(a.row.size()) {
  std::vector<std::int64_t>& start = pattern_.column_start;
  start.assign(a.column_start.size(), 0);
  pattern_.row.resize(a.row.size());
  std::vector<std::int64_t> place(a.Size());
  for (std::int64_t i = 0; i < a.Size(); ++i) {
    place[order[i]] = i;
  }
  const auto for_values = [&](const auto& work) {
    for (std::int64_t j = 0; j < a.Size(); ++j) {
      for (std::int64_t k = a.column_start[j]; k < a.column_start[j + 1]; ++k) {
        const auto [column, row] = std::minmax(place[j], place[a.row[k]]);
        work(column, row, k);
      }
    }
  };
  for_values([&](std::int64_t column, auto, auto) { ++start[column + 1]; });
  std::partial_sum(start.begin(), start.end(), start.begin());
  std::vector<std::int64_t> next = start;
  for_values([&](std::int64_t column, std::int64_t row, std::int64_t k) {
    const std::int64_t to = next[column]++;
    pattern_.row[to] = row;
    source_[to] = k;
  });
}

const Eigen::VectorXd& PermutedMatrix::ValuesFrom(
    const Eigen::VectorXd& values) {
  values_ = values(source_);
  return values_;
}

}  // namespace elastimate
