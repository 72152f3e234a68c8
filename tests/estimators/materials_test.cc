// Tests of materials other than a single isotropic one, in the estimators that
// take them.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "elastimate/core/equilibrium/simulated_measurement.h"
#include "elastimate/core/scene/degrees_of_freedom.h"
#include "elastimate/estimators/registry.h"
#include "tests/regions.h"
#include "tests/scenes.h"
#include "tests/throws.h"

namespace elastimate {
namespace {

using testing::KindOfSection;
using testing::TwoRegionScene;

const std::vector<IsotropicElasticity> kTruth = {{2e3, 0.2}, {5e3, 0.4}};
const Eigen::Vector4d kParameters(2e3, 0.2, 5e3, 0.4);

std::vector<std::string> EstimatorsOfMaterials() {
  std::vector<std::string> names;
  for (const std::string_view name : EstimatorNames()) {
    if (MakeEstimator(name)->WhatItTakes().takes_materials) {
      names.emplace_back(name);
    }
  }
  return names;
}

void ExpectParameters(const Estimate& estimate, const Eigen::VectorXd& expected,
                      double tolerance) {
  ASSERT_EQ(estimate.status, Status::kOk) << estimate.message;
  ASSERT_EQ(estimate.parameters.size(), expected.size());
  for (Eigen::Index i = 0; i < expected.size(); ++i) {
    EXPECT_NEAR(estimate.parameters[i].value / expected(i), 1, tolerance)
        << estimate.parameters[i].name;
  }
}

struct KindAndEstimator {
  KindOfSection kind;
  std::string estimator;
};

std::vector<KindAndEstimator> AllKindsAndEstimators() {
  std::vector<KindAndEstimator> all;
  for (const KindOfSection& kind : testing::AllKindsOfSections()) {
    for (const std::string& estimator : EstimatorsOfMaterials()) {
      all.push_back({kind, estimator});
    }
  }
  return all;
}

class MaterialsOfKinds : public ::testing::TestWithParam<KindAndEstimator> {};

TEST_P(MaterialsOfKinds, AreFoundExactlyWithoutNoise) {
  Scene scene = TwoRegionScene(GetParam().kind);
  testing::MeasureByTextbook(kTruth, scene);
  const Estimate estimate = MakeEstimator(GetParam().estimator)->Run(scene, {});
  const bool is_direct = GetParam().estimator == "closed-form" ||
                         GetParam().estimator == "bounded";
  ExpectParameters(estimate, kParameters, is_direct ? 1e-9 : 1e-6);
  EXPECT_EQ(estimate.parameters[0].name, "youngs_modulus");
  EXPECT_EQ(estimate.parameters[0].regions, std::vector<int>{3});
  EXPECT_EQ(estimate.parameters[3].name, "poisson_ratio");
  EXPECT_EQ(estimate.parameters[3].regions, std::vector<int>{7});
}

INSTANTIATE_TEST_SUITE_P(All, MaterialsOfKinds,
                         ::testing::ValuesIn(AllKindsAndEstimators()),
                         [](const auto& info) {
                           std::string name = testing::NameOf(info.param.kind) +
                                              "_" + info.param.estimator;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

class Materials : public ::testing::TestWithParam<std::string> {
 protected:
  Materials() { MeasureMaterials(kParameters, scene_); }

  Estimate Run(const EstimatorOptions& options = {}) const {
    return MakeEstimator(GetParam())->Run(scene_, options);
  }

  Scene scene_ = TwoRegionScene({ElementKind::kTet4, SectionModel::kSolid}, 4);
};

TEST_P(Materials, ThatAreKnownAreNotEstimated) {
  scene_.materials[0].known = {{"poisson_ratio", 0.2}};
  const Estimate estimate = Run();
  ExpectParameters(estimate, kParameters, 1e-6);
  EXPECT_TRUE(estimate.parameters[1].is_known);
  EXPECT_FALSE(estimate.parameters[1].standard_error.has_value());
  EXPECT_TRUE(estimate.parameters[3].standard_error.has_value());
  scene_.materials[0].known = {{"youngs_modulus", 2e3}, {"poisson_ratio", 0.2}};
  ExpectParameters(Run(), kParameters, 1e-6);
  scene_.materials[1].known = {{"youngs_modulus", 5e3}};
  ExpectParameters(Run(), kParameters, 1e-6);
}

// A single material whose modulus is known has one parameter fewer to estimate.
TEST_P(Materials, MayBeOneWithAKnownModulus) {
  scene_.materials = {{"isotropic", {}, {{"youngs_modulus", 3e3}}, {}}};
  MeasureMaterials(Eigen::Vector2d(3e3, 0.35), scene_);
  const Estimate estimate = Run();
  ExpectParameters(estimate, Eigen::Vector2d(3e3, 0.35), 1e-6);
  EXPECT_TRUE(estimate.parameters[0].regions.empty());
}

TEST_P(Materials, PreparedGiveWhatTheyGive) {
  const Estimate expected = Run();
  const auto estimator = MakeEstimator(GetParam());
  PreparedEstimator prepared = estimator->Prepare(scene_, {});
  const Estimate actual = prepared.Run({scene_.load_cases[0].displacement});
  ASSERT_EQ(actual.parameters.size(), expected.parameters.size());
  for (std::size_t i = 0; i < expected.parameters.size(); ++i) {
    EXPECT_EQ(actual.parameters[i].value, expected.parameters[i].value);
  }
}

TEST_P(Materials, ScaleWithTheUnits) {
  // The units change from N and mm to kN and m.
  Scene scaled = scene_;
  scaled.mesh.nodes *= 1e-3;
  for (LoadCase& load_case : scaled.load_cases) {
    load_case.displacement *= 1e-3;
    for (Load& load : load_case.loads) {
      std::get<NodalForces>(load).force *= 1e-3;
    }
  }
  const Estimate estimate = MakeEstimator(GetParam())->Run(scaled, {});
  Eigen::Vector4d expected = kParameters;
  expected(0) *= 1e3;
  expected(2) *= 1e3;
  ExpectParameters(estimate, expected, 1e-6);
}

TEST_P(Materials, KeepTheBoundsOfTheirs) {
  scene_.materials[1].bounds = {{"poisson_ratio", {0.1, 0.3}}};
  if (!MakeEstimator(GetParam())->WhatItTakes().takes_bounds) {
    EXPECT_THROWS_WITH(Run(), "bounds of a material");
    return;
  }
  const Estimate estimate = Run();
  EXPECT_LE(estimate.parameters[3].value, 0.3);
  EXPECT_GE(estimate.parameters[3].value, 0.1);
  if (estimate.IsUsable()) {
    EXPECT_TRUE(estimate.Has(FindingCode::kParametersOnBounds));
  }
}

TEST_P(Materials, ThatDoNotStrainAreNotDetermined) {
  // All nodes of the first material are held.
  for (Eigen::Index e = 0; e < scene_.mesh.NumElements(); ++e) {
    if (scene_.mesh.regions(e) == 3) {
      for (const int node : scene_.mesh.elements.col(e)) {
        scene_.supports.held.col(node) = true;
      }
    }
  }
  MeasureMaterials(kParameters, scene_);
  const Estimate estimate = Run();
  EXPECT_EQ(estimate.status, Status::kNotIdentifiable) << estimate.message;
  EXPECT_TRUE(estimate.Has(FindingCode::kParametersUndetermined))
      << estimate.message;
}

TEST_P(Materials, ThatAreAllKnownAreRefused) {
  scene_.materials[0].known = {{"youngs_modulus", 2e3}, {"poisson_ratio", 0.2}};
  scene_.materials[1].known = {{"youngs_modulus", 5e3}, {"poisson_ratio", 0.4}};
  EXPECT_THROWS_WITH(Run(), "there is nothing to estimate");
}

TEST_P(Materials, NextToIncompressibleOnesAreFound) {
  const Eigen::Vector4d parameters(2e3, 0.2, 5e3, 0.499);
  MeasureMaterials(parameters, scene_);
  ExpectParameters(Run(), parameters, 1e-4);
}

TEST_P(Materials, RefuseWhatIsForOneMaterial) {
  EstimatorOptions options;
  options.known_poisson_ratio = 0.3;
  EXPECT_THROWS_WITH(Run(options), "given for the whole specimen");
}

INSTANTIATE_TEST_SUITE_P(Estimators, Materials,
                         ::testing::ValuesIn(EstimatorsOfMaterials()),
                         [](const auto& info) {
                           std::string name = info.param;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

TEST(MaterialsRefusal, NamesTheAlternative) {
  Scene scene = TwoRegionScene({ElementKind::kTet4, SectionModel::kSolid}, 2);
  MeasureMaterials(kParameters, scene);
  scene.load_cases.push_back(scene.load_cases[0]);
  scene.load_cases[1].supports = scene.supports;
  EXPECT_THROWS_WITH(MakeEstimator("reduced-fe")->Run(scene, {}),
                     "use --estimator=iterative-fe");
}

TEST(MaterialsOfClosedForm, SaysWhenNoiseBiasesIt) {
  Scene scene = TwoRegionScene({ElementKind::kTet4, SectionModel::kSolid}, 4);
  MeasureMaterials(kParameters, scene);
  testing::AddNoise(1e-2, 1, scene);
  const Estimate estimate = MakeEstimator("closed-form")->Run(scene, {});
  EXPECT_FALSE(estimate.IsUsable());
  EXPECT_TRUE(estimate.Has(FindingCode::kNoiseBias) ||
              estimate.Has(FindingCode::kUnphysical))
      << estimate.message;
}

struct StatisticsCase {
  std::string estimator;
  double noise;
  /// The root mean square error may be at most this many Cramer-Rao bounds.
  double largest_ratio;
};

class MaterialsStatistics : public ::testing::TestWithParam<StatisticsCase> {};

// Over 20 seeds, mean squares of standard scores have the mean 1 and the
// standard deviation .32, root mean squares have one of 16 %, and the coverage
// of 95 % has one of 4.9 %.  Each tolerance is four of these.
TEST_P(MaterialsStatistics, StandardErrorsAreThoseOfTheErrors) {
  constexpr int kSeeds = 20;
  Scene scene = TwoRegionScene({ElementKind::kTet4, SectionModel::kSolid}, 4);
  MeasureMaterials(kParameters, scene);
  const Scene exact = scene;
  Eigen::Array4d squares = Eigen::Array4d::Zero();
  Eigen::Array4d ratios = Eigen::Array4d::Zero();
  Eigen::Array4d bound;
  Eigen::Array4d inside = Eigen::Array4d::Zero();
  int usable = 0;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    scene = exact;
    testing::AddNoise(GetParam().noise, seed, scene);
    if (seed == 1) {
      // The standard errors of a maximum-likelihood fit are the Cramer-Rao
      // bound.
      const Estimate fit = MakeEstimator("iterative-fe")->Run(scene, {});
      ASSERT_TRUE(fit.IsUsable()) << fit.message;
      bound = fit.parameter_covariance.diagonal().array().sqrt();
    }
    const Estimate estimate =
        MakeEstimator(GetParam().estimator)->Run(scene, {});
    if (!estimate.IsUsable()) {
      continue;
    }
    ++usable;
    for (Eigen::Index i = 0; i < 4; ++i) {
      const ParameterEstimate& parameter = estimate.parameters[i];
      const double score =
          (parameter.value - kParameters(i)) / *parameter.standard_error;
      squares(i) += score * score;
      ratios(i) += std::pow((parameter.value - kParameters(i)) / bound(i), 2);
      inside(i) += parameter.interval->lower <= kParameters(i) &&
                   kParameters(i) <= parameter.interval->upper;
    }
  }
  EXPECT_GE(usable, kSeeds - 2);
  for (Eigen::Index i = 0; i < 4; ++i) {
    EXPECT_NEAR(squares(i) / usable, 1, 4 * 0.32) << i;
    EXPECT_LE(std::sqrt(ratios(i) / usable),
              GetParam().largest_ratio * (1 + 4 * 0.16))
        << i;
    EXPECT_GE(inside(i) / usable, 0.95 - 4 * 0.049) << i;
  }
}

INSTANTIATE_TEST_SUITE_P(
    Cases, MaterialsStatistics,
    ::testing::Values(StatisticsCase{"virtual-fields", 1e-3, 2},
                      StatisticsCase{"virtual-fields", 1e-2, 2},
                      StatisticsCase{"reduced-fe", 1e-3, 1.2},
                      StatisticsCase{"reduced-fe", 1e-2, 1.2},
                      StatisticsCase{"iterative-fe", 1e-2, 1.2}));

}  // namespace
}  // namespace elastimate
