#include "elastimate/estimators/material_fit/outliers.h"

#include <boost/math/distributions/chi_squared.hpp>
#include <limits>

#include "elastimate/estimators/statistics/node_losses.h"
#include "elastimate/estimators/statistics/residual_statistics.h"

namespace elastimate {
namespace {

// That of any false one in a measurement.
constexpr double kProbability = 0.05;

}  // namespace

std::vector<ObservedDisplacements::Point> FindOutliers(
    const ObservedDisplacements& observed, const Eigen::VectorXd& residual) {
  std::vector<ObservedDisplacements::Point> outliers;
  if (!HasHeavyTails(residual)) {
    return outliers;
  }
  const double deviation = RobustStandardDeviation(residual);
  const double probability =
      kProbability / static_cast<double>(observed.Points().size());
  for (const ObservedDisplacements::Point& point : observed.Points()) {
    const double limit = boost::math::quantile(boost::math::complement(
        boost::math::chi_squared(point.count), probability));
    if (residual.segment(point.first, point.count).squaredNorm() >
        limit * deviation * deviation) {
      outliers.push_back(point);
    }
  }
  return outliers;
}

void LeaveOut(const std::vector<ObservedDisplacements::Point>& points,
              Scene& scene) {
  const Eigen::Index num_nodes = scene.mesh.NumNodes();
  for (const ObservedDisplacements::Point& point : points) {
    LoadCase& load_case = scene.load_cases[point.load_case];
    if (point.index >= num_nodes) {
      load_case.points.displacement.col(point.index - num_nodes)
          .setConstant(std::numeric_limits<double>::quiet_NaN());
      continue;
    }
    if (load_case.observed.size() == 0) {
      load_case.observed.setConstant(scene.mesh.Dimension(), num_nodes, true);
    }
    load_case.observed.col(point.index).setConstant(false);
  }
}

}  // namespace elastimate
