#include "elastimate/estimators/material_fit/outliers.h"

#include <array>
#include <boost/math/distributions/chi_squared.hpp>
#include <cstddef>
#include <limits>

#include "elastimate/estimators/statistics/node_losses.h"
#include "elastimate/estimators/statistics/residual_statistics.h"

namespace elastimate {
namespace {

// That of any false one in a measurement.
constexpr double kProbability = 0.05;
// Of a residual over the measurement, whose norm is 1: that of exact data.
constexpr double kExactData = 1e-9;

}  // namespace

std::vector<Outlier> FindOutliers(const Scene& scene,
                                  const ObservedDisplacements& observed,
                                  const Eigen::MatrixXd& displacement) {
  const Eigen::VectorXd residual =
      observed.Restrict(displacement) - observed.Measured();
  std::vector<Outlier> outliers;
  if (residual.norm() < kExactData || !HasHeavyTails(residual)) {
    return outliers;
  }
  const double deviation = RobustStandardDeviation(residual);
  const double probability =
      kProbability / static_cast<double>(observed.Points().size());
  std::array<double, 3> limits = {};
  for (std::size_t i = 0; i < limits.size(); ++i) {
    limits[i] = boost::math::quantile(boost::math::complement(
        boost::math::chi_squared(double(i + 1)), probability));
  }
  for (const ObservedDisplacements::Point& point : observed.Points()) {
    if (residual.segment(point.first, point.count).squaredNorm() >
        limits[point.count - 1] * deviation * deviation) {
      const Eigen::Index number = point.index - scene.mesh.NumNodes();
      outliers.push_back(
          {point.load_case, number < 0 ? point.index : number, number >= 0});
    }
  }
  return outliers;
}

Scene WithoutOutliers(const Scene& scene,
                      const std::vector<Outlier>& outliers) {
  Scene others = scene;
  for (const Outlier& outlier : outliers) {
    LoadCase& load_case = others.load_cases[outlier.load_case];
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
  return others;
}

}  // namespace elastimate
