#include "elastimate/io/points/point_locator.h"

#include <gtest/gtest.h>

#include <cmath>

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

// Returns a quarter of a ring of radii 1 and 2 in two curved triangles.
Mesh QuarterOfRing() {
  const double angles[3] = {0, M_PI / 4, M_PI / 2};
  Mesh mesh;
  mesh.kind = ElementKind::kCurvedTri6;
  mesh.section.model = SectionModel::kPlaneStress;
  mesh.nodes.resize(2, 9);
  const auto at = [&](double radius, int k) -> Eigen::Vector2d {
    return radius * Eigen::Vector2d(std::cos(angles[k]), std::sin(angles[k]));
  };
  mesh.nodes << at(1, 0), at(2, 0), at(2, 2), at(1, 2), at(1.5, 0), at(2, 1),
      at(1.5, 2), at(1, 1), at(1.5, 1);
  mesh.elements.resize(6, 2);
  mesh.elements.transpose() << 0, 1, 2, 4, 5, 8,  //
      0, 2, 3, 8, 6, 7;
  ValidateMesh(mesh);
  return mesh;
}

// The points lie outside and inside of the arcs at their nodes, where the
// elements touch the circles, beside a straight edge, and within the ring.
TEST(LocatedPoints, OutsideOfCurvedElementsAreTheNearestOfTheirEdges) {
  const Mesh mesh = QuarterOfRing();
  const Eigen::Vector2d middle(std::sqrt(0.5), std::sqrt(0.5));
  Eigen::MatrixXd positions(2, 4);
  positions << 2.4 * middle, 0.7 * middle, Eigen::Vector2d(1.5, -0.2),
      1.99 * middle;
  const LocatedPoints located = PointLocator(mesh).Locate(positions);
  EXPECT_NEAR(located.distance(0), 0.4, 1e-12);
  EXPECT_NEAR(located.distance(1), 0.3, 1e-12);
  EXPECT_NEAR(located.distance(2), 0.2, 1e-3);
  EXPECT_EQ(located.distance(3), 0);
  const Eigen::MatrixXd found = Interpolate(mesh, located.points, mesh.nodes);
  EXPECT_TRUE(found.col(0).isApprox(2 * middle, 1e-9));
  EXPECT_TRUE(found.col(1).isApprox(middle, 1e-9));
  EXPECT_TRUE(found.col(3).isApprox(1.99 * middle, 1e-9));
}

// Files may number mid-edge nodes before vertices, and have a node of no
// element.
TEST(LocatedPoints, AreFoundWhateverTheOrderOfNodes) {
  Mesh mesh = QuarterOfRing();
  mesh.elements = 9 - mesh.elements.array();
  mesh.nodes.conservativeResize(2, 10);
  mesh.nodes.col(9).setZero();
  mesh.nodes = mesh.nodes.rowwise().reverse().eval();
  const Eigen::Vector2d x(0.3, 1.4);
  const LocatedPoints located = PointLocator(mesh).Locate(x);
  EXPECT_EQ(located.distance(0), 0);
  EXPECT_TRUE(Interpolate(mesh, located.points, mesh.nodes).isApprox(x, 1e-9));
}

// The nearest point has to be as near as the nearest of 4000 points of the
// outline.
TEST(LocatedPoints, OutsideOfCurvedElementsHaveNoNearerOnes) {
  const Mesh mesh = QuarterOfRing();
  constexpr int kSteps = 4000;
  MeshPoints outer = {Eigen::VectorXi::Zero(kSteps + 1),
                      Eigen::MatrixXd(2, kSteps + 1)};
  for (int i = 0; i <= kSteps; ++i) {  // From node 1 to node 2.
    const double t = double(i) / kSteps;
    outer.local.col(i) << 1 - t, t;
  }
  const Eigen::MatrixXd arc = Interpolate(mesh, outer, mesh.nodes);
  Eigen::MatrixXd positions(2, 30);
  for (int i = 0; i < 30; ++i) {
    const double angle = 0.05 + 1.4 * i / 30;
    positions.col(i) << 2.3 * std::cos(angle), 2.3 * std::sin(angle);
  }
  const LocatedPoints located = PointLocator(mesh).Locate(positions);
  for (int i = 0; i < 30; ++i) {
    EXPECT_NEAR(located.distance(i),
                (arc.colwise() - positions.col(i)).colwise().norm().minCoeff(),
                1e-6);
  }
}

}  // namespace
}  // namespace elastimate
