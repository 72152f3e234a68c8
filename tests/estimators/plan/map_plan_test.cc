#include "elastimate/estimators/plan/map_plan.h"

#include <gtest/gtest.h>

#include <cmath>

#include "elastimate/core/scene/scene_builder.h"
#include "elastimate/estimators/maps/estimate_map.h"
#include "elastimate/estimators/plan/unit_loads.h"
#include "tests/estimators/maps/map_scenes.h"
#include "tests/throws.h"

namespace elastimate::testing {
namespace {

std::vector<CandidateLoad> CandidatesOf(const Scene& scene) {
  return UnitCandidates(scene, LoadedFacets(scene));
}

// The number that a map of such a body finds afterwards, which knows neither
// the noise nor how much E varies.
TEST(MapPlan, ExpectsWhatMapsSupport) {
  const MapScene truth = MakeMapScene("inc5", ElementKind::kQuad4, 12, 0.01);
  Scene scene = truth.scene;
  const MapEstimate map = EstimateMap(scene, {});
  scene.load_cases[0].noise_sd = truth.noise_sd;
  const MapPlan plan = PlanMap(scene, CandidatesOf(scene), {1, 0.3}, 0.01,
                               SolverKind::kAutomatic);
  EXPECT_GT(plan.supported_before, map.supported_parameters / 1.5);
  EXPECT_LT(plan.supported_before, map.supported_parameters * 1.5);
}

TEST(MapPlan, PrefersWhatIsNotMeasuredYet) {
  Scene scene = MakeMapScene("hom", ElementKind::kQuad4, 8, 0.01).scene;
  const std::vector<CandidateLoad> candidates = CandidatesOf(scene);
  ASSERT_EQ(candidates.size(), 3U);
  const MapPlan plan =
      PlanMap(scene, candidates, {1, 0.3}, 0.01, SolverKind::kAutomatic);
  ASSERT_EQ(plan.loads.size(), 3U);
  // The load case of the scene pushes along y: to measure it again is worth the
  // least.
  EXPECT_EQ(candidates[plan.loads.back().candidate].name, "force along y");
  EXPECT_GT(plan.loads.back().supported_parameters, plan.supported_before);
  // Another scale of E and of the loads changes nothing under relative noise.
  const MapPlan other =
      PlanMap(scene, candidates, {1000, 0.3}, 0.01, SolverKind::kAutomatic);
  EXPECT_NEAR(other.supported_before, plan.supported_before,
              1e-6 * plan.supported_before);
  // Less noise shows more.
  EXPECT_GT(PlanMap(scene, candidates, {1, 0.3}, 0.001, SolverKind::kAutomatic)
                .supported_before,
            plan.supported_before);
}

TEST(MapPlan, RefusesLargeMeshes) {
  const Scene scene = MakeMapScene("hom", ElementKind::kQuad4, 46, 0).scene;
  EXPECT_THROWS_WITH(
      static_cast<void>(PlanMap(scene, CandidatesOf(scene), {1, 0.3}, 0.01,
                                SolverKind::kAutomatic)),
      "give a coarser mesh");
}

}  // namespace
}  // namespace elastimate::testing
