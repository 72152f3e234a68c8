#include "elastimate/estimators/force_balance/local_map.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "elastimate/estimators/registry.h"
#include "tests/estimators/maps/map_scenes.h"

namespace elastimate::testing {
namespace {

double LargestError(const LocalMap& map, const MapScene& truth) {
  return (map.youngs_modulus.array() / truth.log_moduli.array().exp() - 1)
      .abs()
      .maxCoeff();
}

TEST(LocalMap, IsExactWithoutNoise) {
  for (const auto& [kind, cells] :
       {std::pair(ElementKind::kQuad4, 12), std::pair(ElementKind::kHex8, 4)}) {
    const MapScene truth = MakeMapScene("inc5", kind, cells, 0);
    const LocalMap map = EstimateLocalMap(truth.scene, {});
    EXPECT_TRUE(map.is_determined);
    EXPECT_LT(LargestError(map, truth), 1e-8);
    EXPECT_NEAR(map.poisson_ratio, 0.3, 1e-9);
    EXPECT_LT(map.force_residual, 1e-9);
    EstimatorOptions options;
    options.known_poisson_ratio = 0.3;
    EXPECT_LT(LargestError(EstimateLocalMap(truth.scene, options), truth),
              1e-8);
  }
}

// Noise of 1 % hides a contrast of five.
TEST(LocalMap, IsOfNoUseWithNoise) {
  const MapScene truth = MakeMapScene("inc5", ElementKind::kQuad4, 12, 0.01);
  const LocalMap map = EstimateLocalMap(truth.scene, {});
  EXPECT_GT(
      MapError(map.youngs_modulus.cwiseAbs().array().log(), truth.log_moduli),
      1);
}

Estimate ClosedFormMap(MapScene truth) {
  truth.scene.materials.resize(1);
  truth.scene.materials[0].fields = {"youngs_modulus"};
  return MakeEstimator("closed-form")->Run(truth.scene, {});
}

TEST(LocalMap, IsAnEstimateOfClosedForm) {
  const MapScene truth = MakeMapScene("inc5", ElementKind::kQuad4, 12, 0);
  const Estimate estimate = ClosedFormMap(truth);
  ASSERT_TRUE(estimate.IsUsable()) << estimate.message;
  ASSERT_TRUE(estimate.map);
  EXPECT_EQ(estimate.map->verdict, MapVerdict::kElements);
  EXPECT_LT(
      (estimate.map->youngs_modulus.array().log() - truth.log_moduli.array())
          .abs()
          .maxCoeff(),
      1e-8);
  EXPECT_NEAR(std::log(estimate.elasticity.youngs_modulus),
              truth.log_moduli.mean(), 1e-8);
  EXPECT_TRUE(estimate.Has(FindingCode::kLocalMap));
  EXPECT_FALSE(estimate.YoungsModulusStandardError());
}

TEST(LocalMap, FailsWhereNoiseMakesModuliNegative) {
  const MapScene truth = MakeMapScene("inc5", ElementKind::kQuad4, 16, 0.01);
  const LocalMap map = EstimateLocalMap(truth.scene, {});
  ASSERT_LT(map.youngs_modulus.minCoeff(), 0);
  const Estimate estimate = ClosedFormMap(truth);
  EXPECT_EQ(estimate.status, Status::kUnphysical);
  EXPECT_NE(estimate.message.find("--estimator=iterative-fe"),
            std::string::npos);
}

TEST(LocalMap, FailsWhereElementsAreMoreThanEquations) {
  const Estimate estimate =
      ClosedFormMap(MakeMapScene("inc5", ElementKind::kTet4, 3, 0));
  EXPECT_EQ(estimate.status, Status::kNotIdentifiable);
}

TEST(LocalMap, SaysWhereElementsAreMoreThanEquations) {
  const MapScene truth = MakeMapScene("inc5", ElementKind::kTet4, 3, 0);
  EXPECT_FALSE(EstimateLocalMap(truth.scene, {}).is_determined);
}

}  // namespace
}  // namespace elastimate::testing
