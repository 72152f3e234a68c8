// Estimates from what CalculiX computed at large strains
// (tests/data/calculix/README.md).

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <ostream>
#include <random>
#include <string>

#include "elastimate/estimators/registry.h"
#include "elastimate/io/scene/scene_reader.h"

namespace elastimate {
namespace {

using Values = std::map<std::string, double>;

struct RubberBody {
  std::string name;
  Values truth;
};

std::ostream& operator<<(std::ostream& out, const RubberBody& body) {
  return out << body.name;
}

// Reads a body, and adds noise of a hundredth of its displacements.
Scene NoisyBody(const std::string& name, std::uint64_t seed) {
  Scene scene = ReadScene({std::string(ELASTIMATE_TEST_DATA "/calculix/") +
                           name + ".json"},
                          Measurement::kRequired)
                    .scene;
  LoadCase& load_case = scene.load_cases[0];
  Eigen::MatrixXd& displacement = load_case.displacement;
  const double sd =
      0.01 * displacement.norm() / std::sqrt(double(displacement.size()));
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> noise(0, sd);
  for (Eigen::Index i = 0; i < displacement.size(); ++i) {
    if (!scene.supports.held(i)) {
      displacement(i) += noise(generator);
    }
  }
  load_case.noise_sd = sd;
  return scene;
}

class BodiesOfCalculix : public ::testing::TestWithParam<RubberBody> {};

TEST_P(BodiesOfCalculix, AreEstimatedWithinThreeErrors) {
  const Estimate estimate =
      MakeEstimator("iterative-fe")->Run(NoisyBody(GetParam().name, 1), {});
  ASSERT_EQ(estimate.status, Status::kOk) << estimate.message;
  for (const ParameterEstimate& parameter : estimate.parameters) {
    if (!parameter.is_known) {
      const double truth = GetParam().truth.at(parameter.name);
      EXPECT_NEAR(parameter.value, truth, 3 * *parameter.standard_error)
          << parameter.name;
    }
  }
  EXPECT_LT(*estimate.parameters[0].standard_error,
            0.03 * estimate.parameters[0].value);
}

std::string BodyName(const ::testing::TestParamInfo<RubberBody>& tested) {
  return tested.param.name;
}

INSTANTIATE_TEST_SUITE_P(
    Bent, BodiesOfCalculix,
    ::testing::Values(
        RubberBody{"bar", {{"c10", 0.1}, {"bulk_modulus", 14.0 / 15}}},
        RubberBody{"cone", {{"c10", 0.15}, {"bulk_modulus", 2.9}}},
        RubberBody{"ell", {{"c10", 0.1}, {"bulk_modulus", 0.6}}}),
    BodyName);

INSTANTIATE_TEST_SUITE_P(
    PulledOrPressed, BodiesOfCalculix,
    ::testing::Values(
        RubberBody{"block", {{"c10", 0.1}, {"bulk_modulus", 13.0 / 30}}},
        RubberBody{"cross", {{"c10", 3.51}, {"c01", 0.93}}},
        RubberBody{"pillar", {{"c10", 0.1}, {"bulk_modulus", 14.0 / 15}}}),
    BodyName);

// None of the laws that are compared is that of the body, so that E and nu
// depend on the law, which their errors have to include.
TEST(LawsForABodyOfCalculix, AreChosenWithErrorsThatIncludeOtherLaws) {
  for (const RubberBody& body :
       {RubberBody{"block", {{"E", 0.52}, {"nu", 0.3}}},
        RubberBody{"pillar", {{"E", 0.56}, {"nu", 0.4}}}}) {
    Scene scene = NoisyBody(body.name, 1);
    scene.materials.clear();
    const Estimate estimate = MakeEstimator("auto")->Run(scene, {});
    ASSERT_EQ(estimate.status, Status::kOk) << estimate.message;
    EXPECT_NEAR(estimate.elasticity.youngs_modulus, body.truth.at("E"),
                3 * *estimate.YoungsModulusStandardError());
    EXPECT_NEAR(estimate.elasticity.poisson_ratio, body.truth.at("nu"),
                3 * *estimate.PoissonRatioStandardError());
  }
}

}  // namespace
}  // namespace elastimate
