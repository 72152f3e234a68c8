#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "elastimate/estimators/maps/estimate_map.h"
#include "tests/estimators/maps/map_scenes.h"

namespace elastimate::testing {
namespace {

void ExpectTwoRegions(const MapEstimate& map) {
  ASSERT_TRUE(map.IsUsable());
  EXPECT_EQ(map.element_order, 2);
  ASSERT_EQ(map.verdict, MapVerdict::kRegions);
  ASSERT_EQ(map.regions.size(), 2U);
  EXPECT_NEAR(map.regions[0].youngs_modulus, 2,
              3 * map.regions[0].standard_error);
  EXPECT_NEAR(map.regions[1].youngs_modulus, 6,
              3 * map.regions[1].standard_error);
  // Beyond a third, a modulus counts as undetermined.
  EXPECT_LT(map.regions[1].standard_error, map.regions[1].youngs_modulus / 3);
  EXPECT_NEAR(map.poisson_ratio, 0.35, 3 * std::sqrt(map.covariance(1, 1)));
  EXPECT_TRUE(std::none_of(map.findings.begin(), map.findings.end(),
                           [](const Finding& finding) {
                             return finding.code == FindingCode::kMayBeTheMesh;
                           }));
}

// A stiff box off the centre of a block of tetrahedra, whose displacements a
// finer world made.
TEST(HeldOutBlockLong, FindsABoxThatAFinerWorldMeasured) {
  const MapEstimate map = EstimateMap(HeldOutBlock(5, 0.01).scene, {});
  ExpectTwoRegions(map);
  EXPECT_FALSE(map.boundary);
}

TEST(HeldOutBlockLong, FindsABallThatCutsElements) {
  ExpectTwoRegions(EstimateMap(HeldOutBall(6, 0.01).scene, {}));
}

}  // namespace
}  // namespace elastimate::testing
