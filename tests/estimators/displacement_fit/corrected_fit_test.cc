#include "elastimate/estimators/displacement_fit/corrected_fit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>
#include <vector>

#include "elastimate/core/equilibrium/hierarchical_error.h"
#include "elastimate/core/mesh/facets.h"
#include "elastimate/core/scene/quadratic_scene.h"
#include "elastimate/core/scene/simplicial_scene.h"
#include "elastimate/estimators/registry.h"
#include "tests/element_kinds.h"
#include "tests/regions.h"
#include "tests/scenes.h"
#include "tests/shapes.h"

namespace elastimate {
namespace {

constexpr IsotropicElasticity kBarTruth = {12000, 0.4};

// A coarse bar of quadratic elements that bends under its weight.
Scene BentBar() {
  Scene scene;
  scene.mesh = testing::Distorted(testing::BoxMesh({4, 2, 2}, {2, 1, 1}));
  const Eigen::Index num_nodes = scene.mesh.NumNodes();
  scene.supports.held = ComponentMask::Constant(3, num_nodes, false);
  scene.supports.displacement = Eigen::MatrixXd::Zero(3, num_nodes);
  for (Eigen::Index node = 0; node < num_nodes; ++node) {
    scene.supports.held.col(node).setConstant(scene.mesh.nodes(0, node) < 0.01);
  }
  LoadCase load_case;
  load_case.loads = {BodyForce{Eigen::Vector3d(20, -5, -3)}};
  scene.load_cases = {load_case};
  return QuadraticScene(scene);
}

class CorrectedFitOf : public ::testing::TestWithParam<std::string_view> {};

TEST_P(CorrectedFitOf, IsThatOfFinerElementsWhereTheseWereMeasured) {
  Scene scene = BentBar();
  Scene finer = SimplicialScene(scene);
  MeasureInFinerWorld(kBarTruth, finer);
  scene.load_cases[0].displacement =
      finer.load_cases[0].displacement.leftCols(scene.mesh.NumNodes());
  scene.is_of_linear_elasticity = true;
  const Estimate estimate = MakeEstimator(GetParam())->Run(scene, {});
  ASSERT_EQ(estimate.status, Status::kOk) << estimate.message;
  ASSERT_TRUE(estimate.discretization_correction);
  const double error =
      estimate.elasticity.youngs_modulus / kBarTruth.youngs_modulus - 1;
  const double correction = (*estimate.discretization_correction)(0);
  EXPECT_GT(std::abs(correction), 0.005);
  // What finer elements change is known to that.
  EXPECT_LT(std::abs(error),
            2 * HierarchicalError::kTolerance * std::abs(correction));
  EXPECT_LT(std::abs(error), 2 * *estimate.YoungsModulusStandardError() /
                                 kBarTruth.youngs_modulus);
  EXPECT_LT(
      std::abs(estimate.elasticity.poisson_ratio - kBarTruth.poisson_ratio),
      2 * *estimate.PoissonRatioStandardError());
  // They come from the measurement as it is.
  EXPECT_GT(*estimate.displacement_residual, 1e-4);
}

// What finer elements change grows with nu: at the nu that linear ones fit, it
// is half of what it is at the true one.
TEST_P(CorrectedFitOf, IsThatOfQuadraticElementsWhereLinearOnesAreTooStiff) {
  constexpr IsotropicElasticity kTruth = {5000, 0.45};
  Scene scene = testing::BlockUnderTraction({7, 7, 7}, {1, 1, 1});
  testing::MeasureInFinerWorld(kTruth, scene);
  const Estimate estimate = MakeEstimator(GetParam())->Run(scene, {});
  ASSERT_EQ(estimate.status, Status::kOk) << estimate.message;
  ASSERT_TRUE(estimate.discretization_correction);
  const double error = estimate.elasticity.poisson_ratio - kTruth.poisson_ratio;
  const double correction = (*estimate.discretization_correction)(1);
  EXPECT_GT(correction, 0.02);
  EXPECT_LT(std::abs(error), 0.1 * correction);
}

// Those of the boundary of which all nodes are so.
template <class Condition>
Eigen::MatrixXi FacetsWhere(const Mesh& mesh, const Condition& is_so) {
  const Eigen::MatrixXi facets = BoundaryFacets(mesh);
  std::vector<Eigen::Index> chosen;
  for (Eigen::Index i = 0; i < facets.cols(); ++i) {
    const auto nodes = facets.col(i);
    if (std::all_of(nodes.begin(), nodes.end(),
                    [&](int node) { return is_so(mesh.nodes.col(node)); })) {
      chosen.push_back(i);
    }
  }
  return facets(Eigen::all, chosen);
}

// A column of one or two elements across, twisted by forces on two sides of its
// end: linear elements are four times too stiff, and fit it with nu next to
// 1/2.
Scene TwistedColumn(const Eigen::Vector3i& cells, const Eigen::Vector3d& size) {
  const Mesh mesh = testing::BoxMesh(cells, size);
  Scene scene = testing::HeldAtBottom(mesh, mesh, Eigen::Vector3d::Zero());
  scene.load_cases[0].loads.clear();
  const double end = size(2) * (1 - 1.01 / cells(2));
  for (const double side : {0.0, size(1)}) {
    scene.load_cases[0].loads.push_back(SurfaceForce{
        FacetsWhere(mesh,
                    [&](const auto& node) {
                      return std::abs(node(1) - side) < 1e-9 && node(2) > end;
                    }),
        Eigen::Vector3d(side == 0 ? 0.1 : -0.1, 0, 0)});
  }
  return scene;
}

// That E is within so many of its standard errors.
bool IsRefusedOrHolds(const Estimate& estimate, double youngs_modulus,
                      double errors) {
  return !estimate.IsUsable() ||
         std::abs(estimate.elasticity.youngs_modulus - youngs_modulus) <
             errors * *estimate.YoungsModulusStandardError();
}

class LockedFitStatistics : public ::testing::TestWithParam<std::string_view> {
};

TEST_P(LockedFitStatistics, IsNotTakenForASpecimen) {
  constexpr int kSeeds = 2;
  const Eigen::Vector3i thin(1, 1, 5);
  const Eigen::Vector3i thick(2, 2, 5);
  for (const Eigen::Vector3i& cells : {thin, thick}) {
    Scene exact = TwistedColumn(cells, 0.3 * cells.cast<double>());
    testing::MeasureInFinerWorld({1000, 0.2}, exact);
    for (int seed = 1; seed <= kSeeds; ++seed) {
      Scene measured = exact;
      testing::AddNoise(0.05, seed, measured);
      const Estimate estimate = MakeEstimator(GetParam())->Run(measured, {});
      EXPECT_TRUE(IsRefusedOrHolds(estimate, 1000, 3.5))
          << cells.transpose() << ", seed " << seed << ": "
          << estimate.elasticity.youngs_modulus;
    }
  }
}

// Three quarters of a turn, of these cells across and along, with a pressure of
// 1 from above.
Scene Helix(const Eigen::Vector3i& cells) {
  const Mesh mesh = testing::BoxMesh(cells, {1, 1, 1});
  Scene scene = testing::HeldAtBottom(mesh, mesh, Eigen::Vector3d::Zero());
  scene.load_cases[0].loads = {Pressure{
      FacetsWhere(mesh, [](const auto& node) { return node(1) > 1 - 1e-9; }),
      1}};
  for (Eigen::Index node = 0; node < mesh.NumNodes(); ++node) {
    const Eigen::Vector3d at = mesh.nodes.col(node);
    const double angle = 5 * at(2);
    const double radius = 1.4 + at(0);
    scene.mesh.nodes.col(node) << radius * std::cos(angle),
        radius * std::sin(angle), 0.72 * at(1) + 2.15 * at(2);
  }
  return scene;
}

// Linear elements ten times too stiff fit it with a nu far from 0.3 as well.
TEST_P(LockedFitStatistics, IsNotTakenForASpecimenOfAnotherPoissonRatio) {
  for (const int length : {8, 11}) {
    Scene exact = Helix({2, 1, length});
    testing::MeasureInFinerWorld({1000, 0}, exact);
    for (const double noise : {0.05, 0.12}) {
      Scene measured = exact;
      testing::AddNoise(noise, 1, measured);
      const Estimate estimate = MakeEstimator(GetParam())->Run(measured, {});
      EXPECT_TRUE(IsRefusedOrHolds(estimate, 1000, 3.5))
          << length << " cells, noise " << noise << ": "
          << estimate.elasticity.youngs_modulus;
    }
  }
}

// Hexahedra three times too stiff bend as the specimen does, so that nothing
// but their stiffness tells them from it.
TEST_P(LockedFitStatistics, IsNotTakenForASpecimenOfAKnownPoissonRatio) {
  constexpr IsotropicElasticity kTruth = {10000, 0.2};
  EstimatorOptions options;
  options.known_poisson_ratio = kTruth.poisson_ratio;
  for (const int cells : {3, 4}) {
    Scene exact =
        testing::SceneOfKind({ElementKind::kHex8, SectionModel::kSolid}, cells);
    exact.mesh.nodes.row(2) *= 4;
    exact.load_cases[0].loads = {BodyForce{Eigen::Vector3d(1e-3, 0, 0)}};
    testing::MeasureInCutWorld(kTruth, exact);
    for (const double noise : {0.01, 0.03, 0.1}) {
      Scene measured = exact;
      testing::AddNoise(noise, 1, measured);
      const Estimate estimate =
          MakeEstimator(GetParam())->Run(measured, options);
      EXPECT_TRUE(IsRefusedOrHolds(estimate, kTruth.youngs_modulus, 3.5))
          << cells << " cells, noise " << noise << ": "
          << estimate.elasticity.youngs_modulus;
    }
  }
}

class CorrectedFitStatistics : public CorrectedFitOf {};

// In torsion nu shows in little but what finer elements change, which as a
// function of nu takes up what nu does: with nu = 0 a fit that starts at 0.3
// stays there, 0.34 +- 0.11 at 1 % of noise.
TEST_P(CorrectedFitStatistics, KnowsNoPoissonRatioThatElementsTakeUp) {
  constexpr IsotropicElasticity kTruth = {5000, 0};
  const Scene linear = testing::ShapeScene("dumbbell", "torsion");
  Scene exact = QuadraticScene(linear);
  Scene finer = QuadraticScene(SimplicialScene(exact));
  testing::Measure(kTruth, finer);
  const Eigen::Index num_nodes = exact.mesh.NumNodes();
  exact.is_of_linear_elasticity = true;
  LoadCase& load_case = exact.load_cases[0];
  load_case.displacement = finer.load_cases[0].displacement.leftCols(num_nodes);
  load_case.observed = ComponentMask::Constant(3, num_nodes, false);
  load_case.observed.leftCols(linear.mesh.NumNodes()).setConstant(true);
  const std::vector<std::pair<double, int>> draws = {{0.01, 17}, {0.02, 15}};
  for (const auto& [noise, seed] : draws) {
    Scene measured = exact;
    testing::AddNoise(noise, seed, measured);
    const Estimate estimate = MakeEstimator(GetParam())->Run(measured, {});
    EXPECT_TRUE(!estimate.IsUsable() ||
                std::abs(estimate.elasticity.poisson_ratio) <
                    3 * estimate.PoissonRatioStandardError().value_or(0))
        << noise << ", seed " << seed << ": "
        << estimate.elasticity.poisson_ratio;
  }
}

// So it is with linear elements: what shows of the change from them is as much
// as it is at nu = 0.3, and next to nothing at 0, which much noise tells apart
// by chance only.
TEST_P(LockedFitStatistics, KnowsNoPoissonRatioThatTheChangeTakesUp) {
  constexpr IsotropicElasticity kTruth = {5000, 0};
  Scene exact = testing::ShapeScene("bracket", "torsion");
  testing::MeasureInRefinedWorld(kTruth, exact);
  for (const double noise : {0.05, 0.1}) {
    for (const int seed : {2}) {
      Scene measured = exact;
      testing::AddNoise(noise, seed, measured);
      const Estimate estimate = MakeEstimator(GetParam())->Run(measured, {});
      EXPECT_TRUE(IsRefusedOrHolds(estimate, 5000, 3))
          << noise << ", seed " << seed << ": "
          << estimate.elasticity.youngs_modulus;
    }
  }
}

// Cubes of six tetrahedra each sway under a weight along their axis, except
// where lambda = mu: linear elements that do not are of nu = 0.26, whatever the
// specimen has, and finer ones take away the sway at any nu.
TEST_P(LockedFitStatistics, KnowsNoPoissonRatioThatTheElementsPrescribe) {
  const Eigen::Vector3i cells(2, 2, 10);
  const Mesh mesh = testing::BoxMesh(cells, {2, 2, 15});
  Scene scene = testing::HeldAtBottom(mesh, mesh, Eigen::Vector3d::Zero());
  scene.load_cases[0].loads = {BodyForce{Eigen::Vector3d(0, 0, -10)}};
  for (const double nu : {0.1, 0.4}) {
    Scene exact = scene;
    testing::MeasureInRefinedWorld({5000, nu}, exact);
    for (const double noise : {0.0, 0.01, 0.1}) {
      Scene measured = exact;
      testing::AddNoise(noise, 1, measured);
      const Estimate estimate = MakeEstimator(GetParam())->Run(measured, {});
      EXPECT_TRUE(!estimate.IsUsable() ||
                  std::abs(estimate.elasticity.poisson_ratio - nu) <
                      3 * estimate.PoissonRatioStandardError().value_or(0))
          << nu << ", noise " << noise << ": "
          << estimate.elasticity.poisson_ratio;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Estimators, LockedFitStatistics,
                         ::testing::Values("reduced-fe", "iterative-fe",
                                           "auto"));

// Of two rows more than there are parameters no noise is estimated, and nothing
// is corrected; orders are still compared by what they leave.
TEST_P(CorrectedFitOf, HasTheResidualOfTooFewMeasurements) {
  Scene scene = BentBar();
  testing::Measure(kBarTruth, scene);
  testing::AddNoise(0.01, 1, scene);
  LoadCase& load_case = scene.load_cases[0];
  load_case.observed = ComponentMask::Constant(3, scene.mesh.NumNodes(), false);
  load_case.observed.col(scene.mesh.NumNodes() - 1).setConstant(true);
  load_case.observed(0, scene.mesh.NumNodes() - 2) = true;
  const Estimate estimate = MakeEstimator(GetParam())->Run(scene, {});
  ASSERT_TRUE(estimate.Has(FindingCode::kTooFewMeasurements))
      << estimate.message;
  EXPECT_NEAR(*estimate.bounded_residual, *estimate.displacement_residual,
              1e-12);
}

TEST_P(CorrectedFitOf, SaysThatItDidNotCorrectWhatIsTooCoarse) {
  Scene scene = testing::BlockUnderTraction({4, 4, 12}, {1, 1, 3});
  testing::MeasureInFinerWorld({5000, 0.45}, scene);
  const Estimate estimate = MakeEstimator(GetParam())->Run(scene, {});
  ASSERT_EQ(estimate.status, Status::kNotIdentifiable);
  ASSERT_TRUE(estimate.discretization_correction);
  EXPECT_EQ(*estimate.discretization_correction, Eigen::Vector2d::Zero());
}

TEST_P(CorrectedFitOf, IsTheFitWhereItsElementsWereMeasured) {
  Scene scene = BentBar();
  testing::Measure(kBarTruth, scene);
  const Estimate estimate = MakeEstimator(GetParam())->Run(scene, {});
  ASSERT_EQ(estimate.status, Status::kOk) << estimate.message;
  EXPECT_NEAR(estimate.elasticity.youngs_modulus / kBarTruth.youngs_modulus, 1,
              1e-6);
  EXPECT_NEAR(estimate.elasticity.poisson_ratio, kBarTruth.poisson_ratio, 1e-6);
}

INSTANTIATE_TEST_SUITE_P(Estimators, CorrectedFitOf,
                         ::testing::Values("reduced-fe", "iterative-fe"));
INSTANTIATE_TEST_SUITE_P(Estimators, CorrectedFitStatistics,
                         ::testing::Values("reduced-fe", "iterative-fe"));

TEST(CorrectedFit, HasTheIntervalOfItsRivalToo) {
  const Profile of_fit = {{2, 0.2}, {1, 0.3}};
  CorrectedFit corrected;
  EXPECT_EQ(corrected.WithRival(of_fit).lower.poisson_ratio, 0.2);
  corrected.rival = Profile{{4, -0.1}, {3, 0.1}};
  const Profile both = corrected.WithRival(of_fit);
  EXPECT_EQ(both.lower.poisson_ratio, -0.1);
  EXPECT_EQ(both.lower.youngs_modulus, 4);
  EXPECT_EQ(both.upper.poisson_ratio, 0.3);
  EXPECT_EQ(both.upper.youngs_modulus, 1);
}

}  // namespace
}  // namespace elastimate
