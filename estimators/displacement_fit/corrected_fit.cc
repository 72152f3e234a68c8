#include "elastimate/estimators/displacement_fit/corrected_fit.h"

#include <algorithm>
#include <cmath>

#include "elastimate/core/algebra/dense_algebra.h"
#include "elastimate/core/algebra/node_sums.h"
#include "elastimate/core/scene/observed_displacements.h"
#include "elastimate/estimators/interface/judge.h"
#include "elastimate/estimators/interface/limits.h"
#include "elastimate/estimators/interface/rules.h"
#include "elastimate/estimators/statistics/bounded_parameter.h"
#include "elastimate/estimators/statistics/finer_specimen.h"

namespace elastimate {
namespace {

constexpr double kUsualPoissonRatio = 0.3;

bool IsOnGivenBound(const DescribedFit& described) {
  const ActiveBounds& active = described.evidence.active;
  return active.Any() && !active.is_physical_limit;
}

// Whether finer elements ask for other parameters, beside their errors, where
// it is likely that there are such; what a bound that is given leaves is none.
// What was taken is given back in any case.
bool AsksForOthers(const DescribedFit& described) {
  constexpr double kNotable = 0.05;
  constexpr double kLikelyShare = 0.5;
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

// A nu that may become the best once the change to finer elements is taken, as
// far from that of the fit as to change differently there; empty where there is
// none.
std::optional<double> OtherPoissonRatio(const EstimatorOptions& options,
                                        const DescribedFit& described,
                                        CorrectableFit& fit) {
  constexpr double kFar = 0.7;
  if (options.known_poisson_ratio) {
    return std::nullopt;
  }
  const Bounds bounds = EffectivePoissonRatioBounds(options);
  double other = std::clamp(kUsualPoissonRatio, *bounds.lower, *bounds.upper);
  if (described.element_change) {
    const Profile range = fit.RangeWithin(described.statistics.excess_of_finer);
    other =
        std::clamp(other, range.lower.poisson_ratio, range.upper.poisson_ratio);
  }
  const double nu = described.estimate.elasticity.poisson_ratio;
  return std::abs(LogStiffnessRatio(other) - LogStiffnessRatio(nu)) > kFar
             ? std::optional<double>(other)
             : std::nullopt;
}

// The square sum of the difference of what finer elements change at another nu,
// as far as E does not take it up.
double SquareDifference(const DescribedFit& described,
                        const Eigen::VectorXd& elsewhere) {
  if (!described.element_change) {
    return 0;
  }
  const Eigen::VectorXd difference = *described.element_change - elsewhere;
  const Eigen::VectorXd scale = described.sensitivities.col(0);
  return SquaredNorm(difference) -
         std::pow(InnerProduct(scale, difference), 2) / SquaredNorm(scale);
}

// From two fits, of which the other was the last, and what finer elements
// change at the nu that the other began at.  As much of the difference to that
// is doubtful as either fit sees of the changes.
CorrectedFit BetterOf(const DescribedFit& one, const DescribedFit& other,
                      const Eigen::VectorXd& elsewhere, CorrectableFit& fit) {
  const bool is_other = *other.statistics.rest < *one.statistics.rest;
  const DescribedFit& rival = is_other ? one : other;
  const double share = std::max(std::abs(one.statistics.share_of_finer),
                                std::abs(other.statistics.share_of_finer));
  CorrectedFit best = {is_other ? other : one, 0, {}};
  best.doubt = share * share * SquareDifference(best.fit, elsewhere);
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

// Of a fit that has settled, and what settles from the measurement without all
// that finer elements change at another nu.
CorrectedFit BestOf(const DescribedFit& settled, double other,
                    CorrectableFit& fit) {
  const std::optional<FitAtRatio> change = fit.FitAt(other);
  if (change && fit.Fit(PriorOfSpecimen(2).share * change->element_change)) {
    const DescribedFit of_finer = Settle(fit.Describe(), fit);
    if (of_finer.element_change && of_finer.statistics.rest &&
        settled.statistics.rest) {
      return BetterOf(settled, of_finer, change->element_change, fit);
    }
  }
  fit.FitNear(settled.estimate.elasticity, settled.taken);
  return {settled, 0, {}};
}

// The change of (ln E, nu) of a fit to where the u + e of another nu, with
// another scale and the slope of u in nu, leaves no more of the measurement
// than this share; empty where it leaves more.
std::optional<Eigen::Vector2d> ChangeToSpecimen(
    const FitAtRatio& other, const IsotropicElasticity& elasticity,
    double most) {
  const Eigen::VectorXd displacement = -other.sensitivities.col(0);
  const Eigen::VectorXd measured = displacement - other.residual;
  Eigen::MatrixXd columns(measured.size(), 2);
  columns << displacement + other.element_change, other.sensitivities.col(1);
  const Eigen::VectorXd scale_and_step = SolveLeastSquares(columns, measured);
  const double scale = scale_and_step(0);
  if (!(scale > 0) ||
      !(Norm(measured - columns * scale_and_step) <= most * Norm(measured))) {
    return std::nullopt;
  }
  return Eigen::Vector2d(std::log(other.elasticity.youngs_modulus / scale /
                                  elasticity.youngs_modulus),
                         other.elasticity.poisson_ratio +
                             scale_and_step(1) / scale -
                             elasticity.poisson_ratio);
}

// Linear elements that would be too coarse for a specimen may fit one with
// other parameters, as far off as no linear model sees.  Where a specimen
// explains the measurement as well, but for chance, the fit is asked to change
// to that.
void LookForSpecimenElsewhere(const EstimatorOptions& options,
                              CorrectableFit& fit, DescribedFit& described) {
  // Within three standard errors, of residuals that are noise.
  constexpr double kExcess = 9;
  const IsotropicElasticity& elasticity = described.estimate.elasticity;
  if (!described.element_change || !elasticity.IsPhysical() ||
      !IsCorrectionTooLarge(SolveLeastSquares(described.sensitivities,
                                              *described.element_change))) {
    return;
  }
  const Bounds bounds = EffectivePoissonRatioBounds(options);
  const double usual =
      std::clamp(kUsualPoissonRatio, *bounds.lower, *bounds.upper);
  const double most =
      *described.estimate.displacement_residual *
      std::sqrt(1 + kExcess /
                        static_cast<double>(described.element_change->size()));
  for (const double nu : {elasticity.poisson_ratio, usual}) {
    const std::optional<FitAtRatio> other = fit.FitAt(nu);
    const std::optional<Eigen::Vector2d> change =
        other ? ChangeToSpecimen(*other, elasticity, most) : std::nullopt;
    if (change && IsCorrectionTooLarge(*change)) {
      described.evidence.likely_element_change = *change;
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
  const std::optional<double> elsewhere =
      scene.mesh.Order() == 1 ? std::nullopt
                              : OtherPoissonRatio(options, first, fit);
  CorrectedFit corrected = {Settle(first, fit), 0, {}};
  if (elsewhere) {
    corrected = BestOf(corrected.fit, *elsewhere, fit);
  } else if (scene.mesh.Order() == 1 && !options.known_poisson_ratio &&
             !IsOnGivenBound(first)) {
    LookForSpecimenElsewhere(options, fit, corrected.fit);
  }
  Estimate& estimate = corrected.fit.estimate;
  estimate.displacement_residual = first.estimate.displacement_residual;
  estimate.bounded_residual = first.estimate.bounded_residual;
  // Of quadratic elements, which stand for a specimen, what that leaves.
  if (scene.mesh.Order() == 2 && corrected.fit.statistics.rest) {
    estimate.bounded_residual = *corrected.fit.statistics.rest /
                                Norm(ObservedDisplacements(scene).Measured());
  }
  return corrected;
}

}  // namespace elastimate
