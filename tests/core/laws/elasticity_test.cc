#include "elastimate/core/laws/elasticity.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace elastimate {
namespace {

// Steel, from a table: E = 210 GPa, nu = 0.3, G = 80.77 GPa, K = 175 GPa,
// lambda = 121.15 GPa.
TEST(IsotropicElasticity, AgreesWithTabulatedSteel) {
  const IsotropicElasticity steel{210, 0.3};
  EXPECT_NEAR(steel.ShearModulus(), 80.77, 0.005);
  EXPECT_NEAR(steel.BulkModulus(), 175.0, 0.005);
  EXPECT_NEAR(steel.LameLambda(), 121.15, 0.005);
}

class Conversions : public ::testing::TestWithParam<double> {};

TEST_P(Conversions, RoundTrip) {
  const IsotropicElasticity e{5e4, GetParam()};
  // Moduli of size 1 / (1 - 2 nu) take that many digits of nu with them.
  const double tolerance = 1e-14 / std::min(1 - 2 * GetParam(), 1 + GetParam());
  const auto same = [&](const IsotropicElasticity& other) {
    EXPECT_NEAR(other.youngs_modulus / 5e4, 1, tolerance);
    EXPECT_NEAR(other.poisson_ratio, GetParam(), tolerance);
  };
  same(IsotropicElasticity::FromComplianceScale(
      e.ComplianceScale(SectionModel::kSolid), e.poisson_ratio,
      SectionModel::kSolid));
  EXPECT_NEAR(e.StiffnessScale(SectionModel::kSolid) *
                  e.ComplianceScale(SectionModel::kSolid),
              1, 1e-14);
}

TEST_P(Conversions, StiffnessScaleGivesLameParameters) {
  // lambda = s nu, 2 mu = s (1 - 2 nu), 3 kappa = s (1 + nu).
  const IsotropicElasticity e{5e4, GetParam()};
  const double s = e.StiffnessScale(SectionModel::kSolid);
  EXPECT_NEAR(e.LameLambda(), s * GetParam(), 1e-12 * s);
  EXPECT_NEAR(2 * e.ShearModulus(), s * (1 - 2 * GetParam()), 1e-12 * s);
  EXPECT_NEAR(3 * e.BulkModulus(), s * (1 + GetParam()), 1e-12 * s);
}

TEST_P(Conversions, ShearAndBulkJacobianMatchesFiniteDifferences) {
  const double youngs = 2.5;
  const double nu = GetParam();
  const Eigen::Matrix2d jacobian = ShearAndBulkJacobian({youngs, nu});
  const double step = 1e-6;
  const auto difference = [&](double in_youngs, double in_nu) {
    const IsotropicElasticity above = {youngs + in_youngs, nu + in_nu};
    const IsotropicElasticity below = {youngs - in_youngs, nu - in_nu};
    return Eigen::Vector2d(
        (above.ShearModulus() - below.ShearModulus()) / (2 * step),
        (1 / above.BulkModulus() - 1 / below.BulkModulus()) / (2 * step));
  };
  const double scale = jacobian.cwiseAbs().maxCoeff();
  EXPECT_LE((jacobian.col(0) - difference(step, 0)).norm(), 1e-7 * scale);
  EXPECT_LE((jacobian.col(1) - difference(0, step)).norm(), 1e-7 * scale);
  const IsotropicElasticity elasticity = {youngs, nu};
  EXPECT_NEAR(elasticity.BulkCompliance() * elasticity.BulkModulus(), 1, 1e-12);
}

INSTANTIATE_TEST_SUITE_P(PoissonRatios, Conversions,
                         ::testing::Values(-0.9, -0.5, 0.0, 0.3, 0.49, 0.4999));

TEST(IsotropicElasticity, KnowsWhatIsPhysical) {
  EXPECT_TRUE((IsotropicElasticity{1, 0.3}.IsPhysical()));
  EXPECT_TRUE((IsotropicElasticity{1, -0.99}.IsPhysical()));
  EXPECT_FALSE((IsotropicElasticity{0, 0.3}.IsPhysical()));
  EXPECT_FALSE((IsotropicElasticity{-1, 0.3}.IsPhysical()));
  EXPECT_FALSE((IsotropicElasticity{1, 0.5}.IsPhysical()));
  EXPECT_FALSE((IsotropicElasticity{1, -1}.IsPhysical()));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE((IsotropicElasticity{nan, 0.3}.IsPhysical()));
  EXPECT_FALSE((IsotropicElasticity{1, nan}.IsPhysical()));
}

TEST(IsotropicElasticity, LogStiffnessRatioIsThatOfTheModuli) {
  for (const double nu : {-0.9999, -0.5, 0.0, 0.3, 0.49999}) {
    const IsotropicElasticity elasticity = {2, nu};
    EXPECT_NEAR(LogStiffnessRatio(nu),
                std::log(3 * elasticity.BulkModulus() /
                         (2 * elasticity.ShearModulus())),
                1e-10);
    EXPECT_NEAR(PoissonRatioOfLogStiffnessRatio(LogStiffnessRatio(nu)), nu,
                1e-14);
  }
}

}  // namespace
}  // namespace elastimate
