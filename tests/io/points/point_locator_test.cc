#include "elastimate/io/points/point_locator.h"

#include <gtest/gtest.h>

#include "tests/element_kinds.h"
#include "tests/random_points.h"
#include "tests/scenes.h"

namespace elastimate {
namespace {

using testing::RandomPoints;

class LocatedPointsOfKinds
    : public ::testing::TestWithParam<testing::KindOfSection> {};

TEST_P(LocatedPointsOfKinds, AreWhereTheyWere) {
  const Mesh mesh = testing::MeshOfKind(GetParam());
  const MeshPoints points = RandomPoints(mesh, 2000, 1);
  const Eigen::MatrixXd positions = Interpolate(mesh, points, mesh.nodes);
  const LocatedPoints located = PointLocator(mesh).Locate(positions);
  EXPECT_NO_THROW(ValidatePoints(mesh, located.points));
  EXPECT_LT(located.distance.maxCoeff(), 1e-12);
  EXPECT_TRUE(
      Interpolate(mesh, located.points, mesh.nodes).isApprox(positions, 1e-9));
}

TEST_P(LocatedPointsOfKinds, MayBeNodes) {
  const Mesh mesh = testing::MeshOfKind(GetParam());
  const LocatedPoints located = PointLocator(mesh).Locate(mesh.nodes);
  EXPECT_LT(located.distance.maxCoeff(), 1e-9);
  EXPECT_TRUE(
      Interpolate(mesh, located.points, mesh.nodes).isApprox(mesh.nodes, 1e-7));
}

INSTANTIATE_TEST_SUITE_P(Kinds, LocatedPointsOfKinds,
                         ::testing::ValuesIn(testing::AllKindsOfSections()),
                         [](const auto& info) {
                           return testing::NameOf(info.param);
                         });

TEST(LocatedPoints, OutsideAreTheNearestOfTheSurface) {
  const Mesh mesh = testing::BoxMesh({3, 3, 3}, {1, 2, 3});
  Eigen::MatrixXd positions(3, 3);
  positions.transpose() << 0.4, 0.7, 3.25, -0.3, -0.4, 1.5, 0.5, 1, 1.5;
  const LocatedPoints located = PointLocator(mesh).Locate(positions);
  EXPECT_NEAR(located.distance(0), 0.25, 1e-12);
  EXPECT_NEAR(located.distance(1), 0.5, 1e-12);
  EXPECT_EQ(located.distance(2), 0);
  Eigen::MatrixXd nearest(3, 3);
  nearest.transpose() << 0.4, 0.7, 3, 0, 0, 1.5, 0.5, 1, 1.5;
  EXPECT_TRUE(
      Interpolate(mesh, located.points, mesh.nodes).isApprox(nearest, 1e-9));
}

}  // namespace
}  // namespace elastimate
