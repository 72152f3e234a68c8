#include "elastimate/estimators/interface/estimator.h"

#include <limits>
#include <optional>
#include <sstream>
#include <utility>

#include "elastimate/core/text/numbers.h"
#include "elastimate/estimators/interface/input_checks.h"
#include "elastimate/estimators/interface/judge.h"
#include "elastimate/estimators/interface/stopwatch.h"

namespace elastimate {
namespace {

std::string WhyInvalidBounds(const Bounds& bounds, const std::string& name,
                             double smallest, double largest,
                             const std::string& range) {
  for (const auto& bound : {bounds.lower, bounds.upper}) {
    if (bound && !(*bound >= smallest && *bound <= largest)) {
      return "a bound on " + name + " is " + NumberText(*bound) +
             "; it must be " + range;
    }
  }
  if (bounds.lower && bounds.upper && !(*bounds.lower < *bounds.upper)) {
    return "the bounds on " + name + " are crossed: the lower is " +
           NumberText(*bounds.lower) + ", the upper " +
           NumberText(*bounds.upper);
  }
  return "";
}

// This runs an estimator that keeps nothing.
class NoPreparation : public Preparation {
 public:
  explicit NoPreparation(std::function<Estimate(const Scene&)> run)
      : run_(std::move(run)) {}

  Estimate Run(const Scene& scene) override { return run_(scene); }
  bool TakesOtherLoadCases() const override { return true; }

 private:
  std::function<Estimate(const Scene&)> run_;
};

}  // namespace

std::string EstimatorOptions::WhyInvalid() const {
  if (known_poisson_ratio &&
      !(*known_poisson_ratio > -1 && *known_poisson_ratio < 0.5)) {
    return "the known Poisson's ratio is " + NumberText(*known_poisson_ratio) +
           "; it must be above -1 and below 0.5";
  }
  if (known_poisson_ratio && poisson_ratio.AreGiven()) {
    return "Poisson's ratio is given as known and has bounds; give one or the "
           "other";
  }
  std::string why = WhyInvalidBounds(poisson_ratio, "Poisson's ratio", -1, 0.5,
                                     "between -1 and 0.5");
  if (why.empty() &&
      (poisson_ratio.lower.value_or(-1) >= kLargestPoissonRatio ||
       poisson_ratio.upper.value_or(0.5) <= kSmallestPoissonRatio)) {
    why = "the bounds on Poisson's ratio leave nothing between " +
          NumberText(kSmallestPoissonRatio) + " and " +
          NumberText(kLargestPoissonRatio);
  }
  if (why.empty()) {
    why = WhyInvalidBounds(
        youngs_modulus, "Young's modulus", std::numeric_limits<double>::min(),
        std::numeric_limits<double>::max(), "positive and finite");
  }
  if (why.empty() && max_iterations < 1) {
    why = "the largest number of iterations is " +
          std::to_string(max_iterations) + "; it must be at least 1";
  }
  if (why.empty() && virtual_field_degree &&
      !(*virtual_field_degree >= 1 && *virtual_field_degree <= 3)) {
    why = "the degree of the virtual fields is " +
          std::to_string(*virtual_field_degree) + "; it must be 1, 2 or 3";
  }
  if (why.empty() && solver == SolverKind::kMultigrid && !HasMultigrid()) {
    why = "the solver is multigrid, which is not available (" +
          WhyNoMultigrid() + "); use cholesky";
  }
  return why;
}

std::string Estimator::WhyUnsupported(const Scene& scene,
                                      const EstimatorOptions& options) const {
  return elastimate::WhyUnsupported(WhatItTakes(), scene, options);
}

Estimate Estimator::Run(const Scene& scene,
                        const EstimatorOptions& options) const {
  Stopwatch stopwatch;
  ValidateScene(scene);
  CheckOptions(options);
  const std::vector<Finding> findings = CheckMeasurements(scene);
  CheckLoads(scene);
  CheckSupported(*this, scene, options);
  Estimate estimate = DoRun(scene, options);
  FinishEstimate(Name(), scene, options, findings, estimate);
  estimate.seconds = stopwatch.Lap();
  return estimate;
}

PreparedEstimator Estimator::Prepare(const Scene& scene,
                                     const EstimatorOptions& options) const& {
  return PreparedEstimator(*this, scene, options);
}

std::unique_ptr<Preparation> Estimator::DoPrepare(
    const Scene& /*scene*/, const EstimatorOptions& options) const {
  return std::make_unique<NoPreparation>(
      [this, &options](const Scene& scene) { return DoRun(scene, options); });
}

}  // namespace elastimate
