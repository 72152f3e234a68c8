#include "elastimate/estimators/interface/kinematic_error.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <string>

#include "elastimate/core/mesh/facets.h"
#include "elastimate/estimators/registry.h"
#include "tests/scenes.h"

namespace elastimate {
namespace {

// A cube under uniaxial traction, which stretches it by `strain` and narrows it
// as a compressible neo-Hookean material, W = mu/2 (I1 - 3 - 2 ln J) +
// lambda/2 (ln J)^2, of E = 1000 and nu = 0.3.
Scene NeoHookeanCube(double strain) {
  const Mesh mesh = testing::BoxMesh({3, 3, 3}, {1, 1, 1});
  Scene scene = testing::HeldAtBottom(mesh, mesh, Eigen::Vector3d::Zero());
  constexpr double kShear = 1000 / 2.6;
  constexpr double kLame = 300 / (1.3 * 0.4);
  const double along = 1 + strain;
  // No stress across: mu (s^2 - 1) + lambda ln(s^2 along) = 0, by bisection.
  double lower = 0.5;
  double upper = 1.5;
  for (int i = 0; i < 60; ++i) {
    const double across = (lower + upper) / 2;
    const double stress = kShear * (across * across - 1) +
                          kLame * std::log(across * across * along);
    (stress > 0 ? upper : lower) = across;
  }
  const double volume = lower * lower * along;
  const double traction =
      (kShear * (along * along - 1) + kLame * std::log(volume)) / along;
  scene.supports.held.setConstant(false);
  for (Eigen::Index node = 0; node < mesh.NumNodes(); ++node) {
    for (int i = 0; i < 3; ++i) {
      scene.supports.held(i, node) = mesh.nodes(i, node) < 1e-9;
    }
  }
  const Eigen::MatrixXi facets = BoundaryFacets(mesh);
  Eigen::MatrixXi top(facets.rows(), 0);
  for (const auto& facet : facets.colwise()) {
    if ((mesh.nodes(2, facet).array() > 1 - 1e-9).all()) {
      top.conservativeResize(Eigen::NoChange, top.cols() + 1);
      top.col(top.cols() - 1) = facet;
    }
  }
  LoadCase& load_case = scene.load_cases[0];
  load_case.loads = {Traction{top, Eigen::Vector3d(0, 0, traction)}};
  load_case.displacement =
      Eigen::Vector3d(lower - 1, lower - 1, strain).asDiagonal() * mesh.nodes;
  return scene;
}

Estimate EstimateOf(const Scene& scene, const std::string& estimator) {
  return MakeEstimator(estimator)->Run(scene, {});
}

TEST(KinematicError, OfSmallStrainsIsNotMentioned) {
  Scene scene = NeoHookeanCube(0.005);
  testing::AddNoise(1e-3, 1, scene);
  const Estimate estimate = EstimateOf(scene, "auto");
  ASSERT_TRUE(estimate.IsUsable()) << estimate.message;
  EXPECT_FALSE(estimate.Has(FindingCode::kLargeDeformation));
  EXPECT_NEAR(estimate.deformation.strain, 0.005, 1e-4);
}

// One point that is far off would otherwise make strains of some per cent.
TEST(KinematicError, OfSmallStrainsIsNotMadeByAGrossError) {
  Scene scene = NeoHookeanCube(0.005);
  testing::AddNoise(1e-3, 1, scene);
  for (const double error : {0.1, 1.0}) {
    Scene wrong = scene;
    wrong.load_cases[0].displacement(2, scene.mesh.NumNodes() - 6) += error;
    const Estimate estimate = EstimateOf(wrong, "auto");
    EXPECT_FALSE(estimate.Has(FindingCode::kLargeDeformation)) << error;
    EXPECT_TRUE(estimate.large_strain_law.empty()) << error;
  }
}

TEST(KinematicError, OfModerateStrainsIsPartOfTheErrors) {
  for (const std::string estimator :
       {"closed-form", "virtual-fields", "reduced-fe", "iterative-fe"}) {
    for (const double strain : {0.03, -0.03, 0.06}) {
      Scene scene = NeoHookeanCube(strain);
      testing::AddNoise(1e-4, 1, scene);
      const Estimate estimate = EstimateOf(scene, estimator);
      SCOPED_TRACE(estimator + ", " + std::to_string(strain));
      ASSERT_TRUE(estimate.IsUsable()) << estimate.message;
      EXPECT_TRUE(estimate.Has(FindingCode::kLargeDeformation));
      EXPECT_LT(std::abs(estimate.elasticity.youngs_modulus - 1000),
                2 * *estimate.YoungsModulusStandardError());
      EXPECT_LT(std::abs(estimate.elasticity.poisson_ratio - 0.3),
                2 * *estimate.PoissonRatioStandardError());
      EXPECT_NEAR(estimate.error_budget.kinematics(0), 0.8 * std::abs(strain),
                  1e-3);
    }
  }
}

TEST(KinematicError, OfLargeStrainsIsTheReasonToRefuse) {
  for (const std::string estimator :
       {"closed-form", "reduced-fe", "iterative-fe"}) {
    Scene scene = NeoHookeanCube(0.2);
    testing::AddNoise(1e-3, 1, scene);
    const Estimate estimate = EstimateOf(scene, estimator);
    EXPECT_FALSE(estimate.IsUsable()) << estimator;
    EXPECT_EQ(estimate.findings[0].code, FindingCode::kLargeDeformation)
        << estimator << ": " << estimate.message;
  }
}

// With nu given, E alone has to be within its limit.
TEST(KinematicError, OfAGivenPoissonRatioIsThatOfEAlone) {
  Scene scene = NeoHookeanCube(0.1);
  testing::AddNoise(1e-3, 1, scene);
  EstimatorOptions options;
  EXPECT_FALSE(MakeEstimator("reduced-fe")->Run(scene, options).IsUsable());
  options.known_poisson_ratio = 0.3;
  const Estimate estimate = MakeEstimator("reduced-fe")->Run(scene, options);
  EXPECT_TRUE(estimate.IsUsable()) << estimate.message;
}

TEST(KinematicError, AsksForTheUnitOfImpossibleStrains) {
  Scene scene = NeoHookeanCube(0.003);
  scene.load_cases[0].displacement *= 1000;  // In mm, of a cube in m.
  const Estimate estimate = EstimateOf(scene, "auto");
  ASSERT_EQ(estimate.findings[0].code, FindingCode::kLargeDeformation)
      << estimate.message;
  EXPECT_NE(estimate.message.find("unit"), std::string::npos);
  // No law of large strains follows displacements that turn everything inside
  // out.
  scene.load_cases[0].displacement *= 3;
  scene.materials.resize(1);
  scene.materials[0].law = "neo_hookean";
  const Estimate of_law = EstimateOf(scene, "iterative-fe");
  EXPECT_FALSE(of_law.IsUsable());
  EXPECT_TRUE(of_law.Has(FindingCode::kLargeDeformation));
}

// One stretch alone tells no law from another.
TEST(KinematicError, OfRubberIsNotThatOfAnotherUnit) {
  Scene scene = NeoHookeanCube(1.5);
  scene.load_cases.push_back(NeoHookeanCube(0.25).load_cases[0]);
  testing::AddNoise(1e-3, 1, scene);
  const Estimate estimate = EstimateOf(scene, "auto");
  ASSERT_EQ(estimate.status, Status::kOk) << estimate.message;
  EXPECT_EQ(estimate.large_strain_law, "neo_hookean");
  EXPECT_NEAR(estimate.elasticity.youngs_modulus, 1000,
              3 * *estimate.YoungsModulusStandardError());
  EXPECT_NEAR(estimate.elasticity.poisson_ratio, 0.3,
              3 * *estimate.PoissonRatioStandardError());
  // Whoever gave another unit reads of it.
  bool asks_for_unit = false;
  for (const Finding& finding : estimate.findings) {
    asks_for_unit =
        asks_for_unit || finding.advice.find("unit") != std::string::npos;
  }
  EXPECT_TRUE(asks_for_unit);
}

TEST(NegativePoissonRatio, AsksForSigns) {
  for (const bool is_flipped : {false, true}) {
    Scene scene = NeoHookeanCube(0.003);
    if (is_flipped) {
      scene.load_cases[0].displacement.topRows(2) *= -1;
    }
    testing::AddNoise(1e-3, 1, scene);
    const Estimate estimate = EstimateOf(scene, "reduced-fe");
    ASSERT_TRUE(estimate.IsUsable()) << estimate.message;
    EXPECT_EQ(estimate.Has(FindingCode::kNegativePoissonRatio), is_flipped);
  }
}

// A cube whose top turned as a rigid face about y, and may have slid along y.
bool IsWarnedOf(double angle, const std::string& law, bool may_slide) {
  Scene scene = NeoHookeanCube(0.1);
  scene.materials.resize(1);
  scene.materials[0].law = law;
  RigidFace top = {{},
                   Eigen::Array<bool, Eigen::Dynamic, 1>::Constant(3, true)};
  top.components(1) = !may_slide;
  for (int node = 0; node < scene.mesh.NumNodes(); ++node) {
    if (scene.mesh.nodes(2, node) > 1 - 1e-9) {
      top.nodes.push_back(node);
    }
  }
  scene.supports.rigid_faces = {top};
  Estimate estimate;
  const Eigen::AngleAxisd turn(angle, Eigen::Vector3d::UnitY());
  estimate.fitted_displacement =
      (turn.toRotationMatrix() * scene.mesh.nodes - scene.mesh.nodes)
          .reshaped();
  JudgeRigidFaces(scene, estimate);
  return estimate.Has(FindingCode::kRigidFaceTurned);
}

TEST(RigidFaceTurned, IsSaidOfFacesThatTurnByLinearModes) {
  EXPECT_TRUE(IsWarnedOf(0.1, "neo_hookean", true));
  EXPECT_FALSE(IsWarnedOf(0.03, "neo_hookean", true));
  EXPECT_FALSE(IsWarnedOf(0.1, "neo_hookean", false));
  EXPECT_FALSE(IsWarnedOf(0.1, "isotropic", true));
}

}  // namespace
}  // namespace elastimate
