#include "elastimate/core/mesh/nearest_points.h"

#include <algorithm>
#include <cmath>
#include <nanoflann.hpp>

namespace elastimate {
namespace {

using Tree = nanoflann::KDTreeEigenMatrixAdaptor<Eigen::MatrixXd, -1,
                                                 nanoflann::metric_L2, false>;

}  // namespace

std::vector<std::array<Eigen::Index, 2>> NearestPairs(
    const Eigen::MatrixXd& positions, int count) {
  std::vector<std::array<Eigen::Index, 2>> pairs;
  const Eigen::Index n = positions.cols();
  if (n < 2) {
    return pairs;
  }
  const Tree tree(positions.rows(), std::cref(positions));
  // A point is the nearest to itself.
  const Eigen::Index wanted = std::min<Eigen::Index>(count + 1, n);
  std::vector<Eigen::Index> nearest(wanted);
  std::vector<double> squared_distances(wanted);
  for (Eigen::Index i = 0; i < n; ++i) {
    tree.query(positions.col(i).data(), wanted, nearest.data(),
               squared_distances.data());
    for (const Eigen::Index other : nearest) {
      if (other != i) {
        pairs.push_back({std::min(i, other), std::max(i, other)});
      }
    }
  }
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  return pairs;
}

std::vector<NearestPoint> NearestPoints(const Eigen::MatrixXd& positions,
                                        const Eigen::MatrixXd& others) {
  const Tree tree(positions.rows(), std::cref(positions));
  std::vector<NearestPoint> nearest;
  for (const auto& other : others.colwise()) {
    NearestPoint found = {0, 0};
    double squared_distance = 0;
    const Eigen::VectorXd position = other;
    tree.query(position.data(), 1, &found.index, &squared_distance);
    found.distance = std::sqrt(squared_distance);
    nearest.push_back(found);
  }
  return nearest;
}

}  // namespace elastimate
