#include "elastimate/core/scene/scene_builder.h"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "elastimate/core/equilibrium/simulated_measurement.h"
#include "elastimate/core/package/version.h"
#include "elastimate/core/scene/loads.h"
#include "elastimate/core/scene/quadratic_scene.h"
#include "tests/throws.h"

namespace elastimate {
namespace {

// Two cubes of edge 1 on top of each other.
const std::vector<double> kCoordinates = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0,
                                          0, 0, 1, 1, 0, 1, 1, 1, 1, 0, 1, 1,
                                          0, 0, 2, 1, 0, 2, 1, 1, 2, 0, 1, 2};
const std::vector<int> kConnectivity = {0, 1, 2, 3, 4, 5, 6,  7,
                                        4, 5, 6, 7, 8, 9, 10, 11};

Mesh TwoCubes() {
  return MakeMesh(ElementKind::kHex8, kCoordinates.data(), 12,
                  kConnectivity.data(), 2);
}

const Eigen::Vector3d kOrigin(0, 0, 0);
const Eigen::Vector3d kEndOfBottom(1, 1, 0);
const Eigen::Vector3d kStartOfTop(0, 0, 2);
const Eigen::Vector3d kEndOfTop(1, 1, 2);

TEST(SceneBuilder, TakesAMeshFromArrays) {
  const Mesh mesh = TwoCubes();
  EXPECT_EQ(mesh.nodes.col(6), Eigen::Vector3d(1, 1, 1));
  EXPECT_EQ(mesh.elements(7, 1), 11);
  const std::vector<double> triangle = {0, 0, 1, 0, 0, 1};
  const std::vector<int> nodes = {0, 1, 2};
  const Mesh planar =
      MakeMesh(ElementKind::kTri3, triangle.data(), 3, nodes.data(), 1);
  EXPECT_EQ(planar.section.model, SectionModel::kPlaneStrain);
  EXPECT_EQ(planar.nodes.col(1), Eigen::Vector2d(1, 0));
}

TEST(SceneBuilder, RefusesAMeshThatIsNone) {
  EXPECT_THROWS_WITH(
      MakeMesh(ElementKind::kHex8, nullptr, 12, kConnectivity.data(), 2),
      "null pointer");
  EXPECT_THROWS_WITH(MakeMesh(ElementKind::kHex8, kCoordinates.data(), 12,
                              kConnectivity.data(), 0),
                     "12 nodes and 0 elements");
  EXPECT_THROWS_WITH(MakeMesh(ElementKind::kHex8, kCoordinates.data(), 11,
                              kConnectivity.data(), 2),
                     "11");
}

// A column that cannot widen, under a pressure p of its top: u_z = -p z / M at
// the height z, M = E (1 - nu) / ((1 + nu) (1 - 2 nu)).
TEST(SceneBuilder, MakesAColumnOfTheTextbook) {
  Scene scene = UnsupportedScene(TwoCubes());
  HoldInBox(kOrigin, kEndOfBottom, scene);
  const double infinity = std::numeric_limits<double>::infinity();
  HoldInBox(
      Eigen::Vector3d::Constant(-infinity), Eigen::Vector3d::Constant(infinity),
      Eigen::Array3<bool>(true, true, false), Eigen::Vector3d::Zero(), scene);
  LoadCase load_case;
  load_case.loads = {TractionInBox(scene.mesh, kStartOfTop, kEndOfTop,
                                   Eigen::Vector3d(0, 0, -30))};
  scene.load_cases = {load_case};
  EXPECT_NEAR(AssembleLoadCases(scene).sum(), -30, 1e-12);
  Measure({1000, 0.25}, scene);
  EXPECT_NEAR(scene.load_cases[0].displacement(2, 10), -30 * 2 / 1200.0, 1e-12);
}

TEST(SceneBuilder, HoldsTheNodesThatFinerElementsAdd) {
  const std::vector<double> coordinates = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
  const std::vector<int> nodes = {0, 1, 2, 3};
  Scene scene = UnsupportedScene(
      MakeMesh(ElementKind::kTet4, coordinates.data(), 4, nodes.data(), 1));
  HoldInBox(kOrigin, kEndOfBottom, scene);
  scene.load_cases.resize(1);
  EXPECT_EQ(QuadraticScene(scene).supports.held.row(0).count(), 6);
}

TEST(SceneBuilder, RefusesABoxThatIsNone) {
  Scene scene = UnsupportedScene(TwoCubes());
  const Eigen::Vector3d lower(5, 5, 5);
  const Eigen::Vector3d upper(6, 6, 6);
  EXPECT_THROWS_WITH(HoldInBox(lower, upper, scene),
                     "from .5, 5, 5. to .6, 6, 6. holds no node; the nodes lie "
                     "between .0, 0, 0. and .1, 1, 2.");
  EXPECT_THROWS_WITH(TractionInBox(scene.mesh, lower, upper, kEndOfTop),
                     "no whole facet");
  EXPECT_EQ(FacetsInBox(scene.mesh, lower, upper).cols(), 0);
  EXPECT_THROWS_WITH(HoldInBox(kEndOfTop, kOrigin, scene),
                     "lower corner that is below");
  EXPECT_THROWS_WITH(
      HoldInBox(Eigen::Vector2d(0, 0), Eigen::Vector2d(1, 1), scene),
      "has 2 components; give 3");
  EXPECT_THROWS_WITH(
      TractionInBox(scene.mesh, kStartOfTop, kEndOfTop, Eigen::Vector2d(0, -1)),
      "the traction has 2 components");
  EXPECT_FALSE(scene.supports.held.any());
}

TEST(SceneBuilder, RefusesToHoldANodeTwice) {
  Scene scene = UnsupportedScene(TwoCubes());
  HoldInBox(kOrigin, kEndOfBottom, scene);
  HoldInBox(kOrigin, kEndOfBottom, scene);
  EXPECT_THROWS_WITH(
      HoldInBox(kOrigin, kEndOfBottom, Eigen::Array3<bool>(false, false, true),
                Eigen::Vector3d(0, 0, 0.1), scene),
      "holds the z component of node 0, which another support holds "
      "differently");
  EXPECT_EQ(scene.supports.boxes.size(), 2U);
  EXPECT_THROWS_WITH(
      HoldInBox(kOrigin, kEndOfBottom, Eigen::Array3<bool>(false, false, false),
                Eigen::Vector3d::Zero(), scene),
      "holds no component");
}

TEST(Version, IsThatOfTheHeaders) { EXPECT_EQ(Version(), "0.1.0"); }

}  // namespace
}  // namespace elastimate
