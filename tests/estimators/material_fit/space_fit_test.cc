// Fits of one space of elements.

#include "elastimate/estimators/material_fit/space_fit.h"

#include <gtest/gtest.h>

#include <vector>

#include "elastimate/core/scene/finer_scene.h"
#include "elastimate/estimators/interface/stopwatch.h"
#include "tests/scenes.h"
#include "tests/shapes.h"

namespace elastimate {
namespace {

constexpr IsotropicElasticity kElasticityOfBar = {5e4, 0.1};

// A stretched bar of which a mask of nodes holds a part that ends within
// elements, so that nothing tells whether the middles of some edges are held.
class SupportEndsTest : public ::testing::Test {
 protected:
  SupportEndsTest() {
    linear_.mesh = testing::BoxMesh({4, 4, 16}, {1, 1, 4});
    linear_.supports.held =
        (linear_.mesh.nodes.row(2).array() <= 0.25).replicate(3, 1);
    linear_.supports.displacement.setZero(3, linear_.mesh.NumNodes());
    linear_.load_cases.resize(1);
    linear_.load_cases[0].loads = {BodyForce{Eigen::Vector3d(0, 0, 40)}};
  }

  // Returns the quadratic scene with the nodes in doubt held or not.
  Scene Quadratic(bool are_held) const {
    Scene quadratic = FinerScene(linear_);
    if (are_held) {
      for (const HeldComponent& open : quadratic.supports.in_doubt) {
        quadratic.supports.held(open.component, open.node) = true;
      }
    }
    return quadratic;
  }

  // Measures quadratic elements with the nodes in doubt held or not.
  void MeasureSpecimen(bool are_held) {
    Scene specimen = Quadratic(are_held);
    Measure(kElasticityOfBar, specimen);
    testing::TakeDisplacements(specimen, linear_);
    testing::AddNoise(0.01, 1, linear_);
  }

  Scene linear_;
  EstimatorOptions options_;
};

TEST_F(SupportEndsTest, ChangeOfHoldingThemIsThatOfTwoFits) {
  MeasureSpecimen(false);
  SpaceFit free(Quadratic(false), options_, {&linear_});
  free.Minimize(Descent::kReduced, {});
  ASSERT_TRUE(free.Fit().minimum);
  SpaceFit held(Quadratic(true), options_, {&linear_});
  held.Minimize(Descent::kReduced, {});
  ASSERT_TRUE(held.Fit().minimum);
  const std::vector<HeldComponent>& open = free.OwnScene().supports.in_doubt;
  ASSERT_FALSE(open.empty());
  Work work;
  const std::optional<Eigen::VectorXd> change =
      free.ChangeByHolding(open, work);
  const Eigen::VectorXd expected =
      held.Fit().minimum->variables - free.Fit().minimum->variables;
  ASSERT_TRUE(change) << expected.transpose() << ' ' << free.SquareSum() << ' '
                      << held.SquareSum();
  EXPECT_GT(expected.norm(), 1e-3);
  EXPECT_GT(work.element_passes, 2);
  EXPECT_LT((*change - expected).norm(), 0.1 * expected.norm());
}

TEST_F(SupportEndsTest, AreToBeFittedWhereHoldingThemExplainsMore) {
  MeasureSpecimen(true);
  SpaceFit free(Quadratic(false), options_, {&linear_});
  free.Minimize(Descent::kReduced, {});
  ASSERT_TRUE(free.Fit().minimum);
  Work work;
  EXPECT_FALSE(free.ChangeByHolding(free.OwnScene().supports.in_doubt, work));
}

TEST_F(SupportEndsTest, AreToBeFittedWhereSystemsAreSolvedByFactors) {
  MeasureSpecimen(false);
  SpaceFit free(Quadratic(false), options_);
  free.Minimize(Descent::kReduced, {});
  ASSERT_TRUE(free.Fit().minimum);
  Work work;
  EXPECT_FALSE(free.ChangeByHolding(free.OwnScene().supports.in_doubt, work));
}

// Nested spaces have no certificate, so a fit descends from values of nu across
// its range as well.
TEST_F(SupportEndsTest, StageOfTheFitHasTheTimeOfAllDescents) {
  MeasureSpecimen(false);
  SpaceFit fit(Quadratic(false), options_, {&linear_});
  Stopwatch stopwatch;
  fit.Minimize(Descent::kReduced, {});
  const double seconds = stopwatch.Lap();
  ASSERT_TRUE(fit.Fit().minimum);
  const std::vector<StageTime>& stages = fit.Fit().estimate.stages;
  ASSERT_EQ(stages.size(), 1);
  EXPECT_EQ(stages[0].stage, "fit");
  EXPECT_LE(stages[0].seconds, seconds);
  EXPECT_GE(stages[0].seconds, 0.9 * seconds);
}

TEST_F(SupportEndsTest, MinimumThatIsKeptIsEvaluatedAndFoundAgain) {
  MeasureSpecimen(false);
  SpaceFit fit(linear_, options_);
  fit.Minimize(Descent::kReduced, {});
  ASSERT_TRUE(fit.Fit().minimum);
  const Eigen::VectorXd minimum = fit.Fit().minimum->variables;
  const Eigen::VectorXd beside = minimum + Eigen::Vector2d(0.1, 0.05);
  Eigen::VectorXd before;
  ASSERT_TRUE(fit.Misfit().Evaluate(beside, &before, nullptr));
  fit.KeepMinimum();
  Eigen::VectorXd after;
  const int factorizations = fit.Misfit().Model().WorkDone().factorizations;
  ASSERT_TRUE(fit.Misfit().Evaluate(minimum, &after, nullptr));
  ASSERT_TRUE(fit.Misfit().Evaluate(beside, &after, nullptr));
  EXPECT_EQ(fit.Misfit().Model().WorkDone().factorizations, factorizations);
  EXPECT_TRUE(after.isApprox(before, 1e-9));
  fit.Minimize(Descent::kReduced, {});
  ASSERT_TRUE(fit.Fit().minimum);
  EXPECT_TRUE(fit.Fit().minimum->variables.isApprox(minimum, 1e-6));
}

}  // namespace
}  // namespace elastimate
