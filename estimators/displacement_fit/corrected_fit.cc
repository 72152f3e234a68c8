#include "elastimate/estimators/displacement_fit/corrected_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "elastimate/core/algebra/dense_algebra.h"
#include "elastimate/core/algebra/node_sums.h"
#include "elastimate/core/scene/observed_displacements.h"
#include "elastimate/estimators/interface/judge.h"
#include "elastimate/estimators/interface/limits.h"
#include "elastimate/estimators/interface/rules.h"
#include "elastimate/estimators/statistics/bounded_parameter.h"
#include "elastimate/estimators/statistics/error_propagation.h"
#include "elastimate/estimators/statistics/finer_specimen.h"
#include "elastimate/estimators/statistics/residual_statistics.h"

namespace elastimate {
namespace {

constexpr double kUsualPoissonRatio = 0.3;
// Of the change to finer elements, from which on there is likely to be one.
constexpr double kLikelyShare = 0.5;

bool IsOnGivenBound(const DescribedFit& described) {
  const ActiveBounds& active = described.evidence.active;
  return active.Any() && !active.is_physical_limit;
}

// Whether finer elements ask for other parameters, beside their errors, where
// it is likely that there are such; what a bound that is given leaves is none.
// What was taken is given back in any case.
bool AsksForOthers(const DescribedFit& described) {
  constexpr double kNotable = 0.05;
  if (described.taken.size() == 0 &&
      (described.statistics.share_of_finer < kLikelyShare ||
       IsOnGivenBound(described))) {
    return false;
  }
  const Estimate& estimate = described.estimate;
  const Eigen::Array2d errors =
      estimate.covariance.diagonal().array().sqrt() /
      Eigen::Array2d(estimate.elasticity.youngs_modulus, 1);
  // Of a known or bounded parameter there is no error.
  return (described.statistics.correction.array().abs() > kNotable * errors)
      .any();
}

bool AreElementsTooCoarse(const EstimatorOptions& options,
                          const DescribedFit& described) {
  Estimate estimate = described.estimate;
  Judge(described.evidence, options, estimate);
  return estimate.Has(FindingCode::kElementsTooCoarse);
}

// Takes what finer elements explain, and fits again, until that asks for no
// other parameters.
DescribedFit Settle(DescribedFit described, CorrectableFit& fit) {
  constexpr int kMostRefits = 4;
  for (int i = 0; i < kMostRefits && AsksForOthers(described); ++i) {
    const Eigen::VectorXd taken =
        described.statistics.share_of_finer * *described.element_change;
    const IsotropicElasticity start = Corrected(
        described.estimate.elasticity, described.statistics.correction);
    if (!fit.FitNear(start, taken)) {
      fit.FitNear(described.estimate.elasticity, described.taken);
      break;
    }
    described = fit.Describe();
  }
  return described;
}

// Whether what finer elements change may change with nu as much as matters
// beside what a fit sees of nu: as fast as by all of itself over this step.
bool MayChangeWithPoissonRatio(const DescribedFit& described) {
  constexpr double kStep = 0.05;
  constexpr double kNotable = 0.2;
  const Eigen::VectorXd& scale = described.sensitivities.col(0);
  const Eigen::VectorXd& by_poisson_ratio = described.sensitivities.col(1);
  const double visible =
      SquaredNorm(by_poisson_ratio) -
      std::pow(InnerProduct(scale, by_poisson_ratio), 2) / SquaredNorm(scale);
  return SquaredNorm(*described.element_change) >
         std::pow(kNotable * kStep, 2) * visible;
}

// dc / dnu of the (ln E, nu) that take up what finer elements change, towards
// the nu that they ask for, where there is likely to be a finer specimen; zero
// where that does not matter, or is not known.
Eigen::Vector2d SlopeOfChange(const EstimatorOptions& options,
                              const DescribedFit& described,
                              CorrectableFit& fit) {
  // In LogStiffnessRatio.
  constexpr double kStep = 0.3;
  if (!described.element_change || described.evidence.active.Any() ||
      described.statistics.share_of_finer < kLikelyShare ||
      !MayChangeWithPoissonRatio(described)) {
    return Eigen::Vector2d::Zero();
  }
  const IsotropicElasticity& elasticity = described.estimate.elasticity;
  const double nu = elasticity.poisson_ratio;
  const double step = std::copysign(kStep, described.statistics.correction(1));
  const Bounds bounds = EffectivePoissonRatioBounds(options);
  double other = PoissonRatioOfLogStiffnessRatio(LogStiffnessRatio(nu) + step);
  if (!(*bounds.lower <= other && other <= *bounds.upper)) {
    other = PoissonRatioOfLogStiffnessRatio(LogStiffnessRatio(nu) - step);
  }
  if (!(*bounds.lower <= other && other <= *bounds.upper)) {
    return Eigen::Vector2d::Zero();
  }
  const std::optional<FitAtRatio> there = fit.FitAt(other);
  fit.FitNear(elasticity, described.taken);
  if (!there) {
    return Eigen::Vector2d::Zero();
  }
  return (SolveLeastSquares(there->sensitivities, there->element_change) -
          SolveLeastSquares(described.sensitivities,
                            *described.element_change)) /
         (other - nu);
}

// A fit without what finer elements change at a nu is a fixed point where it
// has that nu: of p = p_0 - alpha c(nu), c with this slope.  An error of p_0 is
// as much larger in p as that takes up what nu changes.
void AllowForSlope(const Eigen::Vector2d& slope, DescribedFit& described) {
  // A smaller one is as good as none.
  constexpr double kLeast = 0.02;
  const Eigen::Vector2d of_nu = described.statistics.share_of_finer * slope;
  if (!(of_nu(1) < 0)) {
    return;
  }
  const double left = std::max(1 + of_nu(1), kLeast);
  Eigen::Matrix2d propagation;
  propagation << 1, -of_nu(0) / left, 0, 1 / left;
  PropagateErrors(propagation, described.estimate);
  if (described.statistics.row_variance) {
    *described.statistics.row_variance /= left * left;
  }
}

// Of rows, as far as the parameters do not take them up.
double VisibleSquareSum(const Eigen::VectorXd& rows,
                        const Eigen::MatrixXd& sensitivities) {
  return SquaredNorm(rows -
                     sensitivities * SolveLeastSquares(sensitivities, rows));
}

// Whether noise may hide that linear elements fit a specimen, at a nu where
// less of the change to it shows than at that of the fit.
bool MayHideSpecimen(const DescribedFit& described) {
  // In variances of a row: 45 standard errors of the change at the fit.
  constexpr double kMostVisible = 2000;
  if (!described.element_change || IsOnGivenBound(described)) {
    return false;
  }
  const Eigen::VectorXd& change = *described.element_change;
  const double variance = std::pow(described.statistics.rest.value_or(0), 2) /
                          double(change.size());
  return VisibleSquareSum(change, described.sensitivities) <=
         kMostVisible * variance;
}

// Those nu that may become the best once the change to finer elements is taken:
// none where the change at the fit hides none that is as far as to change
// differently, else all over the range, since what changes there may hide more.
std::vector<double> OtherPoissonRatios(const EstimatorOptions& options,
                                       int order, const DescribedFit& described,
                                       CorrectableFit& fit) {
  constexpr double kFar = 0.7;
  if (options.known_poisson_ratio ||
      (order == 1 && !MayHideSpecimen(described))) {
    return {};
  }
  const auto are_far = [](double one, double other) {
    return std::abs(LogStiffnessRatio(one) - LogStiffnessRatio(other)) > kFar;
  };
  const double nu = described.estimate.elasticity.poisson_ratio;
  if (described.element_change) {
    const Profile range = fit.RangeWithin(described.statistics.excess_of_finer);
    if (!are_far(range.lower.poisson_ratio, nu) &&
        !are_far(range.upper.poisson_ratio, nu)) {
      return {};
    }
  }
  const Bounds bounds = EffectivePoissonRatioBounds(options);
  std::vector<double> others;
  for (const double usual : {kUsualPoissonRatio, -0.5, 0.0, 0.45}) {
    const double other = std::clamp(usual, *bounds.lower, *bounds.upper);
    if (are_far(other, nu) &&
        std::all_of(others.begin(), others.end(),
                    [&](double one) { return are_far(one, other); })) {
      others.push_back(other);
    }
  }
  return others;
}

// Linear elements may have computed the measurement: as far as their change, of
// which much shows, may be off, a specimen would always explain that as well.
bool IsChangeInDoubt(int order) { return order == 2; }

// The measurement without what finer elements change at another nu, of which
// the measurement says how much there is.
struct ChangeElsewhere {
  IsotropicElasticity elasticity;
  Eigen::VectorXd change;  ///< All of it.
  Eigen::VectorXd taken;
  double rest;  ///< BoundedNorm of what E leaves.
  /// What ln E may be off by since the change may.
  double log_youngs_modulus_error;
  /// Square sum of what the change may be off by in that.
  double doubt = 0;

  /// As far from an estimate as E may be here.
  IsotropicElasticity FarFrom(const Estimate& estimate) const {
    const bool is_stiffer =
        elasticity.youngs_modulus > estimate.elasticity.youngs_modulus;
    return {elasticity.youngs_modulus *
                std::exp(is_stiffer ? log_youngs_modulus_error
                                    : -log_youngs_modulus_error),
            elasticity.poisson_ratio};
  }
};

std::optional<ChangeElsewhere> FitElsewhere(
    const ObservedDisplacements& observed, int order, double poisson_ratio,
    CorrectableFit& fit) {
  const std::optional<FitAtRatio> at = fit.FitAt(poisson_ratio);
  if (!at) {
    return std::nullopt;
  }
  const SpecimenPrior prior = PriorOfSpecimen(order);
  Eigen::MatrixXd columns(observed.Size(), 2);
  columns << at->sensitivities.col(0), at->element_change;
  const double share = std::clamp(
      RobustChange(observed, at->residual, columns)(1), 0.0, 2 * prior.share);
  ChangeElsewhere elsewhere = {
      at->elasticity, at->element_change, share * at->element_change, 0, 0, 0};
  const Eigen::VectorXd residual = at->residual + elsewhere.taken;
  const Eigen::VectorXd scale = columns.col(0);
  const Eigen::VectorXd change = RobustChange(observed, residual, scale);
  elsewhere.elasticity.youngs_modulus *= std::exp(change(0));
  elsewhere.rest = BoundedNorm(observed, residual + scale * change);
  elsewhere.log_youngs_modulus_error =
      prior.unequal *
      std::abs(InnerProduct(scale, elsewhere.taken) / SquaredNorm(scale));
  if (IsChangeInDoubt(order)) {
    elsewhere.doubt =
        std::pow(prior.unequal, 2) * VisibleSquareSum(elsewhere.taken, scale);
  }
  return elsewhere;
}

// Of what finer elements change at another nu, the difference.
double SquareDifference(const DescribedFit& described,
                        const Eigen::VectorXd& elsewhere) {
  return described.element_change
             ? VisibleSquareSum(*described.element_change - elsewhere,
                                described.sensitivities.col(0))
             : 0;
}

// From two fits, of which the other was the last, and what finer elements
// change at the nu that the other began at.  As much of the difference to that
// is doubtful as either fit sees of the changes.
CorrectedFit BetterOf(const DescribedFit& one, const DescribedFit& other,
                      const Eigen::VectorXd& elsewhere, int order,
                      CorrectableFit& fit) {
  const bool is_other = *other.statistics.rest < *one.statistics.rest;
  const DescribedFit& rival = is_other ? one : other;
  CorrectedFit best = {is_other ? other : one, 0, {}};
  if (IsChangeInDoubt(order)) {
    const double share = std::max(std::abs(one.statistics.share_of_finer),
                                  std::abs(other.statistics.share_of_finer));
    best.doubt = share * share * SquareDifference(best.fit, elsewhere);
  }
  const double excess = best.ExcessOf(kTwoSidedQuantile) -
                        (std::pow(*rival.statistics.rest, 2) -
                         std::pow(*best.fit.statistics.rest, 2));
  if (excess > 0) {
    if (is_other) {
      fit.FitNear(rival.estimate.elasticity, rival.taken);
    }
    best.rival = fit.RangeWithin(excess);
  }
  if (excess > 0 || !is_other) {
    fit.FitNear(best.fit.estimate.elasticity, best.fit.taken);
  }
  return best;
}

// Of a fit that has settled, and what settles from the measurement without what
// finer elements change at other nu.  Where that change moves the fit by more
// than the step of nu to which it belongs, no fit settles at the best of them:
// those that leave as little as any stay rivals as they are.
CorrectedFit BestOf(const ObservedDisplacements& observed, int order,
                    const DescribedFit& settled,
                    const std::vector<double>& other_ratios,
                    CorrectableFit& fit) {
  std::vector<ChangeElsewhere> others;
  for (const double nu : other_ratios) {
    const std::optional<ChangeElsewhere> other =
        FitElsewhere(observed, order, nu, fit);
    if (other) {
      others.push_back(*other);
    }
  }
  const auto best_other = std::min_element(
      others.begin(), others.end(),
      [](const ChangeElsewhere& one, const ChangeElsewhere& other) {
        return one.rest < other.rest;
      });
  CorrectedFit best = {settled, 0, {}};
  if (best_other == others.end() || !settled.statistics.rest) {
    fit.FitNear(settled.estimate.elasticity, settled.taken);
    return best;
  }
  bool is_settled_last = false;
  if (fit.FitNear(best_other->elasticity, best_other->taken)) {
    const DescribedFit of_finer = Settle(fit.Describe(), fit);
    if (of_finer.element_change && of_finer.statistics.rest) {
      best = BetterOf(settled, of_finer, best_other->change, order, fit);
      is_settled_last = true;
    }
  }
  if (!is_settled_last) {
    fit.FitNear(settled.estimate.elasticity, settled.taken);
  }
  const double least = std::min(best_other->rest, *best.fit.statistics.rest);
  for (const ChangeElsewhere& other : others) {
    if (std::pow(other.rest, 2) - std::pow(least, 2) <=
        kTwoSidedQuantile * std::pow(least, 2) / double(observed.Size()) +
            other.doubt) {
      const IsotropicElasticity end = other.FarFrom(best.fit.estimate);
      best.rival = best.WithRival({end, end});
    }
  }
  return best;
}

// Where the u + e of another nu, with another scale and the slope of u in nu,
// explains the measurement.
struct SpecimenElsewhere {
  Eigen::Vector2d change;  ///< Of (ln E, nu), from those of a fit.
  double of_elements;      ///< Norm of its e, relative to the measurement.
  double left;             ///< Of the measurement, relative to it.
};

std::optional<SpecimenElsewhere> SpecimenNear(
    const FitAtRatio& other, const IsotropicElasticity& elasticity) {
  const Eigen::VectorXd displacement = -other.sensitivities.col(0);
  const Eigen::VectorXd measured = displacement - other.residual;
  Eigen::MatrixXd columns(measured.size(), 2);
  columns << displacement + other.element_change, other.sensitivities.col(1);
  const Eigen::VectorXd scale_and_step = SolveLeastSquares(columns, measured);
  const double scale = scale_and_step(0);
  if (!(scale > 0)) {
    return std::nullopt;
  }
  return SpecimenElsewhere{
      {std::log(other.elasticity.youngs_modulus / scale /
                elasticity.youngs_modulus),
       other.elasticity.poisson_ratio + scale_and_step(1) / scale -
           elasticity.poisson_ratio},
      scale * Norm(other.element_change) / Norm(measured),
      Norm(measured - columns * scale_and_step) / Norm(measured)};
}

// What noise lets a specimen leave more than a fit does: within three standard
// errors.
double MostByChance(double residual, Eigen::Index num_rows) {
  constexpr double kExcess = 9;
  return residual * std::sqrt(1 + kExcess / static_cast<double>(num_rows));
}

// Whether it leaves no more than a fit, but for chance and what a specimen does
// otherwise than e, where the noise is about as large.
bool ExplainsAsWell(const SpecimenElsewhere& specimen, double residual,
                    Eigen::Index num_rows) {
  constexpr double kMissed = 0.03;
  constexpr double kAlike = 1.1;
  const double by_chance = MostByChance(residual, num_rows);
  const double with_missed = std::min(
      kAlike * residual, std::hypot(by_chance, kMissed * specimen.of_elements));
  return specimen.left <= std::max(by_chance, with_missed);
}

// Linear elements that would be too coarse for a specimen may fit one with
// other parameters, as far off as no linear model sees.  Where a specimen of
// this or a usual nu explains the measurement as well, the fit is asked to
// change to that; so it is of other nu where that nearly does.
void LookForSpecimenElsewhere(const EstimatorOptions& options,
                              CorrectableFit& fit, DescribedFit& described) {
  constexpr double kNearly = 2;
  const IsotropicElasticity& elasticity = described.estimate.elasticity;
  if (!described.element_change || !elasticity.IsPhysical() ||
      !IsCorrectionTooLarge(SolveLeastSquares(described.sensitivities,
                                              *described.element_change))) {
    return;
  }
  const Bounds bounds = EffectivePoissonRatioBounds(options);
  const double residual = *described.estimate.displacement_residual;
  const Eigen::Index num_rows = described.element_change->size();
  const std::array<double, 4> ratios = {elasticity.poisson_ratio,
                                        kUsualPoissonRatio, 0, 0.45};
  double left = 0;
  for (std::size_t i = 0; i < ratios.size(); ++i) {
    if (i >= 2 && left > kNearly * MostByChance(residual, num_rows)) {
      break;
    }
    const std::optional<FitAtRatio> other =
        fit.FitAt(std::clamp(ratios[i], *bounds.lower, *bounds.upper));
    const std::optional<SpecimenElsewhere> specimen =
        other ? SpecimenNear(*other, elasticity) : std::nullopt;
    if (!specimen) {
      continue;
    }
    left = specimen->left;
    if (ExplainsAsWell(*specimen, residual, num_rows) &&
        IsCorrectionTooLarge(specimen->change)) {
      described.evidence.likely_element_change = specimen->change;
      break;
    }
  }
  fit.FitNear(elasticity, described.taken);
}

}  // namespace

Profile CorrectedFit::WithRival(const Profile& profile) const {
  return rival ? Hull(profile, *rival) : profile;
}

Eigen::VectorXd WhatIsLeft(const Eigen::VectorXd& measured,
                           const Eigen::VectorXd& taken) {
  return taken.size() == 0 ? measured : measured - taken;
}

CorrectedFit FitCorrected(const Scene& scene, const EstimatorOptions& options,
                          CorrectableFit& fit) {
  const DescribedFit first = fit.Describe();
  if (AreElementsTooCoarse(options, first)) {
    return {first, 0, {}};
  }
  const ObservedDisplacements observed(scene);
  const int order = scene.mesh.Order();
  const std::vector<double> other_ratios =
      OtherPoissonRatios(options, order, first, fit);
  const Eigen::Vector2d slope = order == 1 && !options.known_poisson_ratio
                                    ? SlopeOfChange(options, first, fit)
                                    : Eigen::Vector2d::Zero().eval();
  CorrectedFit corrected = {Settle(first, fit), 0, {}};
  if (!other_ratios.empty()) {
    corrected = BestOf(observed, order, corrected.fit, other_ratios, fit);
  }
  if (order == 1 && !options.known_poisson_ratio && !IsOnGivenBound(first)) {
    LookForSpecimenElsewhere(options, fit, corrected.fit);
  }
  AllowForSlope(slope, corrected.fit);
  Estimate& estimate = corrected.fit.estimate;
  estimate.displacement_residual = first.estimate.displacement_residual;
  estimate.bounded_residual = first.estimate.bounded_residual;
  // Of quadratic elements, which stand for a specimen, what that leaves.
  if (order == 2 && corrected.fit.statistics.rest) {
    estimate.bounded_residual =
        *corrected.fit.statistics.rest / Norm(observed.Measured());
  }
  return corrected;
}

}  // namespace elastimate
