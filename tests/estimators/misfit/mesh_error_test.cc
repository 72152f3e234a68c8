#include "elastimate/estimators/misfit/mesh_error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/scenes.h"

namespace elastimate {
namespace {

// A change of two fits of one material, of six displacements and a resultant.
class MeshErrorTest : public ::testing::Test {
 protected:
  MeshErrorTest() {
    std::mt19937_64 generator(7);
    std::normal_distribution<double> normal;
    sensitivities_ =
        Eigen::MatrixXd::NullaryExpr(7, 2, [&] { return normal(generator); });
    change_.rows = Eigen::VectorXd::NullaryExpr(
        7, [&] { return 0.01 * normal(generator); });
    inverse_ = (sensitivities_.transpose() * sensitivities_).inverse();
  }

  MeshError Run(const EstimatorOptions& options = {}) const {
    return MeshErrorOf(change_, FreeParameters(scene_, options), sensitivities_,
                       inverse_, kNumDisplacements);
  }

  // G diag(||du||^2, dR^2) G^T.
  Eigen::MatrixXd OfRows() const {
    Eigen::VectorXd variances = change_.rows.cwiseAbs2();
    const double square_sum = variances.head(kNumDisplacements).sum();
    variances.head(kNumDisplacements).setConstant(square_sum);
    const Eigen::MatrixXd g = inverse_ * sensitivities_.transpose();
    return g * variances.asDiagonal() * g.transpose();
  }

  static constexpr Eigen::Index kNumDisplacements = 6;
  Scene scene_ = testing::SmallScene("cuboid");
  SpaceChange change_ = {Eigen::Vector2d(0.04, -0.02), {}};
  Eigen::MatrixXd sensitivities_;
  Eigen::MatrixXd inverse_;
};

TEST_F(MeshErrorTest, IsAPartOfTheChangeToTheDividedMesh) {
  change_.is_of_quadratic = true;
  const MeshError error = Run();
  const Eigen::Vector2d d = change_.variables;
  EXPECT_LT((error.correction - d / 2).norm(), 1e-15);
  const Eigen::Matrix2d expected =
      d * d.transpose() / 4 + 0.075 * 0.075 * OfRows();
  EXPECT_LT((error.covariance - expected).norm(), 1e-12 * expected.norm());
}

TEST_F(MeshErrorTest, IsSmallerWherePoissonsRatioIsGiven) {
  change_.is_of_quadratic = true;
  change_.variables = Eigen::VectorXd::Constant(1, 0.04);
  sensitivities_ = sensitivities_.leftCols(1).eval();
  inverse_ = (sensitivities_.transpose() * sensitivities_).inverse();
  Material material;
  material.known.push_back({"poisson_ratio", 0.3});
  scene_.materials = {material};
  const MeshError error = Run();
  EXPECT_NEAR(error.correction(0), 0.35 * 0.04, 1e-15);
  EXPECT_NEAR(error.covariance(0, 0), std::pow(0.35 * 0.04, 2), 1e-15);
}

// Linear elements may have nu right by accident.
TEST_F(MeshErrorTest, OfTheSameMeshTakesNoRatioForMuchBetterThanItsModulus) {
  change_.variables = Eigen::Vector2d(0.3, 0.001);
  const MeshError error = Run();
  EXPECT_EQ(error.correction, Eigen::Vector2d(0, 0));
  const Eigen::Vector2d d(0.3, 0.2 * 0.3);
  const Eigen::Matrix2d expected =
      d * d.transpose() / 4 + 0.03 * 0.03 * OfRows();
  EXPECT_LT((error.covariance - expected).norm(), 1e-12 * expected.norm());
}

TEST_F(MeshErrorTest, IsHalfOfWhatIsNotableWhereTheMeshIsKeptForItsSize) {
  change_.variables = Eigen::Vector2d(1e-5, 1e-6);
  change_.rows *= 1e-6;
  change_.is_kept_for_its_size = true;
  const MeshError error = Run();
  EXPECT_NEAR(std::sqrt(error.covariance(0, 0)), 0.005, 1e-6);
  EXPECT_NEAR(std::sqrt(error.covariance(1, 1)), 0.005, 1e-6);
}

TEST_F(MeshErrorTest, HoldsHalfOfTheWayToOtherSupportEnds) {
  change_.is_of_quadratic = true;
  const MeshError without = Run();
  const Eigen::Vector2d half(0.01, 0.03);
  change_.by_supports = half;
  const MeshError error = Run();
  EXPECT_LT((error.correction - without.correction - half).norm(), 1e-15);
  const Eigen::Matrix2d of_supports = half * half.transpose();
  EXPECT_LT((error.of_supports - of_supports).norm(), 1e-15);
  EXPECT_LT((error.covariance - without.covariance - of_supports).norm(),
            1e-15);
}

}  // namespace
}  // namespace elastimate
