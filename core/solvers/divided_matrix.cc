#include "elastimate/core/solvers/divided_matrix.h"

#include <algorithm>

namespace elastimate {

std::vector<int> NumberOwnColumnsFirst(Eigen::Index first_own,
                                       Eigen::Index num_own,
                                       BlockMatrix& rows) {
  const auto is_own = [&](int column) {
    return column >= first_own && column < first_own + num_own;
  };
  std::vector<int> others;
  for (const int column : rows.column) {
    if (!is_own(column)) {
      others.push_back(column);
    }
  }
  std::sort(others.begin(), others.end());
  others.erase(std::unique(others.begin(), others.end()), others.end());
  for (int& column : rows.column) {
    column = is_own(column)
                 ? int(column - first_own)
                 : int(num_own +
                       (std::lower_bound(others.begin(), others.end(), column) -
                        others.begin()));
  }
  rows.num_columns =
      rows.block_columns * (num_own + Eigen::Index(others.size()));
  return others;
}

void MakeHalo(Eigen::Index first_own, Eigen::Index num_own, const Ranks& ranks,
              DividedMatrix& a) {
  const std::vector<int> others =
      NumberOwnColumnsFirst(first_own, num_own, a.rows);
  a.halo = ranks.MakeHalo(num_own, others, a.rows.block_columns);
}

Eigen::MatrixXd Multiply(const DividedMatrix& a, const Eigen::MatrixXd& x) {
  return a.halo ? Multiply(a.rows, a.halo->WithOthers(x)) : Multiply(a.rows, x);
}

Eigen::MatrixXd MultiplyTransposed(const DividedMatrix& a,
                                   const BlocksByColumn& by_column,
                                   const Eigen::MatrixXd& x) {
  return a.halo ? a.halo->Added(MultiplyTransposed(a.rows, by_column, x))
                : MultiplyTransposed(a.rows, by_column, x);
}

Eigen::MatrixXd MultiplyAccurately(const DividedMatrix& a,
                                   const Eigen::MatrixXd& x) {
  return a.halo ? MultiplyAccurately(a.rows, a.halo->WithOthers(x))
                : MultiplyAccurately(a.rows, x);
}

}  // namespace elastimate
