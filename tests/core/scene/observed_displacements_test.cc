#include "elastimate/core/scene/observed_displacements.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/core/random_values.h"
#include "tests/element_kinds.h"
#include "tests/random_points.h"
#include "tests/scenes.h"
#include "tests/throws.h"

namespace elastimate {
namespace {

using testing::kNan;
using testing::RandomMatrix;

// A scene of points, of which two components were not measured, with standard
// deviations and displaced supports, and a second load case of nodes.
class ObservedPoints : public ::testing::TestWithParam<testing::KindOfSection> {
 protected:
  ObservedPoints() : scene_(testing::SceneOfKind(GetParam())) {
    testing::DisplaceSupports(scene_);
    const Eigen::Index num_nodes = scene_.mesh.NumNodes();
    const int dimension = scene_.mesh.Dimension();
    scene_.load_cases.resize(2, scene_.load_cases[0]);
    scene_.load_cases[0].displacement = RandomMatrix(dimension, num_nodes, 1);
    scene_.load_cases.pop_back();
    testing::MeasureAtPoints(40, 3, scene_);
    PointDisplacements& points = scene_.load_cases[0].points;
    points.displacement(0, 5) = points.displacement(1, 9) = kNan;
    points.noise_sd = RandomMatrix(dimension, 40, 4).array().abs() + 0.1;
    LoadCase nodes = scene_.load_cases[0];
    nodes.points = {};
    nodes.displacement = RandomMatrix(dimension, num_nodes, 5);
    nodes.noise_sd = 0.25;
    scene_.load_cases.push_back(nodes);
  }

  // A displacement that the supports allow.
  Eigen::MatrixXd Allowed(std::uint64_t seed) const {
    const Eigen::MatrixXd free =
        RandomMatrix(scene_.mesh.Dimension(), scene_.mesh.NumNodes(), seed);
    return scene_.supports.held.select(scene_.supports.displacement, free);
  }

  Scene scene_;
};

// Residuals are (N u - q) / s, whatever the part of the supports.
TEST_P(ObservedPoints, RowsAreWeightedShapeFunctions) {
  const ObservedDisplacements observed(scene_);
  Eigen::MatrixXd both(scene_.mesh.NumDofs(), 2);
  both << Allowed(7).reshaped(), Allowed(8).reshaped();
  const Eigen::VectorXd residual =
      (observed.Restrict(both) - observed.Measured()) * observed.Norm();
  const PointDisplacements& points = scene_.load_cases[0].points;
  const Eigen::MatrixXd at_points =
      Interpolate(scene_.mesh, points.points, Allowed(7));
  const Eigen::MatrixXd nodes =
      (Allowed(8) - scene_.load_cases[1].displacement) / 0.25;
  int count = 0;
  for (const ObservedDisplacements::Point& point : observed.Points()) {
    for (Eigen::Index row = point.first; row < point.first + point.count;
         ++row, ++count) {
      const int i = observed.Component(row);
      const Eigen::Index k = point.index - scene_.mesh.NumNodes();
      const double expected =
          point.load_case == 1 ? nodes(i, point.index)
                               : (at_points(i, k) - points.displacement(i, k)) /
                                     points.noise_sd(i, k);
      EXPECT_NEAR(residual(row), expected, 1e-11 * (1 + std::abs(expected)));
    }
  }
  EXPECT_EQ(count, observed.Size());
  const Eigen::Index of_nodes = observed.CaseStart(2) - observed.CaseStart(1);
  EXPECT_EQ(of_nodes, (!scene_.supports.held).count());
  EXPECT_EQ(observed.CaseStart(1), 40 * scene_.mesh.Dimension() - 2);
}

TEST_P(ObservedPoints, RemeasuredAreThoseOfTheOtherScene) {
  ObservedDisplacements observed(scene_);
  const double norm = observed.Norm();
  scene_.load_cases[0].points.displacement *= 1.5;
  scene_.load_cases[1].displacement *= -2;
  observed.Remeasure(scene_);
  const ObservedDisplacements expected(scene_);
  EXPECT_TRUE((observed.Measured() * norm)
                  .isApprox(expected.Measured() * expected.Norm(), 1e-12));
}

TEST_P(ObservedPoints, WeightsBoundTheRows) {
  const ObservedDisplacements observed(scene_);
  const Eigen::VectorXd weights = observed.BoundingWeights();
  for (int seed = 1; seed <= 20; ++seed) {
    const Eigen::VectorXd u = scene_.supports.held.reshaped().select(
        0, RandomMatrix(scene_.mesh.NumDofs(), 1, seed).col(0));
    for (Eigen::Index k = 0; k < 2; ++k) {
      EXPECT_LE(observed.RestrictToCase(k, u).norm(),
                weights.cwiseProduct(u).norm() * (1 + 1e-12));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, ObservedPoints,
                         ::testing::ValuesIn(testing::AllKindsOfSections()),
                         testing::KindTestName);

// A point on a held node says nothing.
TEST(ObservedPointsOfSupports, HaveNoRows) {
  Scene scene = testing::SmallScene("cuboid");
  Eigen::Index held = 0;
  while (!scene.supports.held.col(held).all()) {
    ++held;
  }
  Eigen::Index element = 0;
  while (scene.mesh.elements(0, element) != held) {
    ++element;
  }
  scene.load_cases[0].displacement.resize(0, 0);
  PointDisplacements& points = scene.load_cases[0].points;
  points.points = {Eigen::VectorXi::Constant(2, int(element)),
                   Eigen::MatrixXd::Zero(3, 2)};
  points.points.local(0, 1) = points.points.local(1, 1) =
      points.points.local(2, 1) = 0.25;
  points.displacement.setOnes(3, 2);
  const ObservedDisplacements observed(scene);
  EXPECT_EQ(observed.Size(), 3);
  ASSERT_EQ(observed.Points().size(), 1U);
  EXPECT_EQ(observed.Points()[0].index, scene.mesh.NumNodes() + 1);
}

TEST(ObservedPointsOfSupports, AreRefusedWithWrongShapesAndNumbers) {
  Scene scene = testing::SmallScene("cuboid");
  scene.load_cases[0].displacement.setZero(3, scene.mesh.NumNodes());
  testing::MeasureAtPoints(5, 1, scene);
  EXPECT_NO_THROW(ValidateScene(scene));
  PointDisplacements& points = scene.load_cases[0].points;
  points.displacement(1, 3) = INFINITY;
  EXPECT_THROWS_WITH(ValidateScene(scene),
                     "of point 3 \\(y\\) in load case 1 "
                     "is infinite");
  points.displacement(1, 3) = 1;
  points.noise_sd.setOnes(3, 5);
  points.noise_sd(2, 4) = 0;
  EXPECT_THROWS_WITH(ValidateScene(scene),
                     "of point 4 \\(z\\) in load case 1 is 0; it must be");
  points.noise_sd.resize(3, 4);
  EXPECT_THROWS_WITH(ValidateScene(scene), "is 3 x 4; make it 3 x 5");
}

}  // namespace
}  // namespace elastimate
