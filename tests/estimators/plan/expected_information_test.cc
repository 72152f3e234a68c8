#include "elastimate/estimators/plan/expected_information.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "elastimate/core/scene/degrees_of_freedom.h"
#include "tests/dense_reference.h"
#include "tests/scenes.h"

namespace elastimate {
namespace {

using testing::DenseFreeDisplacement;
using testing::SmallScene;

TEST(CramerRaoBound, IsTheInverseInformationOfFiniteDifferences) {
  Scene scene = testing::WithThreeForces(SmallScene("organ"));
  const Eigen::Vector3d noise_sd(1e-4, 2e-4, 5e-5);
  // The x components of the second load case are not observed.
  scene.load_cases[1].observed =
      ComponentMask::Constant(3, scene.mesh.NumNodes(), true);
  scene.load_cases[1].observed.row(0).setConstant(false);
  const std::vector<Eigen::Index> free = DegreesOfFreedom(scene.supports).free;
  const double step = 1e-4;
  Eigen::Matrix2d information = Eigen::Matrix2d::Zero();
  for (Eigen::Index k = 0; k < 3; ++k) {
    Eigen::MatrixXd s(Eigen::Index(free.size()), 2);
    s << (DenseFreeDisplacement(scene, {5e4 * (1 + step), 0.3}, k) -
          DenseFreeDisplacement(scene, {5e4 * (1 - step), 0.3}, k)) /
             (2 * step * 5e4),
        (DenseFreeDisplacement(scene, {5e4, 0.3 + step}, k) -
         DenseFreeDisplacement(scene, {5e4, 0.3 - step}, k)) /
            (2 * step);
    for (std::size_t i = 0; i < free.size(); ++i) {
      if (k != 1 || free[i] % 3 != 0) {
        information += s.row(Eigen::Index(i)).transpose() *
                       s.row(Eigen::Index(i)) / (noise_sd(k) * noise_sd(k));
      }
    }
  }
  const Eigen::Matrix2d expected = information.inverse();
  const Eigen::Matrix2d bound =
      CramerRaoBound(scene, Eigen::Vector2d(5e4, 0.3), noise_sd);
  EXPECT_NEAR(bound(0, 0) / expected(0, 0), 1, 1e-4);
  EXPECT_NEAR(bound(1, 1) / expected(1, 1), 1, 1e-4);
  EXPECT_NEAR(bound(0, 1) / expected(0, 1), 1, 1e-4);
}

TEST(CramerRaoBound, IsInfiniteWhereOneCombinationOnlyIsDetermined) {
  Scene scene = SmallScene("cuboid");
  scene.load_cases[0].observed =
      ComponentMask::Constant(3, scene.mesh.NumNodes(), false);
  scene.load_cases[0].observed(2, scene.mesh.NumNodes() - 1) = true;
  EXPECT_TRUE(std::isinf(CramerRaoBound(scene, Eigen::Vector2d(5e4, 0.3),
                                        Eigen::VectorXd::Ones(1))(0, 0)));
}

}  // namespace
}  // namespace elastimate
