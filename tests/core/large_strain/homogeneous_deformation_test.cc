#include "elastimate/core/large_strain/homogeneous_deformation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "elastimate/core/materials/laws.h"

namespace elastimate {
namespace {

std::vector<std::optional<HomogeneousState>> Curve(
    const char* law, const Eigen::VectorXd& parameters, DeformationMode mode,
    const std::vector<double>& stretches) {
  return DeformHomogeneously(
      *FindLaw(law), FindLaw(law)->Moduli(parameters, SectionModel::kSolid),
      mode, stretches);
}

const std::vector<double>& SomeStretches() {
  static const std::vector<double> stretches = {0.6, 0.9, 1.0, 1.5, 3.0, 6.0};
  return stretches;
}

// The closed forms of an incompressible neo-Hookean material, P / mu.
TEST(DeformHomogeneously, HasTheIncompressibleLimitOfNeoHooke) {
  const double mu = 3;
  const double lambda = 1e6 * mu;
  const Eigen::Vector2d parameters(mu * (3 * lambda + 2 * mu) / (lambda + mu),
                                   lambda / (2 * (lambda + mu)));
  const auto expect = [&](DeformationMode mode, auto&& stress_over_mu) {
    const auto states = Curve("neo_hookean", parameters, mode, SomeStretches());
    for (std::size_t i = 0; i < states.size(); ++i) {
      ASSERT_TRUE(states[i]) << DeformationModeName(mode) << " " << i;
      // What is left of compressibility is of the size of stress / lambda.
      const double expected = stress_over_mu(SomeStretches()[i]);
      EXPECT_NEAR(states[i]->stress / mu, expected,
                  10e-6 * (1 + expected * expected))
          << DeformationModeName(mode) << " " << i;
    }
  };
  expect(DeformationMode::kUniaxial, [](double x) { return x - 1 / (x * x); });
  expect(DeformationMode::kEquibiaxial,
         [](double x) { return x - std::pow(x, -5); });
  expect(DeformationMode::kPureShear,
         [](double x) { return x - std::pow(x, -3); });
  expect(DeformationMode::kSimpleShear, [](double x) { return x - 1; });
}

// Mooney and Rivlin's law as it describes rubber, with a bulk modulus that is a
// hundred million times the shear modulus.
TEST(DeformHomogeneously, HasTheClosedFormsOfMooneyAndRivlin) {
  const double c10 = 3.51;
  const double c01 = 0.93;
  const Eigen::Vector3d parameters(c10, c01, 4e8);
  const auto expect = [&](DeformationMode mode, double x, double stress) {
    const auto states = Curve("mooney_rivlin", parameters, mode, {x});
    ASSERT_TRUE(states[0]);
    EXPECT_NEAR(states[0]->stress / stress, 1, 1e-4)
        << DeformationModeName(mode) << " " << x;
  };
  for (const double x : {0.7, 2.0, 4.0}) {
    expect(DeformationMode::kUniaxial, x,
           2 * (x - 1 / (x * x)) * (c10 + c01 / x));
    expect(DeformationMode::kEquibiaxial, x,
           2 * (x - std::pow(x, -5)) * (c10 + c01 * x * x));
    expect(DeformationMode::kPureShear, x,
           2 * (x - std::pow(x, -3)) * (c10 + c01));
  }
}

TEST(DeformHomogeneously, HasTheClosedFormsOfYeoh) {
  const Eigen::Vector4d parameters(1.2, -0.02, 0.001, 1e8);
  for (const double x : {0.7, 2.0, 4.0}) {
    const double a = x * x + 2 / x - 3;
    const auto states =
        Curve("yeoh", parameters, DeformationMode::kUniaxial, {x});
    ASSERT_TRUE(states[0]);
    EXPECT_NEAR(states[0]->stress / (2 * (x - 1 / (x * x)) *
                                     (1.2 - 2 * 0.02 * a + 3 * 0.001 * a * a)),
                1, 1e-4);
  }
}

// E of Green's strain across the pull is -nu times that along it.
TEST(DeformHomogeneously, HasTheClosedFormOfStVenantAndKirchhoff) {
  const auto states = Curve("st_venant_kirchhoff", Eigen::Vector2d(5, 0.3),
                            DeformationMode::kUniaxial, {0.8, 1.4});
  for (const auto& state : states) {
    ASSERT_TRUE(state);
    const double x = 1 + state->gradient(0, 0);
    EXPECT_NEAR(state->stress, 5 * x * (x * x - 1) / 2, 1e-12);
    EXPECT_NEAR(1 + state->gradient(1, 1), std::sqrt(1 - 0.3 * (x * x - 1)),
                1e-12);
  }
}

TEST(DeformHomogeneously, StretchesTheCorotatedLawAsHookesLaw) {
  for (const char* const law : {"corotated", "isotropic"}) {
    const auto states = Curve(law, Eigen::Vector2d(5, 0.3),
                              DeformationMode::kUniaxial, {0.8, 1.4});
    for (const auto& state : states) {
      ASSERT_TRUE(state);
      EXPECT_NEAR(state->stress, 5 * state->gradient(0, 0), 1e-12);
      EXPECT_NEAR(state->gradient(2, 2), -0.3 * state->gradient(0, 0), 1e-12);
    }
  }
}

TEST(DeformHomogeneously, ChangesVolumeByTheBulkModulus) {
  const auto states = Curve("mooney_rivlin", Eigen::Vector3d(1, 0.2, 7),
                            DeformationMode::kVolumetric, {0.9, 1.2});
  for (const auto& state : states) {
    ASSERT_TRUE(state);
    const double x = 1 + state->gradient(0, 0);
    EXPECT_NEAR(state->stress, 7 * (x * x * x - 1) * x * x, 1e-12);
  }
}

// St. Venant and Kirchhoff's law lets a sheet that is pulled far in its plane
// become flat: E across it would be less than -1/2.
TEST(DeformHomogeneously, SaysWhereThereIsNoState) {
  const auto states = Curve("st_venant_kirchhoff", Eigen::Vector2d(5, 0.45),
                            DeformationMode::kEquibiaxial, {1.05, 2.5});
  EXPECT_TRUE(states[0]);
  EXPECT_FALSE(states[1]);
}

}  // namespace
}  // namespace elastimate
