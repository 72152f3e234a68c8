#include "elastimate/core/mesh/nearest_points.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <set>

#include "tests/core/random_values.h"

namespace elastimate {
namespace {

using Pair = std::array<Eigen::Index, 2>;

// By sorting all distances.
std::set<Pair> PairsBySorting(const Eigen::MatrixXd& x, int count) {
  std::set<Pair> pairs;
  for (Eigen::Index i = 0; i < x.cols(); ++i) {
    std::vector<Eigen::Index> others(x.cols());
    std::iota(others.begin(), others.end(), 0);
    const auto distance = [&](Eigen::Index k) {
      return (x.col(k) - x.col(i)).norm();
    };
    std::sort(others.begin(), others.end(),
              [&](Eigen::Index a, Eigen::Index b) {
                return distance(a) < distance(b);
              });
    for (int k = 1; k <= std::min<int>(count, int(x.cols()) - 1); ++k) {
      pairs.insert({std::min(i, others[k]), std::max(i, others[k])});
    }
  }
  return pairs;
}

TEST(NearestPairs, AreThoseOfSortedDistances) {
  for (const int dimension : {2, 3}) {
    for (const int n : {0, 1, 2, 5, 200}) {
      const Eigen::MatrixXd x = testing::RandomMatrix(dimension, n, n + 1);
      const std::vector<Pair> pairs = NearestPairs(x, 4);
      const std::set<Pair> expected = PairsBySorting(x, 4);
      EXPECT_EQ(std::set<Pair>(pairs.begin(), pairs.end()), expected) << n;
      EXPECT_EQ(pairs.size(), expected.size());
    }
  }
}

}  // namespace
}  // namespace elastimate
