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

// The points of one load case, by their place along the longest axis of the
// mesh.
struct PointsOfCase {
  Eigen::Matrix3Xd positions;  ///< The last row is zero in a planar scene.
  Eigen::Index axis = 0;
  /// The rows of their components; -1 for components that are not observed.
  Eigen::Matrix<Eigen::Index, 3, Eigen::Dynamic> rows;
  /// Points for each that is looked at.
  double points_per_point = 1;

  Eigen::Index Size() const { return positions.cols(); }
};

void SortByPosition(const Mesh& mesh, PointsOfCase& points) {
  (mesh.nodes.rowwise().maxCoeff() - mesh.nodes.rowwise().minCoeff())
      .maxCoeff(&points.axis);
  std::vector<Eigen::Index> order(points.Size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](Eigen::Index a, Eigen::Index b) {
    return points.positions(points.axis, a) < points.positions(points.axis, b);
  });
  points.positions = points.positions(Eigen::all, order).eval();
  points.rows = points.rows(Eigen::all, order).eval();
}

PointsOfCase PointsOf(const Scene& scene, const ObservedDisplacements& observed,
                      Eigen::Index k) {
  const Mesh& mesh = scene.mesh;
  const MeshPoints& off_nodes = scene.load_cases[k].points.points;
  const Eigen::MatrixXd of_points =
      off_nodes.Size() == 0 ? Eigen::MatrixXd(mesh.Dimension(), 0)
                            : Interpolate(mesh, off_nodes, mesh.nodes);
  std::vector<const ObservedDisplacements::Point*> of_case;
  for (const auto& point : observed.Points()) {
    if (point.load_case == k) {
      of_case.push_back(&point);
    }
  }
  PointsOfCase points;
  const Eigen::Index num_points = Eigen::Index(of_case.size());
  const Eigen::Index stride =
      1 + std::max(num_points - 1, Eigen::Index{0}) / kMostPoints;
  const Eigen::Index size = (num_points + stride - 1) / stride;
  points.points_per_point = static_cast<double>(stride);
  points.positions.setZero(3, size);
  points.rows.setConstant(3, size, -1);
  for (Eigen::Index i = 0; i < size; ++i) {
    const ObservedDisplacements::Point& point = *of_case[stride * i];
    points.positions.col(i).head(mesh.Dimension()) =
        point.index < mesh.NumNodes()
            ? mesh.nodes.col(point.index)
            : of_points.col(point.index - mesh.NumNodes());
    for (Eigen::Index row = point.first; row < point.first + point.count;
         ++row) {
      points.rows(observed.Component(row), i) = row;
    }
  }
  SortByPosition(mesh, points);
  return points;
}

std::vector<PointsOfCase> PointsOfCases(const Scene& scene,
                                        const ObservedDisplacements& observed) {
  std::vector<PointsOfCase> all;
  for (Eigen::Index k = 0; k < observed.NumLoadCases(); ++k) {
    all.push_back(PointsOf(scene, observed, k));
  }
  return all;
}

// The median distance of a point to its nearest neighbour.
double SpacingOf(const std::vector<PointsOfCase>& all) {
  std::vector<double> nearest;
  for (const PointsOfCase& points : all) {
    std::vector<double> distance(points.Size(),
                                 std::numeric_limits<double>::infinity());
    for (const auto& [a, b] : NearestPairs(points.positions, 1)) {
      const double d =
          (points.positions.col(a) - points.positions.col(b)).norm();
      distance[a] = std::min(distance[a], d);
      distance[b] = std::min(distance[b], d);
    }
    nearest.insert(nearest.end(), distance.begin(), distance.end());
  }
  const auto median = nearest.begin() + std::ptrdiff_t(nearest.size() / 2);
  std::nth_element(nearest.begin(), median, nearest.end());
  return *median;
}

// Calls visit(j, distance) for the points behind i that are nearer than
// `reach`.
template <class Visit>
void VisitNearPoints(const PointsOfCase& points, Eigen::Index i, double reach,
                     const Visit& visit) {
  const auto along = points.positions.row(points.axis);
  for (Eigen::Index j = i + 1; j < points.Size() && along(j) - along(i) < reach;
       ++j) {
    const double distance =
        (points.positions.col(i) - points.positions.col(j)).norm();
    if (distance < reach) {
      visit(j, distance);
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

// Sums over pairs of rows, with a column for each step of their distance.
struct PairSums {
  enum { kProducts, kSquareDistances, kCounts };
  Eigen::Array3Xd of_steps;

  auto Products() const { return of_steps.row(kProducts); }
  auto SquareDistances() const { return of_steps.row(kSquareDistances); }
  auto Counts() const { return of_steps.row(kCounts); }
};

PairSums SumPairs(const std::vector<PointsOfCase>& all,
                  const Eigen::VectorXd& residual, double step,
                  Eigen::Index num_steps) {
  PairSums sums = {Eigen::Array3Xd::Zero(3, num_steps)};
  const double reach = static_cast<double>(num_steps) * step;
  for (const PointsOfCase& points : all) {
    Eigen::Matrix3Xd residuals = Eigen::Matrix3Xd::Zero(3, points.Size());
    Eigen::Matrix3Xd are_observed = residuals;
    for (Eigen::Index i = 0; i < residuals.size(); ++i) {
      if (points.rows(i) >= 0) {
        residuals(i) = residual(points.rows(i));
        are_observed(i) = 1;
      }
    }
    for (Eigen::Index i = 0; i < points.Size(); ++i) {
      VisitNearPoints(points, i, reach, [&](Eigen::Index j, double distance) {
        const double count = are_observed.col(i).dot(are_observed.col(j));
        sums.of_steps.col(std::min(static_cast<Eigen::Index>(distance / step),
                                   num_steps - 1)) +=
            Eigen::Array3d(residuals.col(i).dot(residuals.col(j)),
                           count * distance * distance, count);
      });
    }
  }
  return sums;
}

// Returns rho up to where it is first not significant.
Eigen::VectorXd SignificantValues(const PairSums& sums, double variance) {
  const Eigen::VectorXd values =
      (sums.Products() / (variance * sums.Counts())).matrix();
  Eigen::Index last = 0;
  while (last < values.size() && sums.Counts()(last) > 0 &&
         values(last) >=
             kLimits.explained_score / std::sqrt(sums.Counts()(last))) {
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
  const std::vector<PointsOfCase> all = PointsOfCases(scene, observed);
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
  const auto counts = sums.Counts();
  correlation.values = values.cwiseMin(1.0);
  if (values.size() > 0 && num_steps > 1 && counts(1) > 0) {
    const double next =
        std::max(sums.Products()(1) / (counts(1) * variance), 0.0) +
        kTwoSidedErrors / std::sqrt(counts(1));
    FillSmoothed(values(0), next,
                 (sums.SquareDistances().head(2) / counts.head(2)).matrix(),
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
  for (const PointsOfCase& points : PointsOfCases(scene, observed)) {
    // The rows of a point side by side.
    Eigen::MatrixXd of_points = Eigen::MatrixXd::Zero(3 * m, points.Size());
    for (Eigen::Index i = 0; i < points.Size(); ++i) {
      for (int c = 0; c < 3; ++c) {
        if (points.rows(c, i) >= 0) {
          of_points.col(i).segment(m * c, m) =
              sensitivities.row(points.rows(c, i)).transpose();
        }
      }
    }
    Eigen::MatrixXd of_case = Eigen::MatrixXd::Zero(m, m);
    Eigen::VectorXd others(3 * m);
    for (Eigen::Index i = 0; i < points.Size(); ++i) {
      others.setZero();
      VisitNearPoints(points, i, reach, [&](Eigen::Index j, double distance) {
        others += correlation.At(distance) * of_points.col(j);
      });
      of_case.noalias() +=
          of_points.col(i).reshaped(m, 3) * others.reshaped(m, 3).transpose();
    }
    sum += points.points_per_point * points.points_per_point *
           (of_case + of_case.transpose());
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
