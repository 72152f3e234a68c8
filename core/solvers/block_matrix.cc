#include "elastimate/core/solvers/block_matrix.h"

#include <algorithm>
#include <cassert>
#include <numeric>
#include <utility>

// The first part of this file is compiled once for each kind of processor, and
// the best one that the program finds is used.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "elastimate/core/solvers/block_matrix.cc"
#include <hwy/foreach_target.h>
// This header has to come after foreach_target.h.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace elastimate {
namespace HWY_NAMESPACE {
namespace {

// The products of one row of blocks with kOfX columns of X, which are `stride`
// apart.
template <bool kWithRest, int kRows, int kColumns, int kOfX>
HWY_INLINE void MultiplyRow(const BlockMatrix& a, Eigen::Index i,
                            const double* x, Eigen::Index stride,
                            double (&sums)[kOfX][kRows]) {
  std::fill_n(&sums[0][0], kOfX * kRows, 0.0);
  for (Eigen::Index k = a.start[i]; k < a.start[i + 1]; ++k) {
    const Eigen::Index first = k * kRows * kColumns;
    const double* const values = x + Eigen::Index{a.column[k]} * kColumns;
    for (int c = 0; c < kColumns; ++c) {
      for (int r = 0; r < kRows; ++r) {
        const Eigen::Index at = first + Eigen::Index{c} * kRows + r;
        double entry = a.entries[at];
        if constexpr (kWithRest) {
          entry += double{a.rest[at]};
        }
        for (int n = 0; n < kOfX; ++n) {
          sums[n][r] += entry * values[n * stride + c];
        }
      }
    }
  }
}

#if HWY_CAP_GE256 && !HWY_HAVE_SCALABLE
namespace hn = hwy::HWY_NAMESPACE;

// Does the same with vectors of four rows, of which the last ones read entries
// behind the column, or behind the block.
template <bool kWithRest, int kRows, int kColumns, int kOfX>
HWY_INLINE void MultiplyRowByVectors(const BlockMatrix& a, Eigen::Index i,
                                     const double* x, Eigen::Index stride,
                                     double (&sums)[kOfX][kRows]) {
  constexpr int kVectors = (kRows + 3) / 4;
  // One column alone would wait for each sum before it adds to it.
  constexpr int kChains = kOfX == 1 ? 3 : 1;
  const hn::FixedTag<double, 4> d;
  const hn::FixedTag<float, 4> of_entries;
  hn::Vec<decltype(d)> sum[kOfX][kVectors][kChains];
  for (int n = 0; n < kOfX; ++n) {
    for (int v = 0; v < kVectors; ++v) {
      for (int chain = 0; chain < kChains; ++chain) {
        sum[n][v][chain] = hn::Zero(d);
      }
    }
  }
  for (Eigen::Index k = a.start[i]; k < a.start[i + 1]; ++k) {
    const Eigen::Index first = k * kRows * kColumns;
    const double* const values = x + Eigen::Index{a.column[k]} * kColumns;
    for (int c = 0; c < kColumns; ++c) {
      for (int v = 0; v < kVectors; ++v) {
        const Eigen::Index at = first + c * kRows + 4 * v;
        auto entry =
            hn::PromoteTo(d, hn::LoadU(of_entries, a.entries.data() + at));
        if constexpr (kWithRest) {
          entry = hn::Add(
              entry,
              hn::PromoteTo(d, hn::LoadU(of_entries, a.rest.data() + at)));
        }
        for (int n = 0; n < kOfX; ++n) {
          auto& chain = sum[n][v][c % kChains];
          chain = hn::MulAdd(entry, hn::Set(d, values[n * stride + c]), chain);
        }
      }
    }
  }
  for (int n = 0; n < kOfX; ++n) {
    double all[4 * kVectors];
    for (int v = 0; v < kVectors; ++v) {
      auto total = sum[n][v][0];
      for (int chain = 1; chain < kChains; ++chain) {
        total = hn::Add(total, sum[n][v][chain]);
      }
      hn::StoreU(total, d, all + 4 * v);
    }
    std::copy_n(all, kRows, sums[n]);
  }
}
#endif

template <bool kWithRest, int kRows, int kColumns, int kOfX>
HWY_INLINE void MultiplyColumns(const BlockMatrix& a, Eigen::Index i,
                                const Eigen::MatrixXd& x, Eigen::Index first,
                                Eigen::MatrixXd& products) {
  double sums[kOfX][kRows];
  const double* const from = x.data() + first * x.rows();
#if HWY_CAP_GE256 && !HWY_HAVE_SCALABLE
  // Nothing may be read behind the last of all blocks.
  if (kRows >= 3 && i + 1 < a.NumBlockRows()) {
    MultiplyRowByVectors<kWithRest, kRows, kColumns, kOfX>(a, i, from, x.rows(),
                                                           sums);
  } else {
    MultiplyRow<kWithRest, kRows, kColumns, kOfX>(a, i, from, x.rows(), sums);
  }
#else
  MultiplyRow<kWithRest, kRows, kColumns, kOfX>(a, i, from, x.rows(), sums);
#endif
  for (int n = 0; n < kOfX; ++n) {
    std::copy_n(sums[n], kRows,
                products.data() + (first + n) * products.rows() + kRows * i);
  }
}

template <bool kWithRest, int kRows, int kColumns>
HWY_INLINE void MultiplyRows(const BlockMatrix& a, Eigen::Index begin,
                             Eigen::Index end, const Eigen::MatrixXd& x,
                             Eigen::MatrixXd& products) {
  // So many columns share each read of a block.
  constexpr int kAtOnce = 4;
  for (Eigen::Index i = begin; i < end; ++i) {
    Eigen::Index column = 0;
    for (; column + kAtOnce <= x.cols(); column += kAtOnce) {
      MultiplyColumns<kWithRest, kRows, kColumns, kAtOnce>(a, i, x, column,
                                                           products);
    }
    for (; column < x.cols(); ++column) {
      MultiplyColumns<kWithRest, kRows, kColumns, 1>(a, i, x, column, products);
    }
  }
}

template <bool kWithRest>
HWY_INLINE void MultiplyRowsOfAnySize(const BlockMatrix& a, Eigen::Index begin,
                                      Eigen::Index end,
                                      const Eigen::MatrixXd& x,
                                      Eigen::MatrixXd& products) {
  const std::pair size(a.block_rows, a.block_columns);
  if (size == std::pair(3, 3)) {
    MultiplyRows<kWithRest, 3, 3>(a, begin, end, x, products);
  } else if (size == std::pair(3, 6)) {
    MultiplyRows<kWithRest, 3, 6>(a, begin, end, x, products);
  } else if (size == std::pair(6, 6)) {
    MultiplyRows<kWithRest, 6, 6>(a, begin, end, x, products);
  } else if (size == std::pair(2, 2)) {
    MultiplyRows<kWithRest, 2, 2>(a, begin, end, x, products);
  } else if (size == std::pair(2, 3)) {
    MultiplyRows<kWithRest, 2, 3>(a, begin, end, x, products);
  } else {
    assert(size == std::pair(1, 1));
    MultiplyRows<kWithRest, 1, 1>(a, begin, end, x, products);
  }
}

template <int kRows, int kColumns>
HWY_INLINE void MultiplyTransposedColumns(const BlockMatrix& a,
                                          const BlocksByColumn& by_column,
                                          Eigen::Index begin, Eigen::Index end,
                                          const Eigen::MatrixXd& x,
                                          Eigen::MatrixXd& products) {
  for (Eigen::Index j = begin; j < end; ++j) {
    for (Eigen::Index n = 0; n < x.cols(); ++n) {
      double sums[kColumns] = {};
      for (Eigen::Index k = by_column.start[j]; k < by_column.start[j + 1];
           ++k) {
        const float* const entries =
            a.entries.data() +
            Eigen::Index{by_column.block[k]} * kRows * kColumns;
        const double* const values =
            x.data() + n * x.rows() + Eigen::Index{by_column.row[k]} * kRows;
        for (int c = 0; c < kColumns; ++c) {
          for (int r = 0; r < kRows; ++r) {
            sums[c] += double{entries[c * kRows + r]} * values[r];
          }
        }
      }
      std::copy_n(sums, kColumns,
                  products.data() + n * products.rows() + kColumns * j);
    }
  }
}

void MultiplyTransposedColumnsOfAnySize(const BlockMatrix& a,
                                        const BlocksByColumn& by_column,
                                        Eigen::Index begin, Eigen::Index end,
                                        const Eigen::MatrixXd& x,
                                        Eigen::MatrixXd& products) {
  const std::pair size(a.block_rows, a.block_columns);
  if (size == std::pair(3, 6)) {
    MultiplyTransposedColumns<3, 6>(a, by_column, begin, end, x, products);
  } else if (size == std::pair(6, 6)) {
    MultiplyTransposedColumns<6, 6>(a, by_column, begin, end, x, products);
  } else if (size == std::pair(2, 3)) {
    MultiplyTransposedColumns<2, 3>(a, by_column, begin, end, x, products);
  } else if (size == std::pair(3, 3)) {
    MultiplyTransposedColumns<3, 3>(a, by_column, begin, end, x, products);
  } else {
    assert(size == std::pair(1, 1));
    MultiplyTransposedColumns<1, 1>(a, by_column, begin, end, x, products);
  }
}

void MultiplyRowsOnce(const BlockMatrix& a, Eigen::Index begin,
                      Eigen::Index end, const Eigen::MatrixXd& x,
                      Eigen::MatrixXd& products) {
  MultiplyRowsOfAnySize<false>(a, begin, end, x, products);
}

void MultiplyRowsWithRest(const BlockMatrix& a, Eigen::Index begin,
                          Eigen::Index end, const Eigen::MatrixXd& x,
                          Eigen::MatrixXd& products) {
  MultiplyRowsOfAnySize<true>(a, begin, end, x, products);
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace elastimate
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace elastimate {

HWY_EXPORT(MultiplyRowsOnce);
HWY_EXPORT(MultiplyRowsWithRest);
HWY_EXPORT(MultiplyTransposedColumnsOfAnySize);

namespace {

// Calls multiply(begin, end) for ranges that cover these rows or columns of
// blocks once.
template <class Multiply>
void ForRanges(Eigen::Index size, std::size_t num_entries,
               const Multiply& multiply) {
  // To start the threads takes about as long as to multiply so many entries,
  // which are counted because coarse spaces have few but long rows.
  constexpr std::size_t kFewEntries = 200000;
  constexpr Eigen::Index kMostParts = 512;
  const Eigen::Index at_once = size / kMostParts + 1;
#pragma omp parallel for schedule(static) if (num_entries > kFewEntries)
  for (Eigen::Index begin = 0; begin < size; begin += at_once) {
    multiply(begin, std::min(size, begin + at_once));
  }
}

template <class MultiplyRows>
Eigen::MatrixXd MultiplyBy(const BlockMatrix& a, const Eigen::MatrixXd& x,
                           const MultiplyRows& multiply_rows) {
  assert(x.rows() == a.num_columns);
  Eigen::MatrixXd products(a.NumRows(), x.cols());
  ForRanges(a.NumBlockRows(), a.entries.size(),
            [&](Eigen::Index begin, Eigen::Index end) {
              multiply_rows(a, begin, end, x, products);
            });
  return products;
}

}  // namespace

Eigen::MatrixXd Multiply(const BlockMatrix& a, const Eigen::MatrixXd& x) {
  return MultiplyBy(a, x, HWY_DYNAMIC_DISPATCH(MultiplyRowsOnce));
}

Eigen::MatrixXd MultiplyAccurately(const BlockMatrix& a,
                                   const Eigen::MatrixXd& x) {
  assert(a.rest.size() == a.entries.size());
  return MultiplyBy(a, x, HWY_DYNAMIC_DISPATCH(MultiplyRowsWithRest));
}

Eigen::MatrixXd MultiplyTransposed(const BlockMatrix& a,
                                   const BlocksByColumn& by_column,
                                   const Eigen::MatrixXd& x) {
  assert(x.rows() == a.NumRows());
  Eigen::MatrixXd products(a.num_columns, x.cols());
  const auto multiply_columns =
      HWY_DYNAMIC_DISPATCH(MultiplyTransposedColumnsOfAnySize);
  ForRanges(a.num_columns / a.block_columns, a.entries.size(),
            [&](Eigen::Index begin, Eigen::Index end) {
              multiply_columns(a, by_column, begin, end, x, products);
            });
  return products;
}

BlockMatrix RowsOf(const BlockMatrix& a, Eigen::Index first, Eigen::Index end) {
  BlockMatrix result;
  result.block_rows = a.block_rows;
  result.block_columns = a.block_columns;
  result.num_columns = a.num_columns;
  for (Eigen::Index i = first; i <= end; ++i) {
    result.start.push_back(a.start[i] - a.start[first]);
  }
  const auto copy = [&](const auto& from, Eigen::Index size, auto& to) {
    to.assign(from.begin() + size * a.start[first],
              from.begin() + size * a.start[end]);
  };
  const Eigen::Index size = Eigen::Index{a.block_rows} * a.block_columns;
  copy(a.column, 1, result.column);
  copy(a.entries, size, result.entries);
  if (!a.rest.empty()) {
    copy(a.rest, size, result.rest);
  }
  return result;
}

BlocksByColumn OrderByColumn(const BlockMatrix& a) {
  BlocksByColumn result;
  result.start.assign(a.num_columns / a.block_columns + 1, 0);
  for (const int column : a.column) {
    ++result.start[column + 1];
  }
  std::partial_sum(result.start.begin(), result.start.end(),
                   result.start.begin());
  std::vector<Eigen::Index> next(result.start.begin(), result.start.end() - 1);
  result.row.resize(a.column.size());
  result.block.resize(a.column.size());
  for (Eigen::Index i = 0; i < a.NumBlockRows(); ++i) {
    for (Eigen::Index k = a.start[i]; k < a.start[i + 1]; ++k) {
      const Eigen::Index to = next[a.column[k]]++;
      result.row[to] = static_cast<int>(i);
      result.block[to] = static_cast<int>(k);
    }
  }
  return result;
}

Eigen::MatrixXd DiagonalBlocks(const BlockMatrix& a) {
  const int d = a.block_rows;
  Eigen::MatrixXd blocks = Eigen::MatrixXd::Zero(d, a.NumRows());
  for (Eigen::Index i = 0; i < a.NumBlockRows(); ++i) {
    for (Eigen::Index k = a.start[i]; k < a.start[i + 1]; ++k) {
      if (a.column[k] == i) {
        blocks.middleCols(d * i, d) =
            Eigen::MatrixXf::Map(a.entries.data() + k * d * d, d, d)
                .cast<double>();
      }
    }
  }
  return blocks;
}

}  // namespace elastimate

#endif  // HWY_ONCE
