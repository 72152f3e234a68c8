#include "elastimate/estimators/statistics/residual_statistics.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <random>

#include "elastimate/estimators/statistics/node_losses.h"
#include "tests/core/random_values.h"
#include "tests/scenes.h"

namespace elastimate {
namespace {

using testing::Measure;
using testing::SmallScene;

Scene ExactOrgan() {
  Scene scene = SmallScene("organ");
  Measure({5e4, 0.3}, scene);
  return scene;
}

TEST(CorrelateNeighbours, IsNearZeroForIndependentNoise) {
  constexpr int kSeeds = 100;
  const Scene scene = testing::WithThreeForces(ExactOrgan());
  Scene measured = scene;
  Measure({5e4, 0.3}, measured);
  const ObservedDisplacements observed(measured);
  std::mt19937_64 generator(1);
  std::normal_distribution<double> normal;
  double square_sum = 0;
  for (int seed = 0; seed < kSeeds; ++seed) {
    Eigen::VectorXd residual(observed.Size());
    for (double& value : residual) {
      value = normal(generator);
    }
    const auto found =
        CorrelateNeighbours(NodeGraph(measured.mesh), observed, residual);
    square_sum += std::pow(found->correlation / found->standard_deviation, 2);
  }
  // chi^2 of 100 degrees of freedom.
  EXPECT_NEAR(square_sum, kSeeds, 4 * std::sqrt(2.0 * kSeeds));
}

TEST(CorrelateNeighbours, IsNearOneForASmoothField) {
  const Scene scene = ExactOrgan();
  const ObservedDisplacements observed(scene);
  const auto constant = CorrelateNeighbours(
      NodeGraph(scene.mesh), observed, Eigen::VectorXd::Ones(observed.Size()));
  EXPECT_NEAR(constant->correlation, 1, 1e-12);
  EXPECT_GT(constant->correlation, 20 * constant->standard_deviation);
  const Eigen::MatrixXd linear = scene.mesh.nodes.reshaped();
  EXPECT_GT(CorrelateNeighbours(NodeGraph(scene.mesh), observed,
                                observed.Restrict(linear))
                ->correlation,
            0.5);
}

TEST(CorrelateNeighbours, KnowsOnlyObservedNeighbours) {
  Scene scene = ExactOrgan();
  ComponentMask& mask = scene.load_cases[0].observed;
  mask = ComponentMask::Constant(3, scene.mesh.NumNodes(), false);
  mask(2, scene.mesh.NumNodes() - 1) = true;
  const ObservedDisplacements observed(scene);
  ASSERT_EQ(observed.Size(), 1);
  EXPECT_FALSE(CorrelateNeighbours(NodeGraph(scene.mesh), observed,
                                   Eigen::VectorXd::Ones(1))
                   .has_value());
}

// A tenth of the components are far off: least squares follow them, the change
// leads back.
TEST(RobustChange, TakesBackWhatOutliersPull) {
  const ObservedDisplacements observed(ExactOrgan());
  const Eigen::MatrixXd s = testing::RandomMatrix(observed.Size(), 3, 1);
  const Eigen::Vector3d truth(0.1, -0.2, 0.3);
  Eigen::VectorXd residual = -s * truth;
  residual += 1e-3 * testing::RandomMatrix(observed.Size(), 1, 2);
  for (std::size_t i = 0; i < observed.Points().size(); i += 10) {
    residual.segment(observed.Points()[i].first, observed.Points()[i].count)
        .array() += 5;
  }
  EXPECT_TRUE(HasHeavyTails(residual));
  const Eigen::VectorXd least_squares =
      (s.transpose() * s).ldlt().solve(-s.transpose() * residual);
  EXPECT_GT((least_squares - truth).norm(), 0.05);
  EXPECT_LT((RobustChange(observed, residual, s) - truth).norm(), 1e-3);
}

}  // namespace
}  // namespace elastimate
