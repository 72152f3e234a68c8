#include "elastimate/core/scene/camera.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "tests/scenes.h"

namespace elastimate {
namespace {

constexpr double kRadians = M_PI / 180;

Eigen::Matrix3d TurnBy(double degrees, const Eigen::Vector3d& axis) {
  return Eigen::AngleAxisd(degrees * kRadians, axis.normalized())
      .toRotationMatrix();
}

// Returns a bar that is held where z = 0, stretched by `strain` along z, and
// seen by a camera that turned and moved.
Scene SeenBar(const Eigen::Matrix3d& rotation, double strain) {
  const Mesh mesh = testing::BoxMesh({2, 2, 16}, {1, 1, 8});
  Scene scene = testing::HeldAtBottom(mesh, mesh, {1, 0, 0});
  const Eigen::Vector3d stretch(1 - 0.3 * strain, 1 - 0.3 * strain, 1 + strain);
  scene.load_cases[0].displacement =
      ((rotation * stretch.asDiagonal() * mesh.nodes).colwise() +
       Eigen::Vector3d(3, -4, 5)) -
      mesh.nodes;
  scene.load_cases[0].observed.setConstant(3, mesh.NumNodes(), true);
  scene.is_rigid_motion_free = true;
  return scene;
}

Camera TurnOf(const Scene& scene) {
  return TurnOfCamera(scene, scene.load_cases[0]);
}

TEST(TurnOfCamera, IsFoundThroughAStrain) {
  for (const double degrees : {0, 5, 30, 120, 175}) {
    const Eigen::Matrix3d rotation = TurnBy(degrees, {1, -2, 2});
    const Camera camera = TurnOf(SeenBar(rotation, 0.05));
    EXPECT_LT((camera.rotation - rotation).norm(), 1e-9) << degrees;
    EXPECT_NEAR(camera.Angle(), degrees * kRadians, 1e-9);
    const Eigen::Vector3d middle(0.5, 0.5, 4);
    EXPECT_LT((camera.Seen(middle) - middle).norm(), 1e-9);
  }
}

TEST(TurnOfCamera, IsFoundOfWhicheverComponentsWereObserved) {
  for (const double degrees : {30, 120}) {
    const Eigen::Matrix3d rotation = TurnBy(degrees, {1, 2, -1});
    Scene scene = SeenBar(rotation, 0);
    ComponentMask& observed = scene.load_cases[0].observed;
    for (Eigen::Index node = 0; node < observed.cols(); ++node) {
      observed(node % 3, node) = false;
    }
    EXPECT_LT((TurnOf(scene).rotation - rotation).norm(), 1e-9) << degrees;
    observed.setConstant(true);
    observed.row(1).setConstant(false);
    EXPECT_LT((TurnOf(scene).rotation - rotation).norm(), 1e-9) << degrees;
  }
}

// One component tells where its own axis was before, and nothing of a turn
// about that.
TEST(TurnOfCamera, IsTheLeastThatOneComponentTells) {
  Scene scene = SeenBar(TurnBy(25, {0, 1, 0}), 0);
  ComponentMask& observed = scene.load_cases[0].observed;
  observed.topRows(2).setConstant(false);
  EXPECT_LT((TurnOf(scene).rotation - TurnBy(25, {0, 1, 0})).norm(), 1e-5);
}

TEST(TurnOfCamera, IsOneForNodesAndPoints) {
  const Eigen::Matrix3d rotation = TurnBy(40, {1, 0, 0});
  Scene scene = SeenBar(rotation, 0.01);
  LoadCase& load_case = scene.load_cases[0];
  std::mt19937_64 generator(1);
  load_case.points.points = DrawPoints(scene.mesh, 20, generator);
  load_case.points.displacement =
      Interpolate(scene.mesh, load_case.points.points, load_case.displacement);
  load_case.points.displacement(0, 3) = testing::kNan;
  // The missing component lets the strain turn it a little.
  EXPECT_LT((TurnOf(scene).rotation - rotation).norm(), 5e-3);
  load_case.displacement.resize(0, 0);
  load_case.observed.resize(0, 0);
  EXPECT_LT((TurnOf(scene).rotation - rotation).norm(), 5e-3);
}

TEST(TurnOfCamera, IsNoneWhereNothingWasMeasured) {
  Scene scene = SeenBar(TurnBy(40, {1, 0, 0}), 0);
  scene.load_cases[0].displacement.resize(0, 0);
  scene.load_cases[0].observed.resize(0, 0);
  EXPECT_EQ(TurnOf(scene).Angle(), 0);
}

}  // namespace
}  // namespace elastimate
