#include "elastimate/organ/organ_shape.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>

namespace elastimate {
namespace {

TEST(OrganShapeTest, BallPointInvertsOrganPoint) {
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector3d point(std::sin(1.0 + i), std::sin(2.0 * i),
                                std::sin(3.0 * i));
    EXPECT_TRUE(BallPoint(OrganPoint(point)).isApprox(point, 1e-13)) << i;
  }
}

}  // namespace
}  // namespace elastimate
