#include "benchmarks/trial.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>

#include "elastimate/core/equilibrium/simulated_measurement.h"
#include "elastimate/core/scene/degrees_of_freedom.h"

namespace elastimate {
namespace {

double FreeNorm(const LoadCase& load_case, const DegreesOfFreedom& dofs) {
  return dofs.Restrict(load_case.displacement.reshaped()).norm();
}

}  // namespace

double Trial::YoungsModulusError() const {
  return estimate.elasticity.youngs_modulus / truth.youngs_modulus - 1;
}

double Trial::PoissonRatioError() const {
  return estimate.elasticity.poisson_ratio - truth.poisson_ratio;
}

bool IsWrong(const Trial& trial) {
  const Estimate& estimate = trial.estimate;
  const double youngs_modulus = std::max(
      kWrongYoungsModulus,
      kWrongStandardErrors * estimate.YoungsModulusStandardError().value_or(0) /
          trial.truth.youngs_modulus);
  const double poisson_ratio = std::max(
      kWrongPoissonRatio,
      kWrongStandardErrors * estimate.PoissonRatioStandardError().value_or(0));
  const double nu = trial.truth.poisson_ratio;
  const std::optional<Interval>& interval = estimate.poisson_ratio_interval;
  const bool is_in_interval =
      interval && interval->lower <= nu && nu <= interval->upper;
  return std::abs(trial.YoungsModulusError()) > youngs_modulus ||
         (std::abs(trial.PoissonRatioError()) > poisson_ratio &&
          !is_in_interval);
}

std::vector<std::string> TrialColumns() {
  return {"estimator",
          "seed",
          "status",
          "youngs_modulus_error [1]",
          "poisson_ratio_error [1]",
          "youngs_modulus_standard_error [1]",
          "poisson_ratio_standard_error [1]",
          "discretization_error [1]",
          "poisson_ratio_discretization_error [1]",
          "youngs_modulus_cramer_rao [1]",
          "poisson_ratio_cramer_rao [1]",
          "true_poisson_ratio [1]",
          "time [s]",
          "factorizations [1]"};
}

std::vector<Value> TrialCells(const Trial& trial) {
  const Estimate& estimate = trial.estimate;
  const double youngs_modulus = trial.truth.youngs_modulus;
  return {
      estimate.estimator,
      trial.seed,
      std::string(StatusName(estimate.status)),
      trial.YoungsModulusError(),
      trial.PoissonRatioError(),
      estimate.YoungsModulusStandardError().value_or(Estimate::kUnknown) /
          youngs_modulus,
      estimate.PoissonRatioStandardError().value_or(Estimate::kUnknown),
      estimate.discretization_error.value_or(Estimate::kUnknown),
      estimate.poisson_ratio_discretization_error.value_or(Estimate::kUnknown),
      std::sqrt(trial.cramer_rao(0, 0)) / youngs_modulus,
      std::sqrt(trial.cramer_rao(1, 1)),
      trial.truth.poisson_ratio,
      estimate.seconds,
      std::int64_t{estimate.work.factorizations}};
}

std::string ChosenRung(const Estimate& estimate) {
  std::string chosen;
  for (const Rung& rung : estimate.rungs) {
    if (rung.status && rung.element_order == estimate.element_order) {
      chosen = rung.estimator + " order " + std::to_string(rung.element_order);
    }
  }
  return chosen;
}

Eigen::VectorXd NoiseSd(const Scene& scene, double deviation) {
  const DegreesOfFreedom dofs(scene.supports);
  Eigen::VectorXd noise_sd(Eigen::Index(scene.load_cases.size()));
  for (Eigen::Index k = 0; k < noise_sd.size(); ++k) {
    noise_sd(k) = deviation * FreeNorm(scene.load_cases[k], dofs) /
                  std::sqrt(static_cast<double>(dofs.NumFree()));
  }
  return noise_sd;
}

Scene WithNoise(Scene scene, double deviation, std::uint64_t seed) {
  const DegreesOfFreedom dofs(scene.supports);
  std::mt19937_64 generator(seed);
  for (LoadCase& load_case : scene.load_cases) {
    const double norm = deviation * FreeNorm(load_case, dofs);
    load_case.displacement.reshaped() += dofs.Extend(
        DrawNoise(NoiseLaw::kUniform, dofs.NumFree(), norm, generator));
  }
  return scene;
}

}  // namespace elastimate
