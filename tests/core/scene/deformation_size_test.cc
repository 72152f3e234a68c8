#include "elastimate/core/scene/deformation_size.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>

#include "tests/scenes.h"

namespace elastimate {
namespace {

constexpr double kDegree = M_PI / 180;

using Field = std::function<Eigen::Vector3d(const Eigen::Vector3d&)>;

// Returns a body that is held where z = 0 and displaced by `field`.
Scene BodyMovedBy(const Field& field, const Mesh& mesh) {
  Scene scene = testing::HeldAtBottom(mesh, mesh, {1, 0, 0});
  LoadCase& load_case = scene.load_cases[0];
  load_case.displacement.resize(3, mesh.NumNodes());
  for (Eigen::Index node = 0; node < mesh.NumNodes(); ++node) {
    load_case.displacement.col(node) = field(mesh.nodes.col(node));
  }
  return scene;
}

// Returns a bar of 1 x 1 x 8.
Scene BarMovedBy(const Field& field) {
  return BodyMovedBy(field, testing::BoxMesh({2, 2, 16}, {1, 1, 8}));
}

Eigen::Vector3d Stretched(const Eigen::Vector3d& x) {
  return Eigen::Vector3d(-0.015, -0.015, 0.05).cwiseProduct(x);
}

TEST(DeformationSize, OfAStretchIsItsStrain) {
  const DeformationSize size = MeasureDeformation(BarMovedBy(Stretched));
  EXPECT_NEAR(size.strain, 0.05, 1e-9);
  EXPECT_NEAR(size.rotation, 0, 1e-6);
  EXPECT_NEAR(size.volume_change, 1.05 * 0.985 * 0.985, 1e-9);
}

TEST(DeformationSize, OfAVolumeCountsGrowthAndShrinkage) {
  for (const double stretch : {0.5, 2.0, -0.5}) {
    const DeformationSize size =
        MeasureDeformation(BarMovedBy([&](const Eigen::Vector3d& x) {
          return Eigen::Vector3d(0, 0, (stretch - 1) * x(2));
        }));
    if (stretch < 0) {
      EXPECT_TRUE(std::isinf(size.volume_change));
    } else {
      EXPECT_NEAR(size.volume_change, 2, 1e-9);
    }
  }
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

// Points in a face show that the face turns, and not that the bar beneath turns
// with it.
TEST(DeformationSize, OfPlacesInAPlaneTakesItsNormalToTurnWithIt) {
  const double curvature = 20 * kDegree / 8;
  Scene scene = BarMovedBy([&](const Eigen::Vector3d& x) {
    const double angle = curvature * x(2);
    const double radius = 1 / curvature - (x(0) - 0.5);
    return Eigen::Vector3d(
        0.5 + 1 / curvature - radius * std::cos(angle) - x(0), 0,
        radius * std::sin(angle) - x(2));
  });
  scene.load_cases[0].observed =
      (scene.mesh.nodes.row(0).array() < 1e-9).replicate(3, 1);
  const DeformationSize size = MeasureDeformation(scene);
  EXPECT_NEAR(size.strain, curvature / 2, 0.1 * curvature);
  EXPECT_NEAR(size.rotation, 0.95 * 20 * kDegree, 1 * kDegree);
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

// The noise is larger than the strip is thick times its strain.
TEST(DeformationSize, IsNotMadeByNoiseAcrossAThinStrip) {
  const Mesh strip = testing::BoxMesh({1, 4, 20}, {0.01, 2, 10});
  for (unsigned seed = 1; seed <= 20; ++seed) {
    Scene scene = BodyMovedBy(
        [](const Eigen::Vector3d& x) {
          return Eigen::Vector3d(Stretched(x) / 10);
        },
        strip);
    testing::AddNoise(0.01, seed, scene);
    const DeformationSize size = MeasureDeformation(scene);
    EXPECT_NEAR(size.strain, 0.005, 5e-4);
    EXPECT_LT(size.rotation, 1 * kDegree);
  }
}

TEST(DeformationSize, OfAThinLayerIsItsStrainAcross) {
  Scene scene = BodyMovedBy(
      [](const Eigen::Vector3d& x) {
        return Eigen::Vector3d(0, 0, -0.1 * x(2));
      },
      testing::BoxMesh({10, 10, 1}, {10, 10, 0.05}));
  testing::AddNoise(0.01, 1, scene);
  EXPECT_NEAR(MeasureDeformation(scene).strain, 0.1, 0.01);
}

TEST(DeformationSize, IsNotMadeByGrossErrorsOfPoints) {
  Scene scene = BarMovedBy([](const Eigen::Vector3d& x) {
    return Eigen::Vector3d(Stretched(x) / 50);
  });
  testing::AddNoise(0.02, 1, scene);
  for (const double error : {0.3, 10.0, 1e4}) {
    SCOPED_TRACE(error);
    Scene wrong = scene;
    Eigen::MatrixXd& displacement = wrong.load_cases[0].displacement;
    displacement.col(70) += Eigen::Vector3d(error, -error, error);
    EXPECT_LT(MeasureDeformation(wrong).strain, 3e-3);
    EXPECT_LT(MeasureDeformation(wrong).rotation, 1 * kDegree);
    // At a corner, beside another one, and a camera that lost points.
    displacement(2, 0) += error;
    displacement(0, 1) -= error;
    wrong.load_cases[0].observed.setConstant(3, wrong.mesh.NumNodes(), true);
    wrong.load_cases[0].observed.col(71).setConstant(false);
    EXPECT_LT(MeasureDeformation(wrong).strain, 3e-3);
    EXPECT_LT(MeasureDeformation(wrong).rotation, 1 * kDegree);
  }
}

// The bar stretches by 30 % over an eighth of its length, and nowhere else.
TEST(DeformationSize, IsThatOfALocalDeformation) {
  for (const double noise : {0.0, 0.01}) {
    Scene scene = BarMovedBy([](const Eigen::Vector3d& x) {
      return Eigen::Vector3d(0, 0, 0.3 * std::clamp(x(2) - 5.0, 0.0, 1.0));
    });
    testing::AddNoise(noise, 1, scene);
    EXPECT_GT(MeasureDeformation(scene).strain, 0.05) << noise;
  }
}

TEST(DeformationSize, IsThatOfTenPoints) {
  Scene scene = BarMovedBy(Stretched);
  testing::AddNoise(0.02, 1, scene);
  ComponentMask& observed = scene.load_cases[0].observed;
  observed.setConstant(3, scene.mesh.NumNodes(), false);
  for (Eigen::Index i = 0; i < 10; ++i) {
    observed.col(i * scene.mesh.NumNodes() / 10).setConstant(true);
  }
  EXPECT_NEAR(MeasureDeformation(scene).strain, 0.05, 0.01);
}

TEST(DeformationSize, IsUnknownOfFewPoints) {
  Scene scene = BarMovedBy(Stretched);
  LoadCase& load_case = scene.load_cases[0];
  load_case.observed.setConstant(3, scene.mesh.NumNodes(), false);
  load_case.observed.leftCols(3).setConstant(true);
  EXPECT_EQ(MeasureDeformation(scene).strain, 0);
}

TEST(DeformationSize, DoesNotCountTheTurnOfACamera) {
  for (const double degrees : {5, 30, 120}) {
    const Eigen::Matrix3d rotation =
        Eigen::AngleAxisd(degrees * kDegree,
                          Eigen::Vector3d(1, -2, 2).normalized())
            .toRotationMatrix();
    Scene scene = BarMovedBy([&](const Eigen::Vector3d& x) {
      return Eigen::Vector3d(rotation * (x + Stretched(x)) - x);
    });
    scene.is_rigid_motion_free = true;
    const DeformationSize size = MeasureDeformation(scene);
    EXPECT_NEAR(size.rotation, 0, 1e-6);
    EXPECT_NEAR(size.strain, 0.05, 1e-9);
  }
}

}  // namespace
}  // namespace elastimate
