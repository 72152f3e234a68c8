#include "elastimate/estimators/maps/region_map.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

#include "elastimate/estimators/misfit/displacement_misfit.h"

namespace elastimate {
namespace {

constexpr Eigen::Index kMostRegions = 3;
constexpr int kMostRegionRounds = 15;

// Means of values with weights, ascending, from quantiles on (Lloyd).
Eigen::VectorXd ClusterMeans(const Eigen::VectorXd& values,
                             const Eigen::VectorXd& weights, Eigen::Index k) {
  Eigen::VectorXd means =
      Eigen::VectorXd::LinSpaced(k, values.minCoeff(), values.maxCoeff());
  for (int i = 0; i < 100; ++i) {
    Eigen::VectorXd sums = Eigen::VectorXd::Zero(k);
    Eigen::VectorXd totals = Eigen::VectorXd::Zero(k);
    for (Eigen::Index e = 0; e < values.size(); ++e) {
      Eigen::Index nearest = 0;
      (means.array() - values(e)).abs().minCoeff(&nearest);
      sums(nearest) += weights(e) * values(e);
      totals(nearest) += weights(e);
    }
    means = (totals.array() > 0).select(sums.array() / totals.array(), means);
  }
  return means;
}

// An element at a boundary, the region on the other side, and what the misfit
// and the boundary gain where it goes there.
struct RegionMove {
  int element;
  int region;
  double cost;
};

class RegionSearch {
 public:
  RegionSearch(const MapProblem& problem, const FieldPrior& prior,
               std::vector<int> regions, LevelFit fit)
      : problem_(problem),
        facets_(prior.Facets()),
        regions_(std::move(regions)),
        fit_(std::move(fit)) {}

  void Improve() {
    for (int round = 0; round < kMostRegionRounds; ++round) {
      std::vector<RegionMove> moves = Moves();
      moves.erase(
          std::remove_if(moves.begin(), moves.end(),
                         [](const RegionMove& move) { return move.cost >= 0; }),
          moves.end());
      // The model is linearised and moves act on each other, so fewer of them
      // may do where all of them do not.
      while (!moves.empty() && !Take(moves)) {
        moves.resize(moves.size() / 2);
      }
      if (moves.empty()) {
        return;
      }
    }
  }

  double Criterion() const { return CriterionOf(regions_, fit_); }

  RegionMap Result() {
    static_cast<void>(problem_.model.MoveTo(fit_.state.log_moduli,
                                            fit_.state.poisson_ratio, Noise()));
    const double variance = Variance();
    Eigen::MatrixXd covariance = variance * fit_.unknowns.InverseGram();
    AddUncertainElements(covariance);
    return {regions_, fit_, 0, covariance, variance};
  }

 private:
  double NumRows() const { return double(problem_.model.NumIndependentRows()); }
  double Variance() const {
    return problem_.Variance(fit_.square_sum,
                             NumRows() - double(fit_.unknowns.Rank()));
  }
  double Noise() const { return std::sqrt(Variance()); }

  Eigen::Index NumFacetsBetween(const std::vector<int>& regions) const {
    Eigen::Index count = 0;
    for (const auto& sides : facets_.elements.colwise()) {
      count += sides(1) >= 0 && regions[sides(0)] != regions[sides(1)] ? 1 : 0;
    }
    return count;
  }

  double CriterionOf(const std::vector<int>& regions,
                     const LevelFit& fit) const {
    const double n = NumRows();
    return (problem_.noise
                ? fit.square_sum / problem_.Variance(0, 1)
                : n * std::log(std::max(fit.square_sum,
                                        n * kLeastNoise * kLeastNoise))) +
           double(fit.levels.size()) * std::log(n) +
           2 * double(NumFacetsBetween(regions));
  }

  // Returns the change of the number of facets between regions.
  std::vector<RegionMove> Neighbours() const {
    const Eigen::Index num_regions = fit_.levels.size();
    std::vector<std::vector<int>> counts(
        regions_.size(), std::vector<int>(std::size_t(num_regions), 0));
    for (const auto& sides : facets_.elements.colwise()) {
      if (sides(1) >= 0) {
        ++counts[sides(0)][regions_[sides(1)]];
        ++counts[sides(1)][regions_[sides(0)]];
      }
    }
    std::vector<RegionMove> moves;
    for (std::size_t e = 0; e < regions_.size(); ++e) {
      for (int region = 0; region < num_regions; ++region) {
        if (region != regions_[e] && counts[e][region] > 0) {
          moves.push_back({int(e), region,
                           double(counts[e][regions_[e]] - counts[e][region])});
        }
      }
    }
    return moves;
  }

  // Returns the possible moves, the best first.  The model is at the fit.  The
  // response to each element is solved for once: it changes little from round
  // to round, whereas the gradient is that of here.
  std::vector<RegionMove> Moves() {
    std::vector<RegionMove> moves = Neighbours();
    SolveForResponses(moves);
    const Eigen::VectorXd gradient =
        -problem_.model.MultiplyTransposed(
            fit_.unknowns.Project(problem_.model.Residual())) /
        Variance();
    for (RegionMove& move : moves) {
      const double curvature =
          fit_.unknowns.Project(responses_.at(move.element)).squaredNorm() /
          Variance();
      const double delta = DeltaOf(move);
      move.cost +=
          gradient(move.element) * delta + curvature * delta * delta / 2;
    }
    std::sort(moves.begin(), moves.end(),
              [](const RegionMove& a, const RegionMove& b) {
                return std::make_pair(a.cost, a.element) <
                       std::make_pair(b.cost, b.element);
              });
    return moves;
  }

  // Solves for the responses S e to elements that are not there yet.
  void SolveForResponses(const std::vector<RegionMove>& moves) {
    std::vector<int> missing;
    for (const RegionMove& move : moves) {
      if (responses_.count(move.element) == 0 &&
          (missing.empty() || missing.back() != move.element)) {
        missing.push_back(move.element);
      }
    }
    Eigen::MatrixXd units = Eigen::MatrixXd::Zero(Eigen::Index(regions_.size()),
                                                  Eigen::Index(missing.size()));
    for (std::size_t i = 0; i < missing.size(); ++i) {
      units(missing[i], Eigen::Index(i)) = 1;
    }
    const Eigen::MatrixXd columns = problem_.model.Multiply(units);
    for (std::size_t i = 0; i < missing.size(); ++i) {
      responses_[missing[i]] = columns.col(Eigen::Index(i));
    }
  }

  double DeltaOf(const RegionMove& move) const {
    return fit_.levels(move.region) - fit_.levels(regions_[move.element]);
  }

  bool Take(const std::vector<RegionMove>& moves) {
    std::vector<int> regions = regions_;
    for (const RegionMove& move : moves) {
      // An element has its best move first.
      if (regions[move.element] == regions_[move.element]) {
        regions[move.element] = move.region;
      }
    }
    std::optional<LevelFit> fit =
        FitLevels(problem_, regions, fit_.levels, fit_.state.poisson_ratio);
    if (fit && CriterionOf(regions, *fit) < Criterion()) {
      regions_ = regions;
      fit_ = *fit;
      return true;
    }
    return false;
  }

  // An element that would go elsewhere at a cost c in -ln of the posterior is
  // there with the probability p = 1 / (1 + e^c), which shifts the levels by
  // (Z^T Z)^-1 Z^T S e delta.
  void AddUncertainElements(Eigen::MatrixXd& covariance) {
    for (const RegionMove& move : Moves()) {
      const double p = 1 / (1 + std::exp(std::max(move.cost, 0.0)));
      const Eigen::VectorXd shift =
          DeltaOf(move) * fit_.unknowns.Solve(responses_.at(move.element));
      covariance += p * (1 - p) * shift * shift.transpose();
    }
  }

  const MapProblem& problem_;
  const ElementFacets& facets_;
  std::vector<int> regions_;
  LevelFit fit_;
  std::map<int, Eigen::VectorXd> responses_;  // S e, by elements.
};

}  // namespace

std::optional<RegionMap> FitRegions(const MapProblem& problem,
                                    const FieldPrior& prior,
                                    const MapState& sharpened,
                                    const LevelFit& homogeneous) {
  std::optional<RegionMap> best;
  double least = std::numeric_limits<double>::infinity();
  const RegionSearch whole(
      problem, prior, std::vector<int>(std::size_t(prior.NumElements()), 0),
      homogeneous);
  for (Eigen::Index k = 2; k <= kMostRegions; ++k) {
    const Eigen::VectorXd means =
        ClusterMeans(sharpened.log_moduli, prior.Volumes(), k);
    std::vector<int> regions(std::size_t(prior.NumElements()));
    for (std::size_t e = 0; e < regions.size(); ++e) {
      Eigen::Index nearest = 0;
      (means.array() - sharpened.log_moduli(Eigen::Index(e)))
          .abs()
          .minCoeff(&nearest);
      regions[e] = int(nearest);
    }
    std::optional<LevelFit> fit =
        FitLevels(problem, regions, means, sharpened.poisson_ratio);
    if (!fit) {
      continue;
    }
    RegionSearch search(problem, prior, regions, *fit);
    search.Improve();
    if (search.Criterion() < least) {
      least = search.Criterion();
      best = search.Result();
      best->log_evidence = (whole.Criterion() - least) / 2;
    }
  }
  return best;
}

}  // namespace elastimate
