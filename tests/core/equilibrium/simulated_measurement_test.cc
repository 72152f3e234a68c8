#include "elastimate/core/equilibrium/simulated_measurement.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "elastimate/core/scene/rigid_motion.h"
#include "tests/throws.h"

namespace elastimate {
namespace {

/// Returns `n` points of the square or cube of edge 10.  They are twice as
/// dense on one half as on the other, since correlated noise must not depend on
/// that.
Eigen::MatrixXd UnevenPositions(int dimension, Eigen::Index n) {
  std::mt19937_64 generator(5);
  std::uniform_real_distribution<double> unit(0, 1);
  Eigen::MatrixXd positions(dimension, n);
  for (Eigen::Index point = 0; point < n; ++point) {
    for (int i = 0; i < dimension; ++i) {
      positions(i, point) = 10 * unit(generator);
    }
    if (point % 3 == 0) {
      positions(0, point) /= 2;
    }
  }
  return positions;
}

class NoiseAtPositions : public ::testing::TestWithParam<int> {};

TEST_P(NoiseAtPositions, IsIndependentWithoutALength) {
  constexpr Eigen::Index kPoints = 20000;
  std::mt19937_64 generator(1);
  const Eigen::MatrixXd noise =
      DrawNoiseAt(Eigen::MatrixXd::Zero(GetParam(), kPoints), 3, 0, generator);
  ASSERT_EQ(noise.rows(), GetParam());
  ASSERT_EQ(noise.cols(), kPoints);
  const double n = double(noise.size());
  // Each estimate is within four of its standard deviations, which are 1 /
  // sqrt(n) for the mean, sqrt(2 / n) for the variance and 1 / sqrt(points) for
  // a correlation.
  EXPECT_LT(std::abs(noise.mean()), 4 * 3 / std::sqrt(n));
  EXPECT_NEAR(noise.squaredNorm() / n / 9, 1, 4 * std::sqrt(2 / n));
  EXPECT_LT(std::abs(noise.row(0).dot(noise.row(1))) / 9 / kPoints,
            4 / std::sqrt(double(kPoints)));
  EXPECT_LT(std::abs(noise.leftCols(kPoints - 1)
                         .cwiseProduct(noise.rightCols(kPoints - 1))
                         .mean()) /
                9,
            4 / std::sqrt(n));
}

// Many independent draws are averaged, so that the estimates of a variance and
// of the correlation of two points have the errors of independent samples.
TEST_P(NoiseAtPositions, HasItsCorrelationWhereverThePointsAre) {
  constexpr double kLength = 1.5;
  constexpr int kDraws = 1500;
  const Eigen::Index n = 12;
  const Eigen::MatrixXd positions = UnevenPositions(GetParam(), n);
  Eigen::MatrixXd products = Eigen::MatrixXd::Zero(n, n);
  Eigen::MatrixXd across = Eigen::MatrixXd::Zero(n, n);
  std::mt19937_64 generator(2);
  for (int draw = 0; draw < kDraws; ++draw) {
    const Eigen::MatrixXd noise =
        DrawNoiseAt(positions, 0.2, kLength, generator) / 0.2;
    products += noise.row(0).transpose() * noise.row(0) / kDraws;
    across += noise.row(0).transpose() * noise.row(1) / kDraws;
  }
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) {
      const double distance = (positions.col(i) - positions.col(j)).norm();
      const double expected =
          std::exp(-distance * distance / (2 * kLength * kLength));
      // The variance of a product of two normal numbers is 1 + rho^2.
      const double sd = std::sqrt((1 + expected * expected) / kDraws);
      EXPECT_NEAR(products(i, j), expected, 4.5 * sd) << i << " " << j;
      EXPECT_NEAR(across(i, j), 0, 4.5 / std::sqrt(double(kDraws)));
    }
  }
}

// Points at the same place must get the same noise, and the same seed must draw
// it again.
TEST_P(NoiseAtPositions, IsTheSameForPointsThatAreTheSame) {
  Eigen::MatrixXd positions = UnevenPositions(GetParam(), 40);
  positions.col(7) = positions.col(30);
  positions.col(8) = positions.col(31).array() + 1e-7;
  std::mt19937_64 generator(3);
  const Eigen::MatrixXd noise = DrawNoiseAt(positions, 1, 2, generator);
  EXPECT_EQ(noise.col(7), noise.col(30));
  EXPECT_LT((noise.col(8) - noise.col(31)).norm(), 1e-5);
  std::mt19937_64 again(3);
  EXPECT_EQ(DrawNoiseAt(positions, 1, 2, again), noise);
}

INSTANTIATE_TEST_SUITE_P(Dimensions, NoiseAtPositions, ::testing::Values(2, 3));

TEST(SmoothNoise, IsRefusedWhereItsLengthIsFarTooShort) {
  const Eigen::MatrixXd positions = UnevenPositions(2, 30);
  std::mt19937_64 generator(1);
  EXPECT_THROWS_WITH(DrawNoiseAt(positions, 1, 1e-4, generator),
                     "^correlation_length=0.0001 is too short");
  EXPECT_THROWS_WITH(DrawNoiseAt(positions, 1, 1e-300, generator),
                     "^correlation_length=1e-300 is too short");
  // Over a length far beyond the specimen, all points have the same noise.
  const Eigen::MatrixXd noise = DrawNoiseAt(positions, 1, 1e8, generator);
  EXPECT_LT((noise.colwise() - noise.col(0)).cwiseAbs().maxCoeff(), 1e-6);
}

TEST(Outliers, AreAsManyAndAsLargeAsAskedFor) {
  std::vector<Eigen::Index> candidates;
  for (Eigen::Index point = 0; point < 500; ++point) {
    candidates.push_back(2 * point);
  }
  std::mt19937_64 generator(1);
  const Eigen::MatrixXd errors =
      DrawOutliers(candidates, 0.1, 0.01, 2, 1000, generator);
  const Eigen::ArrayXd sizes =
      errors.colwise().norm().transpose().array() / 0.01;
  EXPECT_EQ((sizes != 0).count(), 50);
  Eigen::ArrayXd drawn(50);
  Eigen::Index next = 0;
  Eigen::Vector2d mean_direction = Eigen::Vector2d::Zero();
  for (Eigen::Index point = 0; point < 1000; ++point) {
    if (sizes(point) != 0) {
      EXPECT_EQ(point % 2, 0);
      drawn(next++) = sizes(point);
      mean_direction += errors.col(point).normalized() / 50;
    }
  }
  EXPECT_GE(drawn.minCoeff(), 20);
  EXPECT_LE(drawn.maxCoeff(), 100);
  // The outliers are uniform on 20 to 100, with a standard deviation of 80 /
  // sqrt(12).
  EXPECT_NEAR(drawn.mean(), 60, 4 * 80 / std::sqrt(12.0 * 50));
  EXPECT_LT(mean_direction.norm(), 4 / std::sqrt(50.0));
}

class Errors : public ::testing::Test {
 protected:
  Errors() { held_.leftCols(50).row(0).setConstant(true); }

  /// Returns what is added to a displacement all of whose components are 2.
  Eigen::MatrixXd Added(const MeasurementErrors& errors) const {
    std::mt19937_64 generator(9);
    const Eigen::MatrixXd exact = Eigen::MatrixXd::Constant(2, 400, 2);
    Eigen::MatrixXd displacement = exact;
    AddErrors(errors, positions_, held_, generator, displacement);
    return displacement - exact;
  }

  Eigen::MatrixXd positions_ = UnevenPositions(2, 400);
  ComponentMask held_ = ComponentMask::Constant(2, 400, false);
};

TEST_F(Errors, AreNoneByDefault) { EXPECT_TRUE(Added({}).isZero(0)); }

TEST_F(Errors, OfNoiseLeaveOutWhatIsHeld) {
  MeasurementErrors absolute;
  absolute.noise_sd = 0.1;
  MeasurementErrors smooth = absolute;
  smooth.correlation_length = 3;
  MeasurementErrors relative;
  relative.relative_noise = 0.05;
  for (const MeasurementErrors& errors : {absolute, smooth, relative}) {
    const Eigen::MatrixXd noise = Added(errors);
    EXPECT_TRUE(((noise.array() == 0) == held_).all());
  }
  // The displacement has 750 free components of 2.
  EXPECT_NEAR(Added(relative).norm(), 0.05 * 2 * std::sqrt(750.0), 1e-12);
  EXPECT_NEAR(Added(absolute).squaredNorm() / 750 / 0.01, 1,
              4 * std::sqrt(2 / 750.0));
}

TEST_F(Errors, OfOutliersAreOnTopOfTheSameNoise) {
  MeasurementErrors errors;
  for (const bool is_relative : {false, true}) {
    errors.noise_sd = is_relative ? 0 : 0.1;
    errors.relative_noise = is_relative ? 0.05 : 0;
    errors.outliers = 0;
    const Eigen::MatrixXd noise = Added(errors);
    errors.outliers = 0.2;
    const Eigen::ArrayXd sizes =
        (Added(errors) - noise).colwise().norm().transpose().array();
    // Noise of 0.05 relative to components of 2 has a standard deviation of
    // 0.1.
    EXPECT_EQ((sizes > 1e-9).count(), 70);
    EXPECT_EQ((sizes > 20 * 0.1 - 1e-9).count(), 70);
    EXPECT_EQ(sizes.head(50).abs().maxCoeff(), 0);
  }
}

TEST_F(Errors, OfARigidMotionMoveHeldPointsToo) {
  for (const double angle : {0.0, 0.01, 2.0}) {
    MeasurementErrors errors;
    errors.rigid_motion = Eigen::Vector3d(0.3, -0.2, angle);
    const Eigen::MatrixXd moved = Added(errors);
    for (Eigen::Index point = 0; point < 400; ++point) {
      // Every component of the displacement is 2.
      const double x = positions_(0, point) + 2;
      const double y = positions_(1, point) + 2;
      const Eigen::Vector2d expected(
          0.3 + std::cos(angle) * x - std::sin(angle) * y - x,
          -0.2 + std::sin(angle) * x + std::cos(angle) * y - y);
      EXPECT_LT((moved.col(point) - expected).norm(), 1e-13);
    }
  }
}

TEST_F(Errors, OfARigidMotionLeaveTheNoiseAsItIs) {
  MeasurementErrors errors;
  errors.relative_noise = 0.05;
  const Eigen::MatrixXd noise = Added(errors);
  errors.rigid_motion = Eigen::Vector3d(0.3, -0.2, 1);
  const Eigen::MatrixXd both = Added(errors);
  errors.relative_noise = 0;
  EXPECT_LT((both - Added(errors) - noise).norm(), 1e-12);
}

TEST(ErrorsInSpace, TurnAboutTheAxisOfTheRotation) {
  MeasurementErrors errors;
  errors.rigid_motion.resize(6);
  const Eigen::Vector3d position(4, 5, 6);
  const auto moved = [&]() -> Eigen::Vector3d {
    Eigen::MatrixXd displacement = Eigen::MatrixXd::Zero(3, 1);
    std::mt19937_64 generator(1);
    AddErrors(errors, position, ComponentMask::Constant(3, 1, true), generator,
              displacement);
    return displacement;
  };
  // A third of a turn about (1, 1, 1) takes x to y, y to z and z to x.
  const double third = 2 * M_PI / 3 / std::sqrt(3);
  errors.rigid_motion << 1, 2, 3, third, third, third;
  EXPECT_LT((moved() - Eigen::Vector3d(1 + 6 - 4, 2 + 4 - 5, 3 + 5 - 6)).norm(),
            1e-13);
  // A small turn gives (1, 2, 3) + (0.1, 0.2, 0.3) x (4, 5, 6), to first order.
  errors.rigid_motion << 1, 2, 3, 0.1e-6, 0.2e-6, 0.3e-6;
  EXPECT_LT(
      (moved() - Eigen::Vector3d(1 - 0.3e-6, 2 + 0.6e-6, 3 - 0.3e-6)).norm(),
      1e-11);
}

}  // namespace
}  // namespace elastimate
