#include "elastimate/estimators/plan/map_plan.h"

#include <gtest/gtest.h>

#include <algorithm>
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

// To measure the same load again halves the variance of the noise.
TEST(MapPlan, CountsASecondMeasurementAsLessNoise) {
  const Scene scene = MakeMapScene("hom", ElementKind::kQuad4, 8, 0).scene;
  const std::vector<CandidateLoad> candidates = CandidatesOf(scene);
  ASSERT_EQ(candidates.size(), 3U);
  const MapPlan plan =
      PlanMap(scene, candidates, {1, 0.3}, 0.01, SolverKind::kAutomatic);
  ASSERT_EQ(plan.loads.size(), 3U);
  const auto again = std::find_if(
      plan.loads.begin(), plan.loads.end(), [&](const PlannedMapLoad& load) {
        return candidates[load.candidate].name == "force along y";
      });
  ASSERT_NE(again, plan.loads.end());
  const double expected = PlanMap(scene, candidates, {1, 0.3},
                                  0.01 / std::sqrt(2), SolverKind::kAutomatic)
                              .supported_before;
  EXPECT_NEAR(again->supported_parameters, expected, 1e-6 * expected);
  EXPECT_GT(expected, plan.supported_before);
  // The best comes first.
  for (std::size_t i = 1; i < plan.loads.size(); ++i) {
    EXPECT_GE(plan.loads[i - 1].supported_parameters,
              plan.loads[i].supported_parameters);
  }
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
