#include "elastimate/estimators/statistics/residual_statistics.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "elastimate/core/algebra/dense_algebra.h"
#include "elastimate/core/algebra/node_sums.h"
#include "elastimate/estimators/interface/limits.h"
#include "elastimate/estimators/statistics/node_losses.h"

namespace elastimate {

namespace {

// Products of the same components of neighbours.
struct NeighbourProducts {
  double sum = 0;
  Eigen::Index count = 0;

  void Add(double product) {
    sum += product;
    ++count;
  }
};

}  // namespace

void VisitNeighbours(
    const NodeGraph& graph, const ObservedDisplacements& observed,
    const std::function<void(Eigen::Index a, Eigen::Index b)>& visit) {
  const std::vector<ObservedDisplacements::Point>& points = observed.Points();
  const Eigen::Index num_nodes = Eigen::Index(graph.start.size()) - 1;
  std::vector<Eigen::Index> place_of(std::size_t(num_nodes), -1);
  for (std::size_t next = 0; next < points.size();) {
    std::fill(place_of.begin(), place_of.end(), -1);
    const Eigen::Index load_case = points[next].load_case;
    for (; next < points.size() && points[next].load_case == load_case;
         ++next) {
      if (points[next].index < num_nodes) {
        place_of[points[next].index] = Eigen::Index(next);
      }
    }
    for (Eigen::Index node = 0; node < num_nodes; ++node) {
      for (Eigen::Index k = graph.start[node] + 1; k < graph.start[node + 1];
           ++k) {
        if (place_of[node] >= 0 && place_of[graph.row[k]] >= 0) {
          visit(place_of[node], place_of[graph.row[k]]);
        }
      }
    }
  }
  for (const auto& [a, b] : observed.NeighbouringPoints()) {
    visit(a, b);
  }
}

std::optional<NeighbourCorrelation> CorrelateNeighbours(
    const NodeGraph& graph, const ObservedDisplacements& observed,
    const Eigen::VectorXd& residual) {
  const double square_sum = SquaredNorm(residual);
  NeighbourProducts products;
  const std::vector<ObservedDisplacements::Point>& points = observed.Points();
  VisitNeighbours(graph, observed, [&](Eigen::Index a, Eigen::Index b) {
    for (int i = 0; i < points[a].count; ++i) {
      for (int k = 0; k < points[b].count; ++k) {
        const Eigen::Index row = points[a].first + i;
        const Eigen::Index other = points[b].first + k;
        if (observed.Component(row) == observed.Component(other)) {
          products.Add(residual(row) * residual(other));
        }
      }
    }
  });
  if (products.count == 0 || square_sum == 0) {
    return std::nullopt;
  }
  const double n = static_cast<double>(products.count);
  const double variance = square_sum / static_cast<double>(residual.size());
  const double correlation = products.sum / (n * variance);
  return NeighbourCorrelation{correlation, 1 / std::sqrt(n)};
}

ResidualVariance EstimateVariance(const ObservedDisplacements& observed,
                                  double square_sum, Eigen::Index num_free,
                                  Evidence& evidence, Estimate& estimate) {
  const Eigen::Index redundancy = observed.Size() - num_free;
  const double norm_squared = observed.Norm() * observed.Norm();
  const std::optional<double>& given = observed.GivenNoise();
  const double m = static_cast<double>(std::max<Eigen::Index>(redundancy, 1));
  const double variance = square_sum / m;
  estimate.noise_sd = given ? *given : std::sqrt(variance) * observed.Norm();
  if (!given) {
    // Student's t of m degrees of freedom has the variance m / (m - 2).
    return ResidualVariance{variance * m / (m - 2), false};
  }
  // chi^2 has mean m and variance 2 m.
  const double ratio = variance * norm_squared;
  if (redundancy > 0 &&
      ratio > 1 + kLimits.significant_score * std::sqrt(2 / m)) {
    evidence.above_noise = {ResidualKind::kDisplacement, std::sqrt(ratio)};
    return ResidualVariance{variance, false};
  }
  return ResidualVariance{1 / norm_squared, true};
}

SmoothSquareSum MeasureSmoothPart(const NodeGraph& graph,
                                  const ObservedDisplacements& observed,
                                  const Eigen::VectorXd& residual,
                                  Estimate& estimate) {
  const double square_sum = SquaredNorm(residual);
  const std::optional<NeighbourCorrelation> neighbours =
      CorrelateNeighbours(graph, observed, residual);
  if (!neighbours) {
    return {0, square_sum};
  }
  const auto& [correlation, deviation] = *neighbours;
  estimate.residual_correlation = std::clamp(correlation, -1.0, 1.0);
  estimate.is_model_in_doubt =
      correlation > kLimits.significant_score * deviation;
  const auto within = [&](double share) {
    return std::clamp(share, 0.0, 1.0) * square_sum;
  };
  return {within(correlation - kLimits.explained_score * deviation),
          within(std::max(correlation, 0.0) + kTwoSidedErrors * deviation)};
}

Eigen::VectorXd RobustChange(const ObservedDisplacements& observed,
                             const Eigen::VectorXd& residual,
                             const Eigen::MatrixXd& sensitivities) {
  constexpr int kReweightings = 50;
  Eigen::VectorXd change = Eigen::VectorXd::Zero(sensitivities.cols());
  for (int i = 0; i < kReweightings; ++i) {
    const Eigen::VectorXd moved = residual + sensitivities * change;
    const double deviation =
        RobustStandardDeviation(Eigen::VectorXd(moved.head(observed.Size())));
    const Eigen::Index num_others = moved.size() - observed.Size();
    const auto others = sensitivities.bottomRows(num_others);
    Eigen::MatrixXd gram = others.transpose() * others;
    Eigen::VectorXd gradient = others.transpose() * moved.tail(num_others);
    for (const ObservedDisplacements::Point& node : observed.Points()) {
      const auto r = moved.segment(node.first, node.count);
      const auto s = sensitivities.middleRows(node.first, node.count);
      const double weight =
          EvaluateLoss(Loss::kHuber, deviation, node.count, r.squaredNorm())[1];
      gram += weight * s.transpose() * s;
      gradient += weight * s.transpose() * r;
    }
    change -= SolveLeastSquares(gram, gradient);
  }
  return change;
}

bool HasHeavyTails(const Eigen::VectorXd& residual) {
  const double n = static_cast<double>(residual.size());
  // The standard deviation of 1.4826 MAD is 1.17 / sqrt(n) of itself.
  const double threshold =
      kLimits.heavy_tails + kLimits.significant_score * 1.17 / std::sqrt(n);
  return Norm(residual) / std::sqrt(n) >
         threshold * RobustStandardDeviation(residual);
}

}  // namespace elastimate
