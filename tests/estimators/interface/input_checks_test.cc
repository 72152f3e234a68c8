// Tests of what is asked of a scene before anything is estimated.

#include "elastimate/estimators/interface/input_checks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "elastimate/core/mesh/facets.h"
#include "tests/scenes.h"
#include "tests/throws.h"

namespace elastimate {
namespace {

TEST(InputChecks, RefuseAPressureThatFollows) {
  Scene scene = testing::SmallScene("cuboid");
  Pressure pressure = {BoundaryFacets(scene.mesh), 1};
  scene.load_cases[0].loads = {pressure};
  EXPECT_NO_THROW(CheckLoads(scene));
  pressure.follows = true;
  scene.load_cases[0].loads = {pressure};
  EXPECT_THROWS_WITH(CheckLoads(scene),
                     "load case 1 has a pressure that follows .*only simulate");
}

}  // namespace
}  // namespace elastimate
