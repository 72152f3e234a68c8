// The load that a plan chose is measured many times.  The estimates must
// scatter as the plan said.

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "elastimate/core/equilibrium/simulated_measurement.h"
#include "elastimate/core/scene/loads.h"
#include "elastimate/estimators/plan/load_plan.h"
#include "elastimate/estimators/plan/unit_loads.h"
#include "elastimate/estimators/registry.h"
#include "tests/regions.h"
#include "tests/scenes.h"

namespace elastimate {
namespace {

constexpr int kPlannedMeasurements = 100;
// chi^2 of 100 degrees of freedom, over 100, is outside with a probability of
// 1e-4 on either side.
constexpr double kLeastMeanSquare = 0.556;
constexpr double kMostMeanSquare = 1.615;

// Returns the scene with one more load case: the best of the unit loads on its
// loaded surface, at the size that the plan gives.
Scene WithBestLoad(const Scene& scene, const Eigen::VectorXd& parameters,
                   double relative_noise, Eigen::VectorXd& expected) {
  const std::vector<CandidateLoad> candidates =
      UnitCandidates(scene, LoadedFacets(scene));
  const LoadPlan plan =
      PlanLoads(scene, candidates, parameters, relative_noise);
  const PlannedLoad& best = plan.loads[0];
  expected = best.errors.OfParameters();
  Scene both = scene;
  both.load_cases.push_back(candidates[best.candidate].load_case);
  for (Load& load : both.load_cases.back().loads) {
    load = Scaled(load, best.factor.value());
  }
  return both;
}

// Returns the mean squares of the standard scores of each parameter, for
// estimates by maximum likelihood.
Eigen::VectorXd MeanSquareScores(Scene scene, const Eigen::VectorXd& parameters,
                                 double noise,
                                 const Eigen::VectorXd& expected) {
  MeasureMaterials(parameters, scene);
  const std::vector<LoadCase> exact = scene.load_cases;
  std::mt19937_64 generator(11);
  std::normal_distribution<double> normal(0, noise);
  const auto estimator = MakeEstimator("iterative-fe");
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(expected.size());
  for (int i = 0; i < kPlannedMeasurements; ++i) {
    for (std::size_t k = 0; k < scene.load_cases.size(); ++k) {
      LoadCase& load_case = scene.load_cases[k];
      load_case.noise_sd = noise;
      load_case.displacement = exact[k].displacement;
      for (Eigen::Index j = 0; j < load_case.displacement.size(); ++j) {
        load_case.displacement.data()[j] +=
            scene.supports.held.data()[j] ? 0 : normal(generator);
      }
    }
    const Estimate estimate = estimator->Run(scene, {});
    for (Eigen::Index p = 0; p < expected.size(); ++p) {
      const ParameterEstimate& parameter = estimate.parameters[std::size_t(p)];
      const double error = parameter.is_modulus
                               ? std::log(parameter.value / parameters(p))
                               : parameter.value - parameters(p);
      squares(p) += std::pow(error / expected(p), 2) / kPlannedMeasurements;
    }
  }
  return squares;
}

void ExpectTrueErrors(Scene scene, const Eigen::VectorXd& parameters) {
  constexpr double kRelativeNoise = 0.01;
  MeasureMaterials(parameters, scene);
  const double noise = kRelativeNoise *
                       scene.load_cases[0].displacement.norm() /
                       std::sqrt(double((!scene.supports.held).count()));
  scene.load_cases[0].noise_sd = noise;
  Eigen::VectorXd expected;
  const Scene both = WithBestLoad(scene, parameters, kRelativeNoise, expected);
  const Eigen::VectorXd squares =
      MeanSquareScores(both, parameters, noise, expected);
  for (const double square : squares) {
    EXPECT_GT(square, kLeastMeanSquare) << squares.transpose();
    EXPECT_LT(square, kMostMeanSquare) << squares.transpose();
  }
}

TEST(LoadPlanStatistics, ErrorsAreThoseOfOneMaterial) {
  ExpectTrueErrors(testing::SmallScene("cuboid"), Eigen::Vector2d(5e4, 0.3));
}

TEST(LoadPlanStatistics, ErrorsAreThoseOfTwoMaterials) {
  Scene scene = testing::TwoRegionScene(
      {ElementKind::kQuad4, SectionModel::kPlaneStress}, 6);
  scene.load_cases.resize(1);
  ExpectTrueErrors(scene, Eigen::Vector4d(3e4, 0.3, 9e4, 0.2));
}

}  // namespace
}  // namespace elastimate
