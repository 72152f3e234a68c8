#include "elastimate/estimators/maps/region_map.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "elastimate/estimators/misfit/displacement_misfit.h"

namespace elastimate {
namespace {

constexpr Eigen::Index kMostRegions = 3;
constexpr int kMostRegionRounds = 15;
constexpr int kMostSweeps = 50;
// Measurements for each unknown, below which their noise, where it is not
// known, passes for structure.
constexpr Eigen::Index kRowsForEach = 3;
// So many responses are kept at a time, which bounds their memory, and so many
// solved for together.
constexpr std::size_t kMostMoves = 1000;
constexpr std::size_t kColumns = 64;
// An element whose move costs so much, in -ln of the posterior, stays with a
// probability of 99.8 %, and is left out.
constexpr double kUnlikely = 6;

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

// An element at a boundary, the region on the other side, and how much the
// criterion grows if it goes there.
struct RegionMove {
  int element;
  int region;
  double cost;
};

void SortByCost(std::vector<RegionMove>& moves) {
  std::sort(moves.begin(), moves.end(),
            [](const RegionMove& a, const RegionMove& b) {
              return std::make_pair(a.cost, a.element) <
                     std::make_pair(b.cost, b.element);
            });
}

bool AreAllThere(const std::vector<int>& regions, Eigen::Index num_regions) {
  return std::set<int>(regions.begin(), regions.end()).size() ==
         std::size_t(num_regions);
}

// Returns the elements beside each element.
std::vector<std::vector<int>> NeighboursOf(const ElementFacets& facets,
                                           Eigen::Index num_elements) {
  std::vector<std::vector<int>> neighbours(num_elements);
  for (const auto& sides : facets.elements.colwise()) {
    if (sides(1) >= 0) {
      neighbours[sides(0)].push_back(sides(1));
      neighbours[sides(1)].push_back(sides(0));
    }
  }
  return neighbours;
}

class RegionSearch {
 public:
  RegionSearch(const MapProblem& problem, const FieldPrior& prior,
               std::vector<int> regions, LevelFit fit)
      : problem_(problem),
        neighbours_(NeighboursOf(prior.Facets(), prior.NumElements())),
        regions_(std::move(regions)),
        fit_(std::move(fit)) {}

  void Improve() {
    for (int round = 0; round < kMostRegionRounds; ++round) {
      const std::vector<RegionMove> moves = PromisingMoves(0);
      // Some moves gain only together.  Where that fails because the linearised
      // model is far off, moves that gain by themselves may still do.
      if (!TakeSome(RelaxedMoves(moves)) && !TakeSome(SingleMoves(moves))) {
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
    Eigen::Index twice = 0;
    for (std::size_t e = 0; e < regions.size(); ++e) {
      for (const int other : neighbours_[e]) {
        twice += regions[e] != regions[other] ? 1 : 0;
      }
    }
    return twice / 2;
  }

  // Returns what the criterion has beside the misfit.
  double CostOf(const std::vector<int>& regions) const {
    return double(fit_.levels.size()) * std::log(NumRows()) +
           2 * double(NumFacetsBetween(regions));
  }

  double CriterionOf(const std::vector<int>& regions,
                     const LevelFit& fit) const {
    return 2 * MisfitOf(fit.square_sum) + CostOf(regions);
  }

  // Returns the square sum from which on regions are no better.
  double MostSquareSum(const std::vector<int>& regions) const {
    const double of_misfit = Criterion() - CostOf(regions);
    return problem_.noise ? of_misfit * problem_.Variance(0, 1)
                          : std::exp(of_misfit / NumRows());
  }

  // Returns by how many facets the boundaries grow where an element moves.
  double GrowthOf(const RegionMove& move) const {
    double growth = 0;
    for (const int other : neighbours_[move.element]) {
      growth += regions_[other] == regions_[move.element] ? 1 : 0;
      growth -= regions_[other] == move.region ? 1 : 0;
    }
    return growth;
  }

  // Returns the moves to the regions of neighbours that could cost less than
  // this, the best first, with lower bounds of their costs, without the
  // curvature, which takes a solve.  The model is at the fit.
  std::vector<RegionMove> PromisingMoves(double most) {
    residual_ = fit_.unknowns.Project(problem_.model.Residual());
    const Eigen::VectorXd gradient =
        -problem_.model.MultiplyTransposed(residual_) / Variance();
    std::vector<RegionMove> moves;
    for (int e = 0; e < int(regions_.size()); ++e) {
      for (int region = 0; region < int(fit_.levels.size()); ++region) {
        const bool is_beside =
            std::any_of(neighbours_[e].begin(), neighbours_[e].end(),
                        [&](int other) { return regions_[other] == region; });
        if (is_beside && region != regions_[e]) {
          RegionMove move = {e, region, 0};
          move.cost = GrowthOf(move) + gradient(e) * DeltaOf(move);
          if (move.cost < most) {
            moves.push_back(move);
          }
        }
      }
    }
    SortByCost(moves);
    moves.resize(std::min(moves.size(), kMostMoves));
    SolveForResponses(moves);
    return moves;
  }

  // Returns half of the misfit's part in the criterion.
  double MisfitOf(double square_sum) const {
    const double n = NumRows();
    return problem_.noise ? square_sum / (2 * problem_.Variance(0, 1))
                          : n / 2 *
                                std::log(std::max(
                                    square_sum, n * kLeastNoise * kLeastNoise));
  }

  // Returns the moves of which more than a half is taken, most of it first,
  // where shares t of all moves minimise the misfit of the linearised model and
  // the growth of the boundaries.
  std::vector<RegionMove> RelaxedMoves(
      const std::vector<RegionMove>& candidates) const {
    const double variance = Variance();
    std::vector<double> shares(candidates.size(), 0);
    std::vector<Eigen::VectorXf> changes;
    changes.reserve(candidates.size());
    for (const RegionMove& move : candidates) {
      const Eigen::VectorXd change =
          DeltaOf(move) * ProjectedResponse(move.element);
      changes.push_back(change.cast<float>());
    }
    Eigen::VectorXf residual = residual_.cast<float>();
    for (int sweep = 0; sweep < kMostSweeps; ++sweep) {
      for (std::size_t i = 0; i < candidates.size(); ++i) {
        const double gain = double(residual.dot(changes[i])) -
                            variance * GrowthOf(candidates[i]);
        const double curvature = std::max(double(changes[i].squaredNorm()),
                                          std::numeric_limits<double>::min());
        const double share = std::clamp(shares[i] + gain / curvature, 0.0, 1.0);
        residual -= float(share - shares[i]) * changes[i];
        shares[i] = share;
      }
    }
    std::vector<RegionMove> moves;
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      if (shares[i] > 0.5) {
        moves.push_back(
            {candidates[i].element, candidates[i].region, -shares[i]});
      }
    }
    SortByCost(moves);
    return moves;
  }

  // Returns the moves that lower the criterion by themselves, the best first;
  // each element once.
  std::vector<RegionMove> SingleMoves(std::vector<RegionMove> moves) const {
    for (RegionMove& move : moves) {
      const double delta = DeltaOf(move);
      move.cost += CurvatureOf(move.element) * delta * delta / 2;
    }
    SortByCost(moves);
    std::vector<RegionMove> single;
    std::set<int> elements;
    for (const RegionMove& move : moves) {
      if (move.cost < 0 && elements.insert(move.element).second) {
        single.push_back(move);
      }
    }
    return single;
  }

  // Returns S e.
  Eigen::VectorXd ResponseTo(int element) const {
    return responses_.at(element).cast<double>();
  }
  // Returns Pi S e.
  Eigen::VectorXd ProjectedResponse(int element) const {
    return fit_.unknowns.Project(ResponseTo(element));
  }

  double CurvatureOf(int element) const {
    return ProjectedResponse(element).squaredNorm() / Variance();
  }

  // Solves for the responses S e to elements that are not there yet, and
  // forgets those of other elements.  A response changes little from round to
  // round.
  void SolveForResponses(const std::vector<RegionMove>& moves) {
    std::map<int, Eigen::VectorXf> responses;
    std::vector<int> missing;
    for (const RegionMove& move : moves) {
      const auto found = responses_.find(move.element);
      if (found != responses_.end()) {
        responses.insert(*found);
      } else if (responses.emplace(move.element, Eigen::VectorXf()).second) {
        missing.push_back(move.element);
      }
    }
    for (std::size_t first = 0; first < missing.size(); first += kColumns) {
      const std::size_t n = std::min(kColumns, missing.size() - first);
      Eigen::MatrixXd units =
          Eigen::MatrixXd::Zero(Eigen::Index(regions_.size()), Eigen::Index(n));
      for (std::size_t i = 0; i < n; ++i) {
        units(missing[first + i], Eigen::Index(i)) = 1;
      }
      const Eigen::MatrixXd columns = problem_.model.Multiply(units);
      for (std::size_t i = 0; i < n; ++i) {
        responses[missing[first + i]] =
            columns.col(Eigen::Index(i)).cast<float>();
      }
    }
    responses_ = std::move(responses);
  }

  double DeltaOf(const RegionMove& move) const {
    return fit_.levels(move.region) - fit_.levels(regions_[move.element]);
  }

  // Takes all moves or, where that is no better, the first half of them, a
  // quarter, and so on.  The model is at the fit if any are taken.
  bool TakeSome(std::vector<RegionMove> moves) {
    while (!moves.empty()) {
      if (Take(moves)) {
        return true;
      }
      moves.resize(moves.size() / 2);
    }
    return false;
  }

  bool Take(const std::vector<RegionMove>& moves) {
    std::vector<int> regions = regions_;
    for (const RegionMove& move : moves) {
      regions[move.element] = move.region;
    }
    if (!AreAllThere(regions, fit_.levels.size())) {
      return false;
    }
    std::optional<LevelFit> fit =
        FitLevels(problem_, regions, fit_.levels, fit_.state.poisson_ratio,
                  MostSquareSum(regions));
    if (fit && fit->unknowns.Rank() == fit_.unknowns.Rank() &&
        CriterionOf(regions, *fit) < Criterion()) {
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
    for (const RegionMove& move : PromisingMoves(kUnlikely)) {
      const double delta = DeltaOf(move);
      const double cost =
          move.cost + CurvatureOf(move.element) * delta * delta / 2;
      const double p = 1 / (1 + std::exp(std::max(cost, 0.0)));
      const Eigen::VectorXd shift =
          delta * fit_.unknowns.Solve(ResponseTo(move.element));
      covariance += p * (1 - p) * shift * shift.transpose();
    }
  }

  const MapProblem& problem_;
  std::vector<std::vector<int>> neighbours_;
  std::vector<int> regions_;
  LevelFit fit_;
  // Pi r at the fit, kept because refused trials leave the model elsewhere.
  Eigen::VectorXd residual_;
  // S e, by elements, in single precision, as there are many.
  std::map<int, Eigen::VectorXf> responses_;
};

}  // namespace

std::vector<RegionMap> FitRegions(const MapProblem& problem,
                                  const FieldPrior& prior,
                                  const MapState& sharpened,
                                  const LevelFit& homogeneous) {
  const Eigen::Index num_rows = problem.model.NumIndependentRows();
  std::vector<RegionMap> maps;
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
    const Eigen::Index rank = homogeneous.unknowns.Rank() + k - 1;
    if (!AreAllThere(regions, k) ||
        (!problem.noise && kRowsForEach * rank > num_rows)) {
      continue;
    }
    std::optional<LevelFit> fit =
        FitLevels(problem, regions, means, sharpened.poisson_ratio);
    if (!fit || fit->unknowns.Rank() != rank) {
      continue;
    }
    RegionSearch search(problem, prior, regions, *fit);
    search.Improve();
    if (search.Criterion() < least) {
      least = search.Criterion();
      maps.insert(maps.begin(), search.Result());
      maps.front().log_evidence = (whole.Criterion() - least) / 2;
    }
  }
  return maps;
}

}  // namespace elastimate
