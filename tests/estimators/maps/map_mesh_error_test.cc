// What the elements of a map miss of a specimen, whose displacements a finer
// world made.

#include "elastimate/estimators/maps/map_mesh_error.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>
#include <variant>

#include "elastimate/core/scene/quadratic_scene.h"
#include "elastimate/estimators/maps/estimate_map.h"
#include "elastimate/estimators/registry.h"
#include "tests/estimators/maps/map_scenes.h"

namespace elastimate::testing {
namespace {

bool SaysThatItMayBeTheMesh(const MapEstimate& map) {
  return std::any_of(map.findings.begin(), map.findings.end(),
                     [](const Finding& finding) {
                       return finding.code == FindingCode::kMayBeTheMesh;
                     });
}

// Without a mesh error, each would come back as a field.
TEST(MapMeshError, HidesNoHomogeneousBody) {
  for (const auto& [kind, cells, noise] :
       {std::tuple(ElementKind::kQuad4, 8, 0.0003),
        std::tuple(ElementKind::kTri3, 6, 0.001),
        std::tuple(ElementKind::kTet4, 3, 0.001)}) {
    const MapScene truth = MakeSpecimen("hom", kind, cells, noise);
    const MapEstimate map = EstimateMap(truth.scene, {});
    ASSERT_TRUE(map.IsUsable());
    EXPECT_GT(std::max(map.field_log_evidence, map.region_log_evidence), 3);
    EXPECT_EQ(map.verdict, MapVerdict::kHomogeneous) << cells;
    EXPECT_TRUE(SaysThatItMayBeTheMesh(map));
    EXPECT_NEAR(map.mean_youngs_modulus, 1, 3 * std::sqrt(map.covariance(0, 0)))
        << cells;
    EXPECT_NEAR(map.poisson_ratio, 0.3, 3 * std::sqrt(map.covariance(1, 1)))
        << cells;
    EXPECT_GT(map.mesh_covariance(0, 0), 0.5 * map.covariance(0, 0)) << cells;
  }
}

TEST(MapMeshError, LeavesRealStructure) {
  const MapScene truth = MakeSpecimen("inc2", ElementKind::kQuad4, 8, 0.003);
  const MapEstimate map = EstimateMap(truth.scene, {});
  ASSERT_TRUE(map.IsUsable());
  EXPECT_EQ(map.verdict, MapVerdict::kRegions);
  EXPECT_FALSE(SaysThatItMayBeTheMesh(map));
}

TEST(MapMeshError, IsInTheErrorsOfAField) {
  const MapScene truth = MakeSpecimen("grad", ElementKind::kQuad4, 8, 0.003);
  const MapEstimate map = EstimateMap(truth.scene, {});
  ASSERT_TRUE(map.IsUsable());
  ASSERT_EQ(map.verdict, MapVerdict::kField);
  EXPECT_GT(map.mesh_covariance(0, 0), 0);
  EXPECT_NEAR(std::log(map.mean_youngs_modulus), truth.log_moduli.mean(),
              3 * std::sqrt(map.covariance(0, 0)) / map.mean_youngs_modulus);
  const Eigen::ArrayXd deviations =
      map.youngs_modulus.array().log() - truth.log_moduli.array();
  const Eigen::ArrayXd sd =
      map.youngs_modulus_standard_error.array() / map.youngs_modulus.array();
  EXPECT_GT((deviations.abs() < 1.96 * sd).cast<double>().mean(), 0.93);
}

TEST(MapMeshError, IsUnknownOfQuadraticElementsWithoutAdviceToUseAuto) {
  Scene scene = MakeSpecimen("inc5", ElementKind::kQuad4, 6, 0.003).scene;
  // Strains are small.
  scene.load_cases[0].displacement *= 1e-4;
  std::get<Traction>(scene.load_cases[0].loads[0]).traction *= 1e-4;
  scene.materials.resize(1);
  scene.materials[0].fields = {"youngs_modulus"};
  const Estimate of_linear = MakeEstimator("auto")->Run(scene, {});
  EXPECT_FALSE(of_linear.Has(FindingCode::kMeshErrorUnknown));
  EXPECT_EQ(of_linear.element_order, 2);
  ASSERT_EQ(of_linear.error_budget.discretization.size(), 2);
  EXPECT_GT(of_linear.error_budget.discretization(0), 0);
  const Estimate of_quadratic =
      MakeEstimator("auto")->Run(QuadraticScene(scene), {});
  ASSERT_TRUE(of_quadratic.Has(FindingCode::kMeshErrorUnknown));
  for (const Finding& finding : of_quadratic.findings) {
    EXPECT_EQ(finding.advice.find("auto"), std::string::npos) << finding.advice;
  }
}

TEST(MapMeshError, DoesNotSendMapsToLargeStrains) {
  Scene scene = MakeSpecimen("inc5", ElementKind::kQuad4, 4, 0.003).scene;
  scene.materials.resize(1);
  scene.materials[0].fields = {"youngs_modulus"};
  const Estimate estimate = MakeEstimator("auto")->Run(scene, {});
  ASSERT_TRUE(estimate.IsRefusedFor(FindingCode::kLargeDeformation));
  EXPECT_EQ(estimate.message.find("--kinematics"), std::string::npos)
      << estimate.message;
  EXPECT_EQ(estimate.rungs.size(), 1U);
}

}  // namespace
}  // namespace elastimate::testing
