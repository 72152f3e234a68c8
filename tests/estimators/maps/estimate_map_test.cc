#include "elastimate/estimators/maps/estimate_map.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>

#include "elastimate/core/scene/camera.h"
#include "elastimate/estimators/registry.h"
#include "tests/estimators/maps/map_scenes.h"
#include "tests/throws.h"

namespace elastimate::testing {
namespace {

constexpr ElementKind kQuads = ElementKind::kQuad4;

bool HasFinding(const MapEstimate& map, FindingCode code) {
  return std::any_of(
      map.findings.begin(), map.findings.end(),
      [code](const Finding& finding) { return finding.code == code; });
}

double ErrorOf(const MapEstimate& map, const MapScene& truth) {
  return MapError(map.youngs_modulus.array().log(), truth.log_moduli);
}

TEST(EstimateMap, SaysThatAHomogeneousBodyIsOne) {
  for (const double noise : {0.01, 0.05}) {
    for (const int seed : {1, 2, 3, 4, 5}) {
      const MapScene truth = MakeMapScene("hom", kQuads, 12, noise, seed);
      const MapEstimate map = EstimateMap(truth.scene, {});
      ASSERT_TRUE(map.IsUsable());
      EXPECT_EQ(map.verdict, MapVerdict::kHomogeneous) << noise << " " << seed;
      EXPECT_LT(map.field_log_evidence, 3);
      EXPECT_LT(map.region_log_evidence, 3);
      EXPECT_EQ(map.youngs_modulus.maxCoeff(), map.youngs_modulus.minCoeff());
      // Four standard errors are too few in one of 16 000 draws.
      EXPECT_NEAR(map.regions[0].youngs_modulus, 1,
                  4 * map.regions[0].standard_error);
      EXPECT_NEAR(map.poisson_ratio, 0.3, 4 * std::sqrt(map.covariance(1, 1)));
    }
  }
}

TEST(EstimateMap, FindsTheCameraThatTurned) {
  MapScene truth = MakeMapScene("inc5", kQuads, 12, 0.01);
  Scene& scene = truth.scene;
  // A body that is so stiff that it hardly moves.
  constexpr double kStiffness = 1e3;
  LoadCase& load_case = scene.load_cases[0];
  load_case.displacement /= kStiffness;
  if (load_case.noise_sd) {
    *load_case.noise_sd /= kStiffness;
  }
  const Camera camera = {Eigen::Rotation2Dd(0.5).toRotationMatrix(),
                         Eigen::Vector2d(0.2, -0.1)};
  load_case.displacement =
      camera.SeenDisplacement(scene.mesh, load_case.displacement.reshaped())
          .reshaped(2, scene.mesh.NumNodes());
  scene.is_rigid_motion_free = true;
  const MapEstimate map = EstimateMap(scene, {});
  ASSERT_TRUE(map.IsUsable());
  EXPECT_LT(ErrorOf(map, truth), 0.05);
  ASSERT_EQ(map.cameras.size(), 1U);
  EXPECT_NEAR(map.cameras[0].Angle(), 0.5, 1e-3);
  const Eigen::MatrixXd seen =
      SeenDisplacements(scene.mesh, map.fitted_displacement, map.cameras);
  EXPECT_LT((seen - load_case.displacement.reshaped()).norm(),
            1.1 * truth.noise_sd / kStiffness * std::sqrt(double(seen.size())));
}

TEST(EstimateMap, FindsInclusions) {
  for (const auto& [name, kind, cells, modulus] :
       {std::tuple("inc5", kQuads, 16, 5.0),
        std::tuple("inc2", kQuads, 16, 2.0), std::tuple("two", kQuads, 16, 5.0),
        std::tuple("inc5", ElementKind::kHex8, 6, 5.0),
        std::tuple("inc5", ElementKind::kTri3, 12, 5.0)}) {
    const MapScene truth = MakeMapScene(name, kind, cells, 0.01);
    const MapEstimate map = EstimateMap(truth.scene, {});
    ASSERT_TRUE(map.IsUsable()) << name;
    ASSERT_EQ(map.verdict, MapVerdict::kRegions) << name;
    ASSERT_EQ(map.regions.size(), 2U) << name;
    EXPECT_LT(ErrorOf(map, truth), 0.02) << name;
    const double values[] = {1, modulus};
    for (int i = 0; i < 2; ++i) {
      EXPECT_NEAR(map.regions[i].youngs_modulus, values[i],
                  4 * map.regions[i].standard_error)
          << name;
    }
    EXPECT_LT(map.regions[1].standard_error, 0.03 * modulus) << name;
    EXPECT_NEAR(map.regions[0].volume + map.regions[1].volume, 1, 1e-12);
    EXPECT_NEAR(map.noise_sd, truth.noise_sd, 0.15 * truth.noise_sd) << name;
    EXPECT_NEAR(map.poisson_ratio, 0.3, 4 * std::sqrt(map.covariance(1, 1)))
        << name;
  }
}

TEST(EstimateMap, FindsLayers) {
  const MapScene truth = MakeMapScene("lay", kQuads, 16, 0.01);
  const MapEstimate map = EstimateMap(truth.scene, {});
  ASSERT_EQ(map.verdict, MapVerdict::kRegions);
  ASSERT_EQ(map.regions.size(), 3U);
  EXPECT_LT(ErrorOf(map, truth), 0.05);
}

TEST(EstimateMap, FindsAFieldWithItsErrors) {
  const MapScene truth = MakeMapScene("grad", kQuads, 16, 0.01);
  const MapEstimate map = EstimateMap(truth.scene, {});
  ASSERT_EQ(map.verdict, MapVerdict::kField);
  // With the length for inclusions it would be 0.12.
  EXPECT_LT(ErrorOf(map, truth), 0.1);
  const Eigen::ArrayXd deviations =
      map.youngs_modulus.array().log() - truth.log_moduli.array();
  const Eigen::ArrayXd sd =
      map.youngs_modulus_standard_error.array() / map.youngs_modulus.array();
  // Graded fields are covered by .95 to .99.
  EXPECT_GT((deviations.abs() < 1.96 * sd).cast<double>().mean(), 0.93);
  EXPECT_GT(map.supported_parameters, 40);
  EXPECT_LT(map.supported_parameters, 150);
  // What is resolved is no smaller than an element, and less of it is seen near
  // the clamped base than below the load.
  EXPECT_GT(map.resolution_length.minCoeff(), 1 / 16.0 - 1e-9);
  EXPECT_LT(map.resolution_length.maxCoeff(), 0.3);
}

TEST(EstimateMap, IsExactWithoutNoise) {
  const MapScene truth = MakeMapScene("inc5", kQuads, 10, 0);
  const MapEstimate map = EstimateMap(truth.scene, {});
  ASSERT_EQ(map.verdict, MapVerdict::kRegions);
  EXPECT_LT((map.youngs_modulus.array().log() - truth.log_moduli.array())
                .abs()
                .maxCoeff(),
            1e-8);
}

TEST(EstimateMap, TakesAGivenNoiseAndAGivenPoissonRatio) {
  MapScene truth = MakeMapScene("inc5", kQuads, 12, 0.01);
  truth.scene.load_cases[0].noise_sd = truth.noise_sd;
  EstimatorOptions options;
  options.known_poisson_ratio = 0.3;
  const MapEstimate map = EstimateMap(truth.scene, options);
  ASSERT_EQ(map.verdict, MapVerdict::kRegions);
  EXPECT_LT(ErrorOf(map, truth), 0.02);
  EXPECT_EQ(map.poisson_ratio, 0.3);
  EXPECT_EQ(map.covariance(1, 1), 0);
  EXPECT_FALSE(HasFinding(map, FindingCode::kMisfit));
  EXPECT_NEAR(map.noise_sd, truth.noise_sd, 1e-9 * truth.noise_sd);
  // A wrong noise is said, and the right one found.
  truth.scene.load_cases[0].noise_sd = truth.noise_sd / 3;
  const MapEstimate other = EstimateMap(truth.scene, options);
  EXPECT_TRUE(HasFinding(other, FindingCode::kMisfit));
  EXPECT_NEAR(other.noise_sd, truth.noise_sd, 0.15 * truth.noise_sd);
}

// E in the unit of the force, and lengths in millimetres.
TEST(EstimateMap, DoesNotDependOnUnits) {
  MapScene truth = MakeMapScene("inc5", kQuads, 8, 0.01);
  const MapEstimate map = EstimateMap(truth.scene, {});
  std::get<Traction>(truth.scene.load_cases[0].loads[0]).traction *= 1000;
  truth.scene.mesh.nodes *= 10;
  truth.scene.supports.boxes.clear();
  truth.scene.load_cases[0].displacement *= 10;
  const MapEstimate other = EstimateMap(truth.scene, {});
  EXPECT_EQ(other.verdict, map.verdict);
  EXPECT_LT((other.youngs_modulus / 1000 - map.youngs_modulus).norm(),
            1e-6 * map.youngs_modulus.norm());
  EXPECT_LT((other.resolution_length / 10 - map.resolution_length).norm(),
            1e-3 * map.resolution_length.norm());
}

// The inclusion is seen less by noisier data, and its contrast falls with its
// diameter over the resolution length.
TEST(EstimateMap, TakesALayerOfOneElementForABoundary) {
  const MapEstimate map = EstimateMap(
      MakeMapScene("thin", ElementKind::kQuad4, 16, 0.003).scene, {});
  ASSERT_TRUE(map.IsUsable());
  ASSERT_EQ(map.regions.size(), 2U);
  ASSERT_TRUE(map.boundary);
  const MapRegion expected[] = {map.regions[0], *map.boundary, map.regions[1]};
  const double moduli[] = {1, 2, 4};
  const double volumes[] = {0.5, 0.0625, 0.4375};
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(expected[i].youngs_modulus, moduli[i],
                4 * expected[i].standard_error);
    EXPECT_NEAR(expected[i].volume, volumes[i], 1e-9);
  }
  EXPECT_EQ(std::count(map.region_of_element.begin(),
                       map.region_of_element.end(), -1),
            16);
  EXPECT_EQ(*std::max_element(map.region_of_element.begin(),
                              map.region_of_element.end()),
            1);
}

TEST(EstimateMap, SaysWhatIsNotResolved) {
  const MapScene sharp = MakeMapScene("inc5", kQuads, 16, 0.003);
  EXPECT_FALSE(
      HasFinding(EstimateMap(sharp.scene, {}), FindingCode::kNotResolved));
  const MapScene noisy = MakeMapScene("inc2", kQuads, 16, 0.05);
  const MapEstimate map = EstimateMap(noisy.scene, {});
  ASSERT_EQ(map.verdict, MapVerdict::kRegions);
  EXPECT_TRUE(HasFinding(map, FindingCode::kNotResolved));
  EXPECT_FALSE(map.regions[1].is_resolved);
}

TEST(EstimateMap, RefusesDisplacementsAgainstTheLoads) {
  MapScene truth = MakeMapScene("hom", kQuads, 6, 0.01);
  truth.scene.load_cases[0].displacement *= -1;
  const MapEstimate map = EstimateMap(truth.scene, {});
  EXPECT_FALSE(map.IsUsable());
  EXPECT_TRUE(HasFinding(map, FindingCode::kUnphysical));
}

// Displacements alone tell the ratio of the moduli.
TEST(EstimateMap, FindsRatiosWithoutLoads) {
  MapScene truth = MakeMapScene("inc5", kQuads, 12, 0);
  Scene& scene = truth.scene;
  scene.load_cases[0].loads.clear();
  // The top moves down as it was pushed, and the displacement of its nodes is
  // given.
  for (int node = 0; node < scene.mesh.NumNodes(); ++node) {
    if (scene.mesh.nodes(1, node) > 1 - 1e-9) {
      scene.supports.held.col(node).setConstant(true);
      scene.supports.displacement.col(node) =
          scene.load_cases[0].displacement.col(node);
    }
  }
  const MapEstimate map = EstimateMap(scene, {});
  ASSERT_TRUE(map.IsUsable());
  EXPECT_FALSE(map.is_scale_known);
  ASSERT_EQ(map.verdict, MapVerdict::kRegions);
  EXPECT_NEAR(map.regions[1].youngs_modulus / map.regions[0].youngs_modulus, 5,
              1e-4);
}

Scene WithField(Scene scene) {
  scene.materials.resize(1);
  scene.materials[0].fields = {"youngs_modulus"};
  return scene;
}

TEST(EstimateMap, IsAnEstimateOfIterativeFeAndAuto) {
  const MapScene truth = MakeMapScene("inc5", kQuads, 10, 0.01);
  for (const std::string name : {"iterative-fe", "auto"}) {
    const Estimate estimate =
        MakeEstimator(name)->Run(WithField(truth.scene), {});
    ASSERT_TRUE(estimate.IsUsable()) << estimate.message;
    ASSERT_TRUE(estimate.map);
    EXPECT_EQ(estimate.map->verdict, MapVerdict::kRegions);
    EXPECT_EQ(estimate.elasticity.youngs_modulus,
              estimate.map->mean_youngs_modulus);
    EXPECT_TRUE(estimate.YoungsModulusStandardError());
    EXPECT_NEAR(estimate.elasticity.youngs_modulus,
                std::exp(truth.log_moduli.mean()), 0.02);
  }
}

TEST(EstimateMap, IsRefusedWhereItMakesNoSense) {
  const Scene scene = WithField(MakeMapScene("hom", kQuads, 4, 0.01).scene);
  EXPECT_NE(
      MakeEstimator("reduced-fe")->WhyUnsupported(scene, {}).find("--map"),
      std::string::npos);
  EstimatorOptions options;
  options.poisson_ratio.upper = 0.4;
  EXPECT_NE(MakeEstimator("iterative-fe")
                ->WhyUnsupported(scene, options)
                .find("bounds"),
            std::string::npos);
  Scene of_known = scene;
  of_known.materials[0].known = {{"poisson_ratio", 0.3}};
  EXPECT_NE(
      MakeEstimator("iterative-fe")->WhyUnsupported(of_known, {}).find("--nu"),
      std::string::npos);
  Scene wrong = scene;
  wrong.materials[0].fields = {"poisson_ratio"};
  EXPECT_THROWS_WITH(ValidateScene(wrong), "only youngs_modulus");
}

}  // namespace
}  // namespace elastimate::testing
