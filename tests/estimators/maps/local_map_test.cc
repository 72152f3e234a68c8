#include "elastimate/estimators/maps/local_map.h"

#include <gtest/gtest.h>

#include <Eigen/Core>

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

TEST(LocalMap, SaysWhereElementsAreMoreThanEquations) {
  const MapScene truth = MakeMapScene("inc5", ElementKind::kTet4, 3, 0);
  EXPECT_FALSE(EstimateLocalMap(truth.scene, {}).is_determined);
}

}  // namespace
}  // namespace elastimate::testing
