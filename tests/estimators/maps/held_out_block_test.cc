#include <gtest/gtest.h>

#include <algorithm>

#include "elastimate/estimators/maps/estimate_map.h"
#include "tests/estimators/maps/map_scenes.h"

namespace elastimate::testing {
namespace {

// A stiff box off the centre of a block of tetrahedra, whose displacements a
// finer world made.
TEST(HeldOutBlockLong, FindsABoxThatAFinerWorldMeasured) {
  const MapScene truth = HeldOutBlock(5, 0.01);
  const MapEstimate map = EstimateMap(truth.scene, {});
  ASSERT_TRUE(map.IsUsable());
  EXPECT_EQ(map.element_order, 2);
  ASSERT_EQ(map.verdict, MapVerdict::kRegions);
  ASSERT_EQ(map.regions.size(), 2U);
  EXPECT_NEAR(map.regions[0].youngs_modulus, 2,
              3 * map.regions[0].standard_error);
  EXPECT_NEAR(map.regions[1].youngs_modulus, 6,
              3 * map.regions[1].standard_error);
  EXPECT_TRUE(std::none_of(map.findings.begin(), map.findings.end(),
                           [](const Finding& finding) {
                             return finding.code == FindingCode::kMayBeTheMesh;
                           }));
}

}  // namespace
}  // namespace elastimate::testing
