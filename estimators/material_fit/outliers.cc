#include "elastimate/estimators/material_fit/outliers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "elastimate/core/algebra/node_sums.h"
#include "elastimate/core/mesh/node_graph.h"
#include "elastimate/core/scene/unknown_motion.h"
#include "elastimate/estimators/interface/statistics.h"
#include "elastimate/estimators/statistics/node_losses.h"
#include "elastimate/estimators/statistics/residual_statistics.h"

namespace elastimate {
namespace {

// The probability of any false outlier in a measurement.
constexpr double kProbability = 0.05;
// Exact data leave no more of a measurement of norm 1 than this.
constexpr double kExactData = 1e-9;

Outlier OutlierAt(const Scene& scene,
                  const ObservedDisplacements::Point& point) {
  const Eigen::Index number = point.index - scene.mesh.NumNodes();
  return {point.load_case, number < 0 ? point.index : number, number >= 0};
}

// Whether so many of the pairs of neighbours being outliers is more than
// chance.
bool AreMoreThanChance(std::size_t num_of_outliers, std::size_t num_pairs,
                       std::size_t num_outliers, std::size_t num_points) {
  constexpr double kSignificance = 1e-3;
  const auto m = static_cast<double>(num_outliers);
  const auto n = static_cast<double>(num_points);
  const double expected =
      static_cast<double>(num_pairs) * m * (m - 1) / (n * (n - 1));
  return expected > 0 &&
         PoissonProbability(expected, static_cast<double>(num_of_outliers)) <
             kSignificance;
}

}  // namespace

OutlierSearch::OutlierSearch(const Scene& scene,
                             const ObservedDisplacements& observed,
                             const Eigen::MatrixXd& displacement) {
  const Eigen::VectorXd residual =
      observed.Restrict(displacement) - observed.Measured();
  if (Norm(residual) < kExactData || !HasHeavyTails(residual)) {
    return;
  }
  const double deviation = RobustStandardDeviation(residual);
  const double probability =
      kProbability / static_cast<double>(observed.Points().size());
  std::array<double, 3> limits = {};
  for (std::size_t i = 0; i < limits.size(); ++i) {
    limits[i] =
        deviation * std::sqrt(ChiSquaredQuantile(double(i + 1), probability));
  }
  for (const ObservedDisplacements::Point& point : observed.Points()) {
    const double distance = residual.segment(point.first, point.count).norm();
    if (distance > limits[point.count - 1]) {
      outliers_.push_back(OutlierAt(scene, point));
      distances_.push_back(distance / limits[point.count - 1]);
    }
  }
}

std::vector<Outlier> OutlierSearch::Beyond(double distance) const {
  std::vector<Outlier> beyond;
  for (std::size_t i = 0; i < outliers_.size(); ++i) {
    if (distances_[i] > distance) {
      beyond.push_back(outliers_[i]);
    }
  }
  return beyond;
}

std::vector<Outlier> SuspectedSupports(const Scene& scene,
                                       const std::vector<Outlier>& outliers) {
  std::vector<Outlier> suspects;
  for (std::size_t k = 0; k < scene.load_cases.size(); ++k) {
    const ComponentMask measured =
        AsMeasured(SupportsOf(scene, Eigen::Index(k)));
    if (measured.size() == 0) {
      continue;
    }
    std::vector<char> is_outlier(scene.mesh.NumNodes(), 0);
    for (const Outlier& outlier : outliers) {
      if (!outlier.is_point && outlier.load_case == Eigen::Index(k)) {
        is_outlier[outlier.index] = 1;
      }
    }
    std::vector<char> is_near(scene.mesh.NumNodes(), 0);
    for (const auto& element : scene.mesh.elements.colwise()) {
      if (std::any_of(element.begin(), element.end(),
                      [&](int node) { return is_outlier[node] != 0; })) {
        for (const int node : element) {
          is_near[node] = 1;
        }
      }
    }
    for (Eigen::Index node = 0; node < scene.mesh.NumNodes(); ++node) {
      if (is_near[node] != 0 && measured.col(node).any() &&
          IsObserved(scene.load_cases[k], 0, node)) {
        suspects.push_back({Eigen::Index(k), node, false});
      }
    }
  }
  return suspects;
}

std::vector<Outlier> OutliersApart(const Scene& scene,
                                   const ObservedDisplacements& observed,
                                   const std::vector<Outlier>& outliers) {
  if (outliers.size() < 2) {
    return outliers;
  }
  const std::vector<ObservedDisplacements::Point>& points = observed.Points();
  std::vector<char> is_outlier(points.size(), 0);
  auto next = outliers.begin();
  for (std::size_t i = 0; i < points.size() && next != outliers.end(); ++i) {
    if (*next == OutlierAt(scene, points[i])) {
      is_outlier[i] = 1;
      ++next;
    }
  }
  std::size_t num_pairs = 0;
  std::size_t num_of_outliers = 0;
  std::vector<char> has_neighbour(points.size(), 0);
  VisitNeighbours(NodeGraph(scene.mesh), observed,
                  [&](Eigen::Index a, Eigen::Index b) {
                    ++num_pairs;
                    if (is_outlier[a] != 0 && is_outlier[b] != 0) {
                      ++num_of_outliers;
                      has_neighbour[a] = has_neighbour[b] = 1;
                    }
                  });
  if (num_of_outliers == 0 ||
      !AreMoreThanChance(num_of_outliers, num_pairs, outliers.size(),
                         points.size())) {
    return outliers;
  }
  std::vector<Outlier> apart;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (is_outlier[i] != 0 && has_neighbour[i] == 0) {
      apart.push_back(OutlierAt(scene, points[i]));
    }
  }
  return apart;
}

void LeaveOut(const std::vector<Outlier>& outliers, Scene& scene) {
  for (const Outlier& outlier : outliers) {
    LoadCase& load_case = scene.load_cases[outlier.load_case];
    if (outlier.is_point) {
      load_case.points.displacement.col(outlier.index)
          .setConstant(std::numeric_limits<double>::quiet_NaN());
      continue;
    }
    if (load_case.observed.size() == 0) {
      load_case.observed.setConstant(scene.mesh.Dimension(),
                                     scene.mesh.NumNodes(), true);
    }
    load_case.observed.col(outlier.index).setConstant(false);
  }
}

Scene WithoutOutliers(const Scene& scene,
                      const std::vector<Outlier>& outliers) {
  Scene others = scene;
  LeaveOut(outliers, others);
  return others;
}

}  // namespace elastimate
