#include "elastimate/estimators/statistics/correlated_noise.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include "elastimate/core/algebra/dense_algebra.h"
#include "elastimate/core/algebra/node_sums.h"
#include "elastimate/core/mesh/bounding_box.h"
#include "elastimate/core/mesh/mesh_points.h"
#include "elastimate/core/mesh/nearest_points.h"
#include "elastimate/estimators/interface/limits.h"

namespace elastimate {
namespace {

constexpr Eigen::Index kMostPoints = 20000;

// Rows of one component of one load case, by the place along the longest axis
// of the mesh.
struct RowsOfComponent {
  std::vector<Eigen::Index> rows;
  Eigen::MatrixXd positions;  // dimension x rows.size()
  Eigen::Index axis = 0;
  /// Points for each that is looked at.
  double points_per_row = 1;
};

Eigen::VectorXd PositionOf(const Scene& scene,
                           const ObservedDisplacements::Point& point,
                           const Eigen::MatrixXd& of_points) {
  const Eigen::Index num_nodes = scene.mesh.NumNodes();
  return point.index < num_nodes ? scene.mesh.nodes.col(point.index)
                                 : of_points.col(point.index - num_nodes);
}

void SortByPosition(const Mesh& mesh, RowsOfComponent& rows) {
  Eigen::Index axis = 0;
  (mesh.nodes.rowwise().maxCoeff() - mesh.nodes.rowwise().minCoeff())
      .maxCoeff(&axis);
  std::vector<Eigen::Index> order(rows.rows.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](Eigen::Index a, Eigen::Index b) {
    return rows.positions(axis, a) < rows.positions(axis, b);
  });
  rows.axis = axis;
  rows.positions = rows.positions(Eigen::all, order).eval();
  std::vector<Eigen::Index> sorted;
  sorted.reserve(order.size());
  for (const Eigen::Index i : order) {
    sorted.push_back(rows.rows[i]);
  }
  rows.rows = std::move(sorted);
}

std::vector<RowsOfComponent> SplitRows(const Scene& scene,
                                       const ObservedDisplacements& observed) {
  const int dimension = scene.mesh.Dimension();
  std::vector<RowsOfComponent> all(observed.NumLoadCases() * dimension);
  for (Eigen::Index k = 0; k < observed.NumLoadCases(); ++k) {
    const MeshPoints& points = scene.load_cases[k].points.points;
    const Eigen::MatrixXd of_points =
        points.Size() == 0 ? Eigen::MatrixXd(dimension, 0)
                           : Interpolate(scene.mesh, points, scene.mesh.nodes);
    Eigen::Index num_points = 0;
    for (const auto& point : observed.Points()) {
      num_points += point.load_case == k ? 1 : 0;
    }
    const Eigen::Index stride = 1 + (num_points - 1) / kMostPoints;
    std::vector<std::vector<Eigen::VectorXd>> positions(dimension);
    Eigen::Index number = 0;
    for (const auto& point : observed.Points()) {
      if (point.load_case != k || number++ % stride != 0) {
        continue;
      }
      for (int i = 0; i < point.count; ++i) {
        const int component = observed.Component(point.first + i);
        all[dimension * k + component].rows.push_back(point.first + i);
        positions[component].push_back(PositionOf(scene, point, of_points));
      }
    }
    for (int i = 0; i < dimension; ++i) {
      RowsOfComponent& rows = all[dimension * k + i];
      rows.points_per_row = static_cast<double>(stride);
      rows.positions.resize(dimension, Eigen::Index(positions[i].size()));
      for (std::size_t j = 0; j < positions[i].size(); ++j) {
        rows.positions.col(Eigen::Index(j)) = positions[i][j];
      }
      SortByPosition(scene.mesh, rows);
    }
  }
  return all;
}

// The median distance of a point to its nearest neighbour.
double SpacingOf(const std::vector<RowsOfComponent>& all) {
  std::vector<double> nearest;
  for (const RowsOfComponent& rows : all) {
    std::vector<double> distance(rows.rows.size(),
                                 std::numeric_limits<double>::infinity());
    for (const auto& [a, b] : NearestPairs(rows.positions, 1)) {
      const double d = (rows.positions.col(a) - rows.positions.col(b)).norm();
      distance[a] = std::min(distance[a], d);
      distance[b] = std::min(distance[b], d);
    }
    nearest.insert(nearest.end(), distance.begin(), distance.end());
  }
  const auto median = nearest.begin() + std::ptrdiff_t(nearest.size() / 2);
  std::nth_element(nearest.begin(), median, nearest.end());
  return *median;
}

// Visits the pairs whose distance is less than `reach`.
template <class Visit>
void VisitPairs(const RowsOfComponent& rows, double reach, const Visit& visit) {
  const Eigen::Index n = rows.positions.cols();
  const auto along = rows.positions.row(rows.axis);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = i + 1; j < n && along(j) - along(i) < reach; ++j) {
      const double distance =
          (rows.positions.col(i) - rows.positions.col(j)).norm();
      if (distance < reach) {
        visit(rows.rows[i], rows.rows[j], distance);
      }
    }
  }
}

Eigen::MatrixXd PositivePart(const Eigen::MatrixXd& symmetric) {
  const SymmetricEigenDecomposition parts = DecomposeSymmetric(symmetric);
  return parts.vectors * parts.values.cwiseMax(0).asDiagonal() *
         parts.vectors.transpose();
}

// How far residuals of which some are alike over this length are those of a
// model that is wrong rather than of noise: wholly from an eighth of the
// specimen on, as a wave of its size is alike, and quickly less below.
double ShareOfModel(const Mesh& mesh, double length) {
  return std::min(1.0, std::pow(8 * length / DiagonalOf(mesh.nodes), 4));
}

// Over pairs of rows by steps of their distance.
struct PairSums {
  Eigen::VectorXd products;
  Eigen::VectorXd square_distances;
  Eigen::VectorXd counts;
};

PairSums SumPairs(const std::vector<RowsOfComponent>& all,
                  const Eigen::VectorXd& residual, double step,
                  Eigen::Index num_steps) {
  PairSums sums = {Eigen::VectorXd::Zero(num_steps),
                   Eigen::VectorXd::Zero(num_steps),
                   Eigen::VectorXd::Zero(num_steps)};
  for (const RowsOfComponent& rows : all) {
    const double reach = static_cast<double>(num_steps) * step;
    VisitPairs(rows, reach,
               [&](Eigen::Index a, Eigen::Index b, double distance) {
                 const auto k = std::min(
                     static_cast<Eigen::Index>(distance / step), num_steps - 1);
                 sums.products(k) += residual(a) * residual(b);
                 sums.square_distances(k) += distance * distance;
                 sums.counts(k) += 1;
               });
  }
  return sums;
}

// Returns rho up to where it is first not significant.
Eigen::VectorXd SignificantValues(const PairSums& sums, double variance) {
  const Eigen::VectorXd values =
      sums.products.cwiseQuotient(variance * sums.counts);
  Eigen::Index last = 0;
  while (last < values.size() && sums.counts(last) > 0 &&
         values(last) >=
             kLimits.explained_score / std::sqrt(sums.counts(last))) {
    ++last;
  }
  return values.head(last);
}

// Finds rho = share exp(-d^2 / 2 X^2) from two squares of distances.
void FillSmoothed(double first, double next, const Eigen::Vector2d& squares,
                  Autocorrelation& correlation) {
  if (next >= first) {
    correlation.share = correlation.values(0);
    correlation.smoothed_length = std::numeric_limits<double>::infinity();
    return;
  }
  const double double_square =
      (squares(1) - squares(0)) / std::log(first / next);
  correlation.share = std::clamp(first * std::exp(squares(0) / double_square),
                                 correlation.values(0), 1.0);
  correlation.smoothed_length = std::sqrt(M_PI * double_square) / 2;
}

}  // namespace

Autocorrelation CorrelateResiduals(const Scene& scene,
                                   const ObservedDisplacements& observed,
                                   const Eigen::VectorXd& residual) {
  const std::vector<RowsOfComponent> all = SplitRows(scene, observed);
  Autocorrelation correlation;
  correlation.step = SpacingOf(all);
  if (!(correlation.step > 0) || !std::isfinite(correlation.step) ||
      residual.isZero(0)) {
    return {};
  }
  // Neighbours are a little nearer or farther than a step.
  correlation.step *= 1.5;
  const Eigen::Index num_steps =
      1 + static_cast<Eigen::Index>(DiagonalOf(scene.mesh.nodes) /
                                    correlation.step);
  const double variance =
      SquaredNorm(residual) / static_cast<double>(residual.size());
  // Most residuals are independent, or alike over a few steps; far pairs are
  // looked at where it takes them.
  PairSums sums;
  Eigen::VectorXd values;
  for (Eigen::Index reach = 2;; reach *= 4) {
    const Eigen::Index steps = std::min(reach, num_steps);
    sums = SumPairs(all, residual, correlation.step, steps);
    values = SignificantValues(sums, variance);
    if (values.size() < steps || steps == num_steps) {
      break;
    }
  }
  const Eigen::VectorXd& counts = sums.counts;
  correlation.values = values.cwiseMin(1.0);
  if (values.size() > 0 && num_steps > 1 && counts(1) > 0) {
    const double next =
        std::max(sums.products(1) / (counts(1) * variance), 0.0) +
        kTwoSidedErrors / std::sqrt(counts(1));
    FillSmoothed(values(0), next,
                 sums.square_distances.head(2).cwiseQuotient(counts.head(2)),
                 correlation);
  }
  return correlation;
}

Eigen::MatrixXd GramOfCorrelation(const Scene& scene,
                                  const ObservedDisplacements& observed,
                                  const Eigen::MatrixXd& sensitivities,
                                  const Autocorrelation& correlation) {
  const Eigen::Index m = sensitivities.cols();
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(m, m);
  if (correlation.values.size() == 0) {
    return sum;
  }
  const double reach =
      static_cast<double>(correlation.values.size()) * correlation.step;
  // By columns, so that those of a row are side by side.
  const Eigen::MatrixXd by_row = sensitivities.transpose();
  for (const RowsOfComponent& rows : SplitRows(scene, observed)) {
    Eigen::MatrixXd of_component = Eigen::MatrixXd::Zero(m, m);
    VisitPairs(
        rows, reach, [&](Eigen::Index a, Eigen::Index b, double distance) {
          const double rho = correlation.At(distance);
          if (rho != 0) {
            of_component += rho * by_row.col(a) * by_row.col(b).transpose();
          }
        });
    sum += rows.points_per_row * rows.points_per_row *
           (of_component + of_component.transpose());
  }
  return sum;
}

CorrelatedResiduals DescribeCorrelation(const Scene& scene,
                                        const ObservedDisplacements& observed,
                                        const Eigen::VectorXd& residual,
                                        const Eigen::MatrixXd& sensitivities) {
  const Autocorrelation correlation =
      CorrelateResiduals(scene, observed, residual);
  return {correlation.Length(),
          ShareOfModel(scene.mesh, correlation.LengthOfAlike()),
          PositivePart(
              GramOfCorrelation(scene, observed, sensitivities, correlation))};
}

}  // namespace elastimate
