#include "elastimate/core/scene/deformation_size.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <random>

#include "tests/scenes.h"

namespace elastimate {
namespace {

constexpr double kDegree = M_PI / 180;

using Field = std::function<Eigen::Vector3d(const Eigen::Vector3d&)>;

// Returns a bar of 1 x 1 x 8 that is held where z = 0 and displaced by `field`.
Scene BarMovedBy(const Field& field) {
  const Mesh mesh = testing::BoxMesh({2, 2, 16}, {1, 1, 8});
  Scene scene = testing::HeldAtBottom(mesh, mesh, {1, 0, 0});
  LoadCase& load_case = scene.load_cases[0];
  load_case.displacement.resize(3, mesh.NumNodes());
  for (Eigen::Index node = 0; node < mesh.NumNodes(); ++node) {
    load_case.displacement.col(node) = field(mesh.nodes.col(node));
  }
  return scene;
}

Eigen::Vector3d Stretched(const Eigen::Vector3d& x) {
  return Eigen::Vector3d(-0.015, -0.015, 0.05).cwiseProduct(x);
}

TEST(DeformationSize, OfAStretchIsItsStrain) {
  const DeformationSize size = MeasureDeformation(BarMovedBy(Stretched));
  EXPECT_NEAR(size.strain, 0.05, 1e-9);
  EXPECT_NEAR(size.rotation, 0, 1e-6);
}

// The bar is bent to a circular arc.  It turns by 20 degrees along its length,
// and stretches by the curvature times 1/2 at the surface.
TEST(DeformationSize, OfABentBarIsTheRotationOfItsEnd) {
  const double curvature = 20 * kDegree / 8;
  const DeformationSize size =
      MeasureDeformation(BarMovedBy([&](const Eigen::Vector3d& x) {
        const double angle = curvature * x(2);
        const double radius = 1 / curvature - (x(0) - 0.5);
        return Eigen::Vector3d(
            0.5 + 1 / curvature - radius * std::cos(angle) - x(0), 0,
            radius * std::sin(angle) - x(2));
      }));
  EXPECT_NEAR(size.rotation, 0.95 * 20 * kDegree, 1 * kDegree);
  EXPECT_LT(size.strain, curvature / 2);
  EXPECT_GT(size.strain, curvature / 4);
}

TEST(DeformationSize, IsNotMadeByNoise) {
  Scene scene = BarMovedBy([](const Eigen::Vector3d& x) {
    return Eigen::Vector3d(Stretched(x) / 50);
  });
  testing::AddNoise(0.1, 1, scene);
  const DeformationSize size = MeasureDeformation(scene);
  EXPECT_LT(size.strain, 3e-3);
  EXPECT_LT(size.rotation, 1 * kDegree);
}

TEST(DeformationSize, IsUnknownOfFewPoints) {
  Scene scene = BarMovedBy(Stretched);
  LoadCase& load_case = scene.load_cases[0];
  load_case.observed.setConstant(3, scene.mesh.NumNodes(), false);
  load_case.observed.leftCols(3).setConstant(true);
  EXPECT_EQ(MeasureDeformation(scene).strain, 0);
}

TEST(RemoveFreeRotation, LeavesTheStrain) {
  for (const double degrees : {5, 30, 120}) {
    const Eigen::Matrix3d rotation =
        Eigen::AngleAxisd(degrees * kDegree,
                          Eigen::Vector3d(1, -2, 2).normalized())
            .toRotationMatrix();
    Scene scene = BarMovedBy([&](const Eigen::Vector3d& x) {
      return Eigen::Vector3d(rotation * (x + Stretched(x)) +
                             Eigen::Vector3d(3, 4, 5) - x);
    });
    const Eigen::MatrixXd turned = scene.load_cases[0].displacement;
    RemoveFreeRotation(scene);
    EXPECT_EQ(scene.load_cases[0].displacement, turned) << "it is not free";
    scene.is_rigid_motion_free = true;
    EXPECT_NEAR(MeasureDeformation(scene).rotation, 0, 1e-6);
    RemoveFreeRotation(scene);
    const Eigen::MatrixXd& left = scene.load_cases[0].displacement;
    // A translation stays in the displacement; the fits eliminate it.
    for (Eigen::Index node = 0; node < left.cols(); ++node) {
      const Eigen::Vector3d x = scene.mesh.nodes.col(node);
      const Eigen::Vector3d first = scene.mesh.nodes.col(0);
      EXPECT_LT((left.col(node) - left.col(0) - Stretched(x - first)).norm(),
                1e-9)
          << degrees << ", node " << node;
    }
  }
}

// A turn that is no larger than the strains may be that of the specimen itself,
// so it stays.
TEST(RemoveFreeRotation, LeavesATurnThatIsLessThanTheStrains) {
  for (const double angle : {5e-5, 1e-3, 5e-3}) {
    Scene scene = BarMovedBy([&](const Eigen::Vector3d& x) {
      const Eigen::Vector3d turn(angle * x(2), 0, -angle * x(0));
      return Eigen::Vector3d(turn + Stretched(x) / 25);
    });
    scene.is_rigid_motion_free = true;
    const Eigen::MatrixXd measured = scene.load_cases[0].displacement;
    RemoveFreeRotation(scene);
    // The strain is 0.002.
    EXPECT_EQ(scene.load_cases[0].displacement == measured, angle < 2e-3);
  }
}

// Displacements of nodes and of points must be turned by the same rotation.
TEST(RemoveFreeRotation, IsOneForNodesAndPoints) {
  const Eigen::Matrix3d rotation =
      Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitX()).toRotationMatrix();
  Scene scene = BarMovedBy([&](const Eigen::Vector3d& x) {
    return Eigen::Vector3d(rotation * (x + Stretched(x)) - x);
  });
  scene.is_rigid_motion_free = true;
  LoadCase& load_case = scene.load_cases[0];
  std::mt19937_64 generator(1);
  PointDisplacements& points = load_case.points;
  points.points = DrawPoints(scene.mesh, 20, generator);
  points.displacement =
      Interpolate(scene.mesh, points.points, load_case.displacement);
  RemoveFreeRotation(scene);
  const Eigen::MatrixXd at_points =
      Interpolate(scene.mesh, points.points, load_case.displacement);
  EXPECT_LT((points.displacement - at_points).cwiseAbs().maxCoeff(), 1e-9);
  // A strain of 0.05 over half of the length moves the ends by 0.2.
  EXPECT_LT(load_case.displacement.cwiseAbs().maxCoeff(), 0.25);
}

}  // namespace
}  // namespace elastimate
