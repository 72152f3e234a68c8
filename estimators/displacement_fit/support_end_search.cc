#include "elastimate/estimators/displacement_fit/support_end_search.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "elastimate/core/algebra/dense_algebra.h"
#include "elastimate/core/algebra/node_sums.h"
#include "elastimate/core/scene/support_ends.h"
#include "elastimate/estimators/displacement_fit/displacement_profile.h"
#include "elastimate/estimators/displacement_fit/robust_reduced_fit.h"
#include "elastimate/estimators/interface/stopwatch.h"
#include "elastimate/estimators/misfit/observed_model.h"
#include "elastimate/estimators/statistics/bounded_parameter.h"
#include "elastimate/estimators/statistics/node_losses.h"

namespace elastimate {
namespace {

constexpr std::size_t kMostEnds = 4;
// Of each end.
constexpr std::size_t kMostCuts = 24;
// Of chi^2, for three standard errors.
constexpr double kRangeQuantile = 9;

using NumSteps = std::vector<std::size_t>;

std::size_t NumComponents(const SupportEnd& end) {
  std::size_t size = 0;
  for (const auto& step : end.steps) {
    size += step.size();
  }
  return size;
}

// The same, with the smallest of too many ends as one of a single step.
std::vector<SupportEnd> LargestEnds(std::vector<SupportEnd> ends) {
  if (ends.size() <= kMostEnds) {
    return ends;
  }
  std::stable_sort(ends.begin(), ends.end(),
                   [](const SupportEnd& a, const SupportEnd& b) {
                     return NumComponents(a) > NumComponents(b);
                   });
  SupportEnd rest;
  rest.steps.emplace_back();
  for (std::size_t k = kMostEnds - 1; k < ends.size(); ++k) {
    for (const auto& step : ends[k].steps) {
      rest.steps[0].insert(rest.steps[0].end(), step.begin(), step.end());
    }
  }
  ends.resize(kMostEnds - 1);
  ends.push_back(std::move(rest));
  return ends;
}

// A fit that is linear in (ln E, nu), next to that of its cut.
struct CutFit {
  IsotropicElasticity elasticity;
  /// Of weighted rows; empty where there is no fit.
  Eigen::VectorXd residual;
  double square_sum = std::numeric_limits<double>::infinity();

  Eigen::Vector2d Parameters() const {
    return {std::log(elasticity.youngs_modulus), elasticity.poisson_ratio};
  }
};

// Fits of one scene on the supports of any cut.
class CutFitter {
 public:
  CutFitter(const Scene& scene, const EstimatorOptions& options)
      : scene_(scene),
        options_(options),
        bounds_(EffectivePoissonRatioBounds(options)) {}

  CutFit Fit(const NumSteps& steps, double nu) {
    Scene scene = scene_;
    scene.supports = EndingAfter(steps, scene_.supports);
    ObservedModel model(scene, options_);
    nu = options_.known_poisson_ratio.value_or(
        std::clamp(nu, *bounds_.lower, *bounds_.upper));
    CutFit fit;
    constexpr int kMostGaussNewtonSteps = 4;
    constexpr double kSameStiffness = 0.2;
    for (int i = 0; i < kMostGaussNewtonSteps; ++i) {
      if (!model.SetPoissonRatio(nu)) {
        fit = {};
        break;
      }
      fit = GaussNewtonStep(model, nu);
      const double before = std::exchange(nu, fit.elasticity.poisson_ratio);
      if (fit.residual.size() == 0 ||
          std::abs(LogStiffnessRatio(nu) - LogStiffnessRatio(before)) <=
              kSameStiffness) {
        break;
      }
    }
    work_ = work_ + model.WorkDone();
    return fit;
  }

  // Lets bad nodes count as little as they do in the residual of a fit.
  void SetWeights(const CutFit& fit) {
    const ObservedDisplacements observed(scene_);
    weights_ = RowWeights(
        observed, fit.residual,
        NodeLosses(options_.loss, RobustStandardDeviation(fit.residual)));
  }

  // Of a row, as a fit or the given noise says.
  double Variance(const CutFit& fit) const {
    // Of rounding, relative to what was measured.
    constexpr double kRounding = 1e-10;
    constexpr double kNumParameters = 2;
    const double redundancy =
        std::max(double(fit.residual.size()) - kNumParameters, 1.0);
    return std::max({fit.square_sum / redundancy, is_noise_given_ ? 1.0 : 0.0,
                     std::pow(kRounding * norm_, 2) / redundancy});
  }

  const Work& WorkDone() const { return work_; }

 private:
  // With the E that fits best at nu, and both within their bounds.
  CutFit GaussNewtonStep(ObservedModel& model, double nu) {
    const ObservedDisplacements& observed = model.Observed();
    norm_ = observed.Norm();
    is_noise_given_ = observed.GivenNoise().has_value();
    const ProfilePoint start = EvaluateProfile(options_, model, nu);
    CutFit fit;
    fit.elasticity = start.elasticity;
    if (!fit.elasticity.IsPhysical()) {
      return fit;
    }
    const double scale = fit.elasticity.ComplianceScale(model.Section());
    fit.residual = Weighted(scale * model.UnitLoadResponse() +
                            model.SupportResponse() - observed.Measured());
    const Eigen::MatrixXd s =
        Weighted(model.Sensitivities(fit.elasticity.youngs_modulus));
    std::vector<Eigen::Index> free;
    if (start.elasticity.youngs_modulus == start.unbounded.youngs_modulus) {
      free.push_back(0);
    }
    if (!options_.known_poisson_ratio) {
      free.push_back(1);
    }
    Eigen::Vector2d step = Eigen::Vector2d::Zero();
    if (!free.empty()) {
      step(free) = -SolveLeastSquares(s(Eigen::all, free), fit.residual);
    }
    const double reached =
        std::clamp(nu + step(1), *bounds_.lower, *bounds_.upper);
    if (reached != nu + step(1)) {
      step(1) = reached - nu;
      const Eigen::VectorXd left = fit.residual + step(1) * s.col(1);
      step(0) = free.front() == 0
                    ? -InnerProduct(s.col(0), left) / SquaredNorm(s.col(0))
                    : 0;
    }
    fit.residual += s * step;
    fit.square_sum = SquaredNorm(fit.residual);
    fit.elasticity.youngs_modulus *= std::exp(step(0));
    fit.elasticity.poisson_ratio += step(1);
    return fit;
  }

  // In units of the measurement or, where it is given, of its noise.
  Eigen::MatrixXd Weighted(const Eigen::MatrixXd& rows) const {
    return weights_.size() == 0
               ? Eigen::MatrixXd(norm_ * rows)
               : Eigen::MatrixXd(norm_ * (weights_.asDiagonal() * rows));
  }

  const Scene& scene_;
  const EstimatorOptions& options_;
  Bounds bounds_;
  /// Empty where all rows count alike.
  Eigen::VectorXd weights_;
  double norm_ = 1;
  bool is_noise_given_ = false;
  Work work_;
};

// Two cuts next to each other among those that were looked at.  Between them
// the residual is taken as linear, the square sum as a parabola.
struct Segment {
  double start;
  double length;
  double vertex;  ///< In lengths from the start, not always between 0 and 1.
  double at_vertex;
  double curvature;

  double At(double share) const { return start + share * length; }
  double Least() const {
    const double beyond = vertex - std::clamp(vertex, 0.0, 1.0);
    return at_vertex + curvature * beyond * beyond;
  }
};

// The cuts of one end that were looked at, in order.
class CutFamily {
 public:
  void Add(std::size_t position, const CutFit& fit) {
    positions_.push_back(double(position));
    fits_.push_back(&fit);
  }

  std::size_t Size() const { return fits_.size(); }

  // Where the square sum is above its least by no more than `excess`.
  Interval RangeOf(double excess) const {
    const std::vector<Segment> segments = Segments();
    double most = std::numeric_limits<double>::infinity();
    for (const Segment& segment : segments) {
      most = std::min(most, segment.Least() + excess);
    }
    Interval range = {positions_.back(), positions_.front()};
    for (const Segment& segment : segments) {
      if (segment.Least() > most) {
        continue;
      }
      const double reach =
          segment.curvature > 0
              ? std::sqrt(std::max(most - segment.at_vertex, 0.0) /
                          segment.curvature)
              : 1;
      const auto end = [&](double share) {
        return segment.At(std::clamp(share, 0.0, 1.0));
      };
      range.lower = std::min(range.lower, end(segment.vertex - reach));
      range.upper = std::max(range.upper, end(segment.vertex + reach));
    }
    return range;
  }

  // Where to look next, of all `num_steps`: on either side of the best, as if
  // there were no other minimum.  Empty where the noise hides more.
  std::optional<std::size_t> Next(std::size_t num_steps, double excess) const {
    if (positions_.front() > 0) {
      return 0;
    }
    if (positions_.back() < double(num_steps)) {
      return num_steps;
    }
    const Interval range = RangeOf(excess);
    const auto best = std::min_element(fits_.begin(), fits_.end(),
                                       [](const CutFit* a, const CutFit* b) {
                                         return a->square_sum < b->square_sum;
                                       });
    const std::size_t middle = std::size_t(best - fits_.begin());
    double longest = std::max(1.0, range.upper - range.lower);
    std::optional<std::size_t> next;
    for (std::size_t i = middle > 0 ? middle - 1 : 0;
         i <= middle && i + 1 < Size(); ++i) {
      if (positions_[i + 1] - positions_[i] > longest) {
        longest = positions_[i + 1] - positions_[i];
        next = std::size_t(positions_[i] + longest / 2);
      }
    }
    return next;
  }

  // Of the residual and of (ln E, nu), for each step, about what is likely.
  std::pair<Eigen::VectorXd, Eigen::Vector2d> Slopes(double excess) const {
    const Interval range = RangeOf(excess);
    std::size_t lower = 0;
    std::size_t upper = Size() - 1;
    while (lower + 1 < Size() && positions_[lower + 1] <= range.lower &&
           positions_[lower + 1] < range.upper) {
      ++lower;
    }
    while (upper > 0 && positions_[upper - 1] >= range.upper &&
           positions_[upper - 1] > range.lower) {
      --upper;
    }
    // Two sides of a cut that is the only likely one.
    if (lower == upper) {
      lower = lower > 0 ? lower - 1 : lower;
      upper = std::min(upper + 1, Size() - 1);
    }
    const double distance =
        std::max(positions_[upper] - positions_[lower], 1.0);
    return {
        (fits_[upper]->residual - fits_[lower]->residual) / distance,
        (fits_[upper]->Parameters() - fits_[lower]->Parameters()) / distance};
  }

 private:
  std::vector<Segment> Segments() const {
    std::vector<Segment> segments;
    for (std::size_t i = 0; i + 1 < Size(); ++i) {
      const Eigen::VectorXd change =
          fits_[i + 1]->residual - fits_[i]->residual;
      const double curvature = SquaredNorm(change);
      const double slope = InnerProduct(fits_[i]->residual, change);
      const double vertex = curvature > 0 ? -slope / curvature : 0;
      segments.push_back({positions_[i], positions_[i + 1] - positions_[i],
                          vertex, fits_[i]->square_sum + slope * vertex,
                          curvature});
    }
    return segments;
  }

  std::vector<double> positions_;
  std::vector<const CutFit*> fits_;
};

class SupportEndSearch {
 public:
  SupportEndSearch(const Scene& scene, const EstimatorOptions& options,
                   double poisson_ratio)
      : ends_(scene.supports.ends),
        fitter_(scene, options),
        best_(ends_.size(), 0),
        searched_at_(ends_.size(), best_) {
    cuts_[best_] = fitter_.Fit(best_, poisson_ratio);
    if (options.loss != Loss::kNone && Best().residual.size() != 0) {
      fitter_.SetWeights(Best());
      cuts_[best_] = fitter_.Fit(best_, poisson_ratio);
    }
  }

  void Run() {
    const std::size_t num_sweeps = ends_.size() > 1 ? 2 : 1;
    for (std::size_t sweep = 0; sweep < num_sweeps; ++sweep) {
      for (std::size_t end = 0; end < ends_.size(); ++end) {
        Search(end, kMostCuts / num_sweeps);
      }
    }
    cuts_[best_] = fitter_.Fit(best_, Best().elasticity.poisson_ratio);
  }

  bool HasFit() const { return Best().residual.size() != 0; }
  const NumSteps& BestSteps() const { return best_; }
  const Work& WorkDone() const { return fitter_.WorkDone(); }

  SupportDoubt Doubt() const {
    const double variance = fitter_.Variance(Best());
    const auto size = Eigen::Index(ends_.size());
    Eigen::MatrixXd of_residual =
        Eigen::MatrixXd::Zero(Best().residual.size(), size);
    Eigen::MatrixXd of_parameters = Eigen::MatrixXd::Zero(2, size);
    Eigen::VectorXd extent(size);
    Eigen::VectorXd position(size);
    for (Eigen::Index k = 0; k < size; ++k) {
      extent(k) = double(ends_[k].steps.size());
      position(k) = double(best_[k]);
      const CutFamily family = FamilyOf(std::size_t(k), searched_at_[k]);
      if (family.Size() > 1) {
        const auto [residual, parameters] =
            family.Slopes(kRangeQuantile * variance);
        of_residual.col(k) = residual;
        of_parameters.col(k) = parameters;
      }
    }
    // Supports end anywhere from the held to the free vertices, with the
    // middles half way: ends are as likely anywhere in twice the extent of the
    // steps.
    const Eigen::VectorXd prior = 3 * extent.cwiseAbs2().cwiseInverse();
    const Eigen::MatrixXd precision =
        InnerProducts(of_residual, of_residual) / variance +
        Eigen::MatrixXd(prior.asDiagonal());
    const Eigen::MatrixXd covariance = Inverse(precision);
    Eigen::VectorXd further =
        covariance * (prior.cwiseProduct(extent / 2 - position) -
                      InnerProducts(of_residual, Best().residual) / variance);
    further = further.cwiseMax(-extent / 2 - position)
                  .cwiseMin(1.5 * extent - position);
    return {of_parameters * further,
            of_parameters * covariance * of_parameters.transpose()};
  }

 private:
  const CutFit& Best() const { return cuts_.at(best_); }

  // Along one end from a cut.
  CutFamily FamilyOf(std::size_t end, NumSteps steps) const {
    CutFamily family;
    for (std::size_t k = 0; k <= ends_[end].steps.size(); ++k) {
      steps[end] = k;
      const auto found = cuts_.find(steps);
      if (found != cuts_.end() &&
          found->second.residual.size() == Best().residual.size()) {
        family.Add(k, found->second);
      }
    }
    return family;
  }

  void Search(std::size_t end, std::size_t most_cuts) {
    for (std::size_t i = 0; i < most_cuts; ++i) {
      const std::optional<std::size_t> next =
          FamilyOf(end, best_)
              .Next(ends_[end].steps.size(),
                    kRangeQuantile * fitter_.Variance(Best()));
      NumSteps steps = best_;
      steps[end] = next.value_or(best_[end]);
      if (cuts_.count(steps) > 0) {
        break;
      }
      cuts_[steps] = fitter_.Fit(steps, PoissonRatioNearTo(steps));
      if (cuts_[steps].square_sum < Best().square_sum) {
        best_ = steps;
      }
    }
    searched_at_[end] = best_;
  }

  // To start from: next to its limits nu of one cut takes many steps to that of
  // another.
  double PoissonRatioNearTo(const NumSteps& steps) const {
    double nearest = std::numeric_limits<double>::infinity();
    double nu = Best().elasticity.poisson_ratio;
    for (const auto& [other, fit] : cuts_) {
      double distance = 0;
      for (std::size_t k = 0; k < steps.size(); ++k) {
        distance += std::abs(double(steps[k]) - double(other[k]));
      }
      if (fit.residual.size() != 0 && distance < nearest) {
        nearest = distance;
        nu = fit.elasticity.poisson_ratio;
      }
    }
    constexpr double kLeast = -0.9;
    constexpr double kMost = 0.47;
    return std::clamp(nu, kLeast, kMost);
  }

  const std::vector<SupportEnd>& ends_;
  CutFitter fitter_;
  std::map<NumSteps, CutFit> cuts_;
  NumSteps best_;
  /// The best when each end was searched last.
  std::vector<NumSteps> searched_at_;
};

}  // namespace

Estimate FitAndFindSupportEnds(const Scene& scene,
                               const EstimatorOptions& options,
                               const SupportedFit& fit) {
  if (scene.supports.ends.empty()) {
    return fit(scene, {});
  }
  Stopwatch stopwatch;
  Scene open = scene;
  open.supports.ends = LargestEnds(scene.supports.ends);
  Scene ended = scene;
  ended.supports = EndingAfter({}, open.supports);
  Estimate of_free = fit(ended, {});
  if (!of_free.elasticity.IsPhysical()) {
    return of_free;
  }
  SupportEndSearch search(open, options, of_free.elasticity.poisson_ratio);
  if (!search.HasFit()) {
    return of_free;
  }
  search.Run();
  ended.supports = EndingAfter(search.BestSteps(), open.supports);
  const double seconds = stopwatch.Lap();
  Estimate estimate = fit(ended, search.Doubt());
  estimate.stages.insert(estimate.stages.begin(), {"find supports", seconds});
  estimate.work = of_free.work + search.WorkDone() + estimate.work;
  return estimate;
}

}  // namespace elastimate
