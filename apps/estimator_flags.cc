#include "apps/estimator_flags.h"

#include <optional>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "apps/flags.h"
#include "elastimate/core/text/numbers.h"
#include "elastimate/io/scene/origin.h"

namespace elastimate {
namespace {

std::optional<double> Given(const std::string& flag, double value) {
  return IsGiven(flag) ? std::optional<double>(value) : std::nullopt;
}

void Require(bool condition, const std::string& flag, const std::string& rule) {
  if (!condition) {
    throw std::invalid_argument(AsGiven(flag) + "; " + rule);
  }
}

void RequireInOrder(const std::string& flag, const Bounds& bounds) {
  if (bounds.lower && bounds.upper && !(*bounds.lower < *bounds.upper)) {
    throw std::invalid_argument(AsGiven(flag + "_min") + " is not below " +
                                AsGiven(flag + "_max") +
                                "; give bounds with room between them");
  }
}

void CheckPoissonRatioFlags(const EstimatorOptions& options) {
  if (options.known_poisson_ratio) {
    CheckPoissonRatioFlag();
    if (options.poisson_ratio.AreGiven()) {
      const std::string bound =
          options.poisson_ratio.lower ? "nu_min" : "nu_max";
      throw std::invalid_argument(
          AsGiven("nu") + " says that Poisson's ratio is known, and " +
          AsGiven(bound) + " bounds it; give only one of them");
    }
  }
  const std::optional<double>& lower = options.poisson_ratio.lower;
  const std::optional<double>& upper = options.poisson_ratio.upper;
  Require(!lower || (*lower >= -1 && *lower < kLargestPoissonRatio), "nu_min",
          "it must be from -1 to below " + NumberText(kLargestPoissonRatio));
  Require(
      !upper || (*upper > kSmallestPoissonRatio && *upper <= 0.5), "nu_max",
      "it must be from above " + NumberText(kSmallestPoissonRatio) + " to 0.5");
  RequireInOrder("nu", options.poisson_ratio);
}

void CheckYoungsModulusFlags(const Bounds& bounds) {
  Require(!bounds.lower || *bounds.lower > 0, "youngs_min",
          "it must be positive");
  Require(!bounds.upper || *bounds.upper > 0, "youngs_max",
          "it must be positive");
  RequireInOrder("youngs", bounds);
}

Loss LossFromFlag() {
  Require(
      FLAGS_loss == "none" || FLAGS_loss == "huber" || FLAGS_loss == "cauchy",
      "loss", "it must be none, huber or cauchy");
  return FLAGS_loss == "huber"    ? Loss::kHuber
         : FLAGS_loss == "cauchy" ? Loss::kCauchy
                                  : Loss::kNone;
}

Refine RefinementFromFlag() {
  Require(FLAGS_refine == "auto" || FLAGS_refine == "0" || FLAGS_refine == "1",
          "refine", "it must be 0, 1 or auto");
  return FLAGS_refine == "0"   ? Refine::kNever
         : FLAGS_refine == "1" ? Refine::kAlways
                               : Refine::kAutomatic;
}

Kinematics KinematicsFromFlag() {
  Require(FLAGS_kinematics == "small" || FLAGS_kinematics == "large" ||
              FLAGS_kinematics == "auto",
          "kinematics", "it must be small, large or auto");
  return FLAGS_kinematics == "small"   ? Kinematics::kSmall
         : FLAGS_kinematics == "large" ? Kinematics::kLarge
                                       : Kinematics::kAutomatic;
}

}  // namespace

std::optional<Origin> OriginFromFlag() {
  if (!IsGiven("origin")) {
    return std::nullopt;
  }
  const std::optional<Origin> origin = OriginOfName(FLAGS_origin);
  Require(origin.has_value(), "origin", "it must be measured or computed");
  return origin;
}

SolverKind SolverFromFlag() {
  Require(FLAGS_solver == "automatic" || FLAGS_solver == "cholesky" ||
              FLAGS_solver == "multigrid",
          "solver", "it must be automatic, cholesky or multigrid");
  // Multigrid is looked for only here, since looking for it loads it.
  if (FLAGS_solver == "multigrid") {
    Require(HasMultigrid(), "solver",
            "it is not available (" + WhyNoMultigrid() +
                "), so use --solver=cholesky");
  }
  return FLAGS_solver == "cholesky"    ? SolverKind::kCholesky
         : FLAGS_solver == "multigrid" ? SolverKind::kMultigrid
                                       : SolverKind::kAutomatic;
}

EstimatorOptions OptionsFromFlags() {
  EstimatorOptions options;
  options.known_poisson_ratio = Given("nu", FLAGS_nu);
  options.poisson_ratio = {Given("nu_min", FLAGS_nu_min),
                           Given("nu_max", FLAGS_nu_max)};
  options.youngs_modulus = {Given("youngs_min", FLAGS_youngs_min),
                            Given("youngs_max", FLAGS_youngs_max)};
  options.loss = LossFromFlag();
  options.refinement = RefinementFromFlag();
  options.kinematics = KinematicsFromFlag();
  options.solver = SolverFromFlag();
  if (IsGiven("degree")) {
    Require(FLAGS_degree >= 1 && FLAGS_degree <= 3, "degree",
            "it must be 1, 2 or 3");
    options.virtual_field_degree = FLAGS_degree;
  }
  CheckPoissonRatioFlags(options);
  CheckYoungsModulusFlags(options.youngs_modulus);
  return options;
}

void CheckPoissonRatioFlag() {
  Require(FLAGS_nu > -1 && FLAGS_nu < 0.5, "nu",
          "it must be above -1 and below 0.5");
}

std::string GivenOptionFlags() {
  std::string given;
  for (const std::string flag :
       {"nu", "nu_min", "nu_max", "youngs_min", "youngs_max", "loss", "refine",
        "kinematics", "degree"}) {
    if (IsGiven(flag)) {
      given += (given.empty() ? "" : " ") + AsGiven(flag);
    }
  }
  return given;
}

}  // namespace elastimate
