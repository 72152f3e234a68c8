#include "elastimate/estimators/force_balance/virtual_fields.h"

#include <gtest/gtest.h>

#include <iostream>

#include "elastimate/estimators/force_balance/bounded.h"
#include "elastimate/estimators/force_balance/closed_form.h"
#include "tests/element_kinds.h"
#include "tests/scenes.h"

namespace elastimate {
namespace {

using testing::Measure;
using testing::SmallScene;

TEST(VirtualFields, SayThatABoundContradictsTheData) {
  Scene scene = SmallScene("cuboid");
  Measure({1e3, 0.3}, scene);
  for (const Bounds& bounds :
       {Bounds{std::nullopt, 5.0}, Bounds{2e3, std::nullopt}}) {
    EstimatorOptions options;
    options.youngs_modulus = bounds;
    const Estimate estimate = VirtualFields().Run(scene, options);
    EXPECT_EQ(estimate.status, Status::kNotIdentifiable);
    EXPECT_TRUE(estimate.IsRefusedFor(FindingCode::kParametersOnBounds))
        << estimate.message;
    EXPECT_FALSE(Bounded().Run(scene, options).IsUsable());
  }
}

TEST(VirtualFields, KeepABoundThatTheDataAllow) {
  Scene scene = SmallScene("cuboid");
  Measure({1e3, 0.3}, scene);
  testing::AddNoise(0.02, 1, scene);
  EstimatorOptions options;
  options.youngs_modulus.upper = 999;
  const Estimate estimate = VirtualFields().Run(scene, options);
  EXPECT_TRUE(estimate.IsUsable()) << estimate.message;
}

// The loads have the right size, but act along the wrong axes.
TEST(VirtualFields, DenyLoadsOfAnotherDirection) {
  Scene scene = SmallScene("organ");
  Measure({1e3, 0.3}, scene);
  testing::AddNoise(0.01, 1, scene);
  Eigen::MatrixXd& force =
      std::get<NodalForces>(scene.load_cases[0].loads[0]).force;
  const Eigen::MatrixXd permuted = force({1, 2, 0}, Eigen::all);
  force = permuted;
  EXPECT_FALSE(VirtualFields().Run(scene, {}).IsUsable());
  EXPECT_FALSE(ClosedForm().Run(scene, {}).IsUsable());
  EstimatorOptions known;
  known.known_poisson_ratio = 0.3;
  EXPECT_FALSE(ClosedForm().Run(scene, known).IsUsable());
}

// Any nu fits pure shear, so the nu that the noise prefers tells nothing.
TEST(VirtualFieldsStatistics, DoNotTakeNoiseForInformation) {
  const double mu = 5e4 / 2.6;
  for (const Bounds& bounds : {Bounds{}, Bounds{1.2 * mu, 2.8 * mu},
                               Bounds{{}, mu}, Bounds{2.9 * mu, {}}}) {
    EstimatorOptions options;
    options.youngs_modulus = bounds;
    for (const double noise : {1e-6, 1e-4, 1e-2}) {
      constexpr int kSeeds = 20;
      int num_usable = 0;
      for (int seed = 1; seed <= kSeeds; ++seed) {
        Scene scene = testing::ShearedBlock();
        testing::AddNoise(noise, seed, scene);
        num_usable += VirtualFields().Run(scene, options).IsUsable() ? 1 : 0;
      }
      std::cout << "noise " << noise << ", seeds 1 to " << kSeeds << ": "
                << num_usable << " usable\n";
      // A 95 % interval allows one usable run in twenty.  Chance makes more
      // than 4 of 20 in one of 400 experiments.
      EXPECT_LE(num_usable, 4);
    }
  }
}

// The noise is estimated from four equations.  Two standard errors hold the
// truth in 88 % of the cases, but Student's t does in 95 %.  The share of 200
// trials has a standard deviation of 1.5 %.
TEST(VirtualFieldsStatistics, IntervalsOfFewEquationsCoverTheTruth) {
  constexpr int kSeeds = 200;
  Scene exact = testing::SceneOfKind(
      {ElementKind::kQuad4, SectionModel::kPlaneStress}, 4);
  const IsotropicElasticity truth = {5e3, 0.3};
  Measure(truth, exact);
  EstimatorOptions options;
  options.virtual_field_degree = 1;
  int covering = 0;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    Scene scene = exact;
    testing::AddNoise(1e-3, seed, scene);
    const Estimate estimate = VirtualFields().Run(scene, options);
    ASSERT_TRUE(estimate.IsUsable()) << estimate.message;
    EXPECT_LE(*estimate.noise_degrees_of_freedom, 4);
    const Interval& interval = *estimate.parameters[0].interval;
    covering += interval.lower <= truth.youngs_modulus &&
                truth.youngs_modulus <= interval.upper;
  }
  EXPECT_NEAR(double(covering) / kSeeds, 0.95, 4 * 0.0154);
}

}  // namespace
}  // namespace elastimate
