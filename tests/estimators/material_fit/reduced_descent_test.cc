// reduced-fe of several materials against iterative-fe, on scenes that are hard
// for it.

#include "elastimate/estimators/material_fit/reduced_descent.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "elastimate/core/equilibrium/simulated_measurement.h"
#include "elastimate/estimators/registry.h"
#include "tests/scenes.h"

namespace elastimate {
namespace {

struct HardScene {
  std::string name;
  std::vector<double> parameters;  ///< E and nu of each region.
  double noise;
  /// How far the regions are from those of the fit.
  double shift = 0;
  bool has_surface_only = false;
  /// The width of region 1, of a block of the width 1.
  double width = 0.5;
};

// Regions 1 and 2 side by side below, 3 and 4 above.
void SetRegions(double width, double shift, Mesh& mesh) {
  mesh.regions.resize(mesh.NumElements());
  for (Eigen::Index e = 0; e < mesh.NumElements(); ++e) {
    const Eigen::Vector3d centre =
        mesh.nodes(Eigen::all, mesh.elements.col(e)).rowwise().mean();
    const bool is_above = centre(2) + shift > 1;
    mesh.regions(e) = 1 + (centre(0) > width + shift) + 2 * (is_above ? 1 : 0);
  }
}

Scene SceneOf(const HardScene& hard, std::uint64_t seed) {
  const Mesh mesh = testing::BoxMesh({4, 4, 8}, {1, 1, 2});
  Scene scene = testing::HeldAtBottom(mesh, mesh, {1, 2, 5});
  Scene truth = scene;
  SetRegions(hard.width, 0, scene.mesh);
  SetRegions(hard.width, hard.shift, truth.mesh);
  scene.materials = IsotropicMaterialOfEachRegion(scene.mesh);
  truth.materials = scene.materials;
  MeasureMaterials(
      Eigen::Map<const Eigen::VectorXd>(hard.parameters.data(),
                                        Eigen::Index(hard.parameters.size())),
      truth);
  scene.load_cases = truth.load_cases;
  scene.origin = Origin::kComputed;
  if (hard.noise > 0) {
    testing::AddNoise(hard.noise, seed, scene);
  }
  if (hard.has_surface_only) {
    ComponentMask& observed = scene.load_cases[0].observed;
    observed.setConstant(3, mesh.NumNodes(), false);
    for (Eigen::Index node = 0; node < mesh.NumNodes(); ++node) {
      if ((mesh.nodes.col(node).head(2).array() - 0.5).abs().maxCoeff() >
          0.499) {
        observed.col(node).setConstant(true);
      }
    }
  }
  return scene;
}

class ReducedDescentStatistics : public ::testing::TestWithParam<HardScene> {};

TEST_P(ReducedDescentStatistics, FindsTheMinimumOfTheFullModel) {
  for (const std::uint64_t seed : {1, 2}) {
    const Scene scene = SceneOf(GetParam(), seed);
    const Estimate reduced = MakeEstimator("reduced-fe")->Run(scene, {});
    const Estimate full = MakeEstimator("iterative-fe")->Run(scene, {});
    EXPECT_EQ(reduced.status, full.status) << reduced.message;
    EXPECT_LT(reduced.work.factorizations, full.work.factorizations);
    ASSERT_TRUE(reduced.displacement_residual.has_value());
    EXPECT_NEAR(*reduced.displacement_residual / *full.displacement_residual, 1,
                1e-5);
    if (!full.IsUsable()) {
      continue;
    }
    ASSERT_TRUE(reduced.IsUsable()) << reduced.message;
    for (std::size_t i = 0; i < full.parameters.size(); ++i) {
      const ParameterEstimate& expected = full.parameters[i];
      ASSERT_TRUE(expected.standard_error.has_value());
      EXPECT_NEAR(reduced.parameters[i].value, expected.value,
                  0.1 * *expected.standard_error)
          << expected.Label() << " of seed " << seed;
      EXPECT_NEAR(
          *reduced.parameters[i].standard_error / *expected.standard_error, 1,
          0.02)
          << expected.Label() << " of seed " << seed;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    Hard, ReducedDescentStatistics,
    ::testing::Values(
        HardScene{"plain", {1e3, 0.2, 3e3, 0.35, 2e3, 0.3, 1.5e3, 0.25}, 0.01},
        HardScene{"contrast", {1e3, 0.2, 1e7, 0.35, 1e5, 0.3, 1e4, 0.25}, 0.01},
        HardScene{"incompressible",
                  {1e3, 0.2, 3e3, 0.4995, 2e3, 0.3, 1.5e3, 0.25},
                  0.01},
        HardScene{"noisy", {1e3, 0.2, 3e3, 0.35, 2e3, 0.3, 1.5e3, 0.25}, 0.05},
        HardScene{"wrong_regions",
                  {1e3, 0.2, 3e3, 0.35, 2e3, 0.3, 1.5e3, 0.25},
                  0.01,
                  0.2},
        HardScene{"surface",
                  {1e3, 0.2, 3e3, 0.35, 2e3, 0.3, 1.5e3, 0.25},
                  0.01,
                  0,
                  true},
        // Regions of the width of a cell, which hold little of the energy.
        HardScene{"thin",
                  {5e2, 0.2, 3e3, 0.35, 2e1, 0.3, 1.5e3, 0.25},
                  0.01,
                  0,
                  false,
                  0.25}),
    [](const auto& info) { return info.param.name; });

TEST(ReducedDescent, SaysWhatIsNotCertified) {
  const Scene scene = SceneOf(
      {"contrast", {1e3, 0.2, 1e7, 0.35, 1e5, 0.3, 1e4, 0.25}, 0.01}, 1);
  EstimatorOptions options;
  options.max_iterations = 1;
  const Estimate estimate = MakeEstimator("reduced-fe")->Run(scene, options);
  EXPECT_EQ(estimate.status, Status::kIterationLimit) << estimate.message;
  EXPECT_TRUE(estimate.Has(FindingCode::kFitNotCertified));
  const Estimate climbed = MakeEstimator("auto")->Run(scene, options);
  ASSERT_EQ(climbed.rungs.size(), 3U);
  EXPECT_EQ(climbed.rungs[1].estimator, "reduced-fe");
  EXPECT_EQ(climbed.rungs[1].status, Status::kIterationLimit);
  EXPECT_EQ(climbed.rungs[2].estimator, "iterative-fe");
}

// What is known of a part is far from the rest, as of steel beside a tissue.
TEST(ReducedDescent, StartsFarFromAKnownModulus) {
  for (const double known : {1.0, 2e11}) {
    Scene scene = SceneOf(
        {"known", {known, 0.3, 1e3, 0.3, 2e3, 0.3, 1.5e3, 0.3}, 0.01}, 1);
    scene.materials[0].known = {{"youngs_modulus", known},
                                {"poisson_ratio", 0.3}};
    const Estimate estimate = MakeEstimator("reduced-fe")->Run(scene, {});
    ASSERT_TRUE(estimate.IsUsable()) << estimate.message;
    for (const auto& [index, truth] :
         {std::pair(2, 1e3), std::pair(4, 2e3), std::pair(6, 1.5e3)}) {
      const ParameterEstimate& modulus = estimate.parameters[index];
      EXPECT_NEAR(modulus.value, truth, 4 * *modulus.standard_error);
    }
  }
}

TEST(ReducedDescent, IsWhereAutoStops) {
  const Scene scene =
      SceneOf({"plain", {1e3, 0.2, 3e3, 0.35, 2e3, 0.3, 1.5e3, 0.25}, 0.01}, 1);
  const Estimate climbed = MakeEstimator("auto")->Run(scene, {});
  ASSERT_EQ(climbed.rungs.size(), 2U);
  EXPECT_EQ(climbed.rungs[1].estimator, "reduced-fe");
  const Estimate fit = MakeEstimator("reduced-fe")->Run(scene, {});
  for (std::size_t i = 0; i < fit.parameters.size(); ++i) {
    EXPECT_EQ(climbed.parameters[i].value, fit.parameters[i].value);
  }
}

TEST(ReducedDescent, StartsFromTheLastFitOfASeries) {
  const HardScene hard = {
      "series", {1e3, 0.2, 3e3, 0.35, 2e3, 0.3, 1.5e3, 0.25}, 0.01};
  const Scene scene = SceneOf(hard, 1);
  const auto estimator = MakeEstimator("reduced-fe");
  PreparedEstimator prepared = estimator->Prepare(scene, {});
  const Estimate first = prepared.Run({scene.load_cases[0].displacement});
  const Eigen::MatrixXd other = SceneOf(hard, 2).load_cases[0].displacement;
  const Estimate second = prepared.Run({other});
  ASSERT_TRUE(second.IsUsable()) << second.message;
  EXPECT_LT(second.work.factorizations, first.work.factorizations);
  const Estimate alone = estimator->Run(SceneOf(hard, 2), {});
  for (std::size_t i = 0; i < alone.parameters.size(); ++i) {
    EXPECT_NEAR(second.parameters[i].value, alone.parameters[i].value,
                0.1 * *alone.parameters[i].standard_error);
  }
}

}  // namespace
}  // namespace elastimate
