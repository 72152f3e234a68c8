// Fits of measured displacements by finer and finer elements.

#include "elastimate/estimators/material_fit/refined_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "elastimate/core/equilibrium/simulated_measurement.h"
#include "elastimate/core/scene/finer_scene.h"
#include "elastimate/core/scene/quadratic_scene.h"
#include "elastimate/estimators/registry.h"
#include "tests/element_kinds.h"
#include "tests/regions.h"
#include "tests/scenes.h"
#include "tests/shapes.h"

namespace elastimate {
namespace {

using testing::AddNoise;
using testing::KindOfSection;

constexpr IsotropicElasticity kSpecimen = {5e4, 0.35};

Estimate Fitted(const Scene& scene, const EstimatorOptions& options = {},
                const std::string& estimator = "reduced-fe") {
  return MakeEstimator(estimator)->Run(scene, options);
}

void ExpectToHold(const IsotropicElasticity& truth, const Estimate& estimate) {
  ASSERT_EQ(estimate.status, Status::kOk) << estimate.message;
  EXPECT_LT(std::abs(estimate.elasticity.youngs_modulus - truth.youngs_modulus),
            3 * *estimate.YoungsModulusStandardError());
  EXPECT_LT(std::abs(estimate.elasticity.poisson_ratio - truth.poisson_ratio),
            3 * *estimate.PoissonRatioStandardError());
}

// The strains are small, as the loads are.
Scene Block(const Eigen::Vector3i& cells) {
  Scene scene = testing::BlockUnderTraction(cells, {1, 1, 2});
  scene.load_cases[0].loads = {BodyForce{Eigen::Vector3d(40, 0, -80)}};
  return scene;
}

class RefinedFitOfKinds : public ::testing::TestWithParam<KindOfSection> {};

TEST_P(RefinedFitOfKinds, HoldsTheTruthOfAFinerSpecimen) {
  Scene scene = testing::SceneOfKind(GetParam());
  scene.load_cases[0].loads = {
      BodyForce{Eigen::VectorXd::Constant(scene.mesh.Dimension(), 30)}};
  testing::MeasureInCutWorld(kSpecimen, scene);
  AddNoise(0.003, 1, scene);
  const Estimate estimate = Fitted(scene);
  ExpectToHold(kSpecimen, estimate);
  EXPECT_EQ(estimate.element_order, 2);
  EXPECT_GT(*estimate.discretization_error, 0);
  EXPECT_GT(estimate.error_budget.noise(0), 0);
}

INSTANTIATE_TEST_SUITE_P(LinearSolids, RefinedFitOfKinds,
                         ::testing::ValuesIn(testing::KindsOf(3, 1)),
                         testing::KindTestName);
INSTANTIATE_TEST_SUITE_P(QuadraticSolidsLong, RefinedFitOfKinds,
                         ::testing::ValuesIn(testing::KindsOf(3, 2)),
                         testing::KindTestName);
INSTANTIATE_TEST_SUITE_P(LinearPlanes, RefinedFitOfKinds,
                         ::testing::ValuesIn(testing::KindsOf(2, 1)),
                         testing::KindTestName);
INSTANTIATE_TEST_SUITE_P(QuadraticPlanes, RefinedFitOfKinds,
                         ::testing::ValuesIn(testing::KindsOf(2, 2)),
                         testing::KindTestName);

TEST(RefinedFit, OfBothDescentsIsTheSame) {
  Scene scene = Block({2, 2, 4});
  testing::MeasureInCutWorld(kSpecimen, scene);
  AddNoise(0.003, 1, scene);
  const Estimate reduced = Fitted(scene);
  const Estimate iterative = Fitted(scene, {}, "iterative-fe");
  ExpectToHold(kSpecimen, iterative);
  const double error = *reduced.YoungsModulusStandardError();
  EXPECT_NEAR(reduced.elasticity.youngs_modulus,
              iterative.elasticity.youngs_modulus, 0.05 * error);
  EXPECT_NEAR(*iterative.YoungsModulusStandardError(), error, 0.05 * error);
}

// Iterations over nested spaces do not converge next to nu = 1/2, where the
// coarser elements have to be compared all the same.
TEST(RefinedFit, NextToIncompressibleTheMeshErrorIsKnown) {
  Scene scene = Block({2, 2, 4});
  testing::MeasureInCutWorld({5e4, 0.49999}, scene);
  const Estimate estimate = Fitted(scene);
  EXPECT_GT(estimate.elasticity.poisson_ratio, 0.49);
  EXPECT_FALSE(estimate.Has(FindingCode::kMeshErrorUnknown));
  EXPECT_FALSE(estimate.Has(FindingCode::kNumericalFailure));
}

// Systems of thin bodies take more than a hundred iterations.
TEST(RefinedFit, OfAThinBodyIsCertified) {
  Scene scene = testing::ShapeScene("dome", "tension");
  MeasureInFinerWorld({5e4, 0}, scene);
  AddNoise(0.01, 1, scene);
  EstimatorOptions options;
  options.refinement = Refine::kNever;
  options.kinematics = Kinematics::kSmall;
  const Estimate estimate = Fitted(scene, options);
  EXPECT_FALSE(estimate.Has(FindingCode::kFitNotCertified)) << estimate.message;
  // Linear elements of this body lock, so that seven values of nu are looked at
  // as well, and descents begin at some of them.
  EXPECT_LE(estimate.work.factorizations, 12 + 7 + 12);
}

// Linear elements of a bent plate lock, and end next to nu = 1/2.  From there,
// quadratic ones descend to a minimum on the wrong side of nu = 0.
TEST(RefinedFit, OfABentPlateTellsTheSignOfNu) {
  const Mesh plate = testing::BoxMesh({1, 2, 8}, {0.5, 2, 10});
  Scene scene = testing::HeldAtBottom(plate, plate, {0.01, 0, 0});
  for (const double nu : {-0.45, -0.3, 0.3}) {
    const IsotropicElasticity truth = {5e4, nu};
    testing::MeasureInCutWorld(truth, scene);
    AddNoise(0.01, 1, scene);
    const Estimate estimate = Fitted(scene);
    SCOPED_TRACE(nu);
    ExpectToHold(truth, estimate);
    EXPECT_LT(*estimate.PoissonRatioStandardError(), 0.2);
  }
}

TEST(RefinedFit, DividesTheMeshAsOftenAsIsAskedFor) {
  Scene scene = Block({2, 2, 4});
  testing::MeasureInCutWorld(kSpecimen, scene);
  AddNoise(0.003, 1, scene);
  EstimatorOptions options;
  options.refinement = Refine::kNever;
  const Estimate never = Fitted(scene, options);
  options.refinement = Refine::kAlways;
  const Estimate always = Fitted(scene, options);
  ExpectToHold(kSpecimen, always);
  EXPECT_EQ(never.mesh_divisions, 0);
  EXPECT_EQ(always.mesh_divisions, 1);
  EXPECT_GT(*never.discretization_error, 3 * *always.discretization_error);
  options.refinement = Refine::kAutomatic;
  EXPECT_EQ(Fitted(scene, options).mesh_divisions, 1);
}

// Where noise is all that matters, a divided mesh would tell nothing.
TEST(RefinedFit, KeepsTheMeshWhereNoiseMattersMore) {
  const KindOfSection plane = {ElementKind::kTri3, SectionModel::kPlaneStress};
  Scene scene = testing::SceneOfKind(plane, 24);
  scene.load_cases[0].loads = {BodyForce{Eigen::Vector2d(30, 30)}};
  testing::MeasureInCutWorld(kSpecimen, scene);
  AddNoise(0.3, 1, scene);
  const Estimate estimate = Fitted(scene);
  ExpectToHold(kSpecimen, estimate);
  EXPECT_EQ(estimate.mesh_divisions, 0);
  EXPECT_GE(*estimate.discretization_error, 0.005);
}

TEST(RefinedFitOfSpecialScenes, OfTwoRegionsHoldsBoth) {
  Scene scene = Block({2, 2, 4});
  testing::DivideIntoRegions({1, 1, 2}, {1, 1, 2}, scene);
  Scene finer = FinerScene(FinerScene(scene));
  const Eigen::Vector4d truth(5e4, 0.35, 1e5, 0.2);
  MeasureMaterials(truth, finer);
  testing::TakeDisplacements(finer, scene);
  AddNoise(0.002, 1, scene);
  const Estimate estimate = Fitted(scene);
  ASSERT_EQ(estimate.status, Status::kOk) << estimate.message;
  for (Eigen::Index i = 0; i < truth.size(); ++i) {
    const ParameterEstimate& parameter = estimate.parameters[i];
    EXPECT_LT(std::abs(parameter.value - truth(i)),
              3 * *parameter.standard_error)
        << parameter.Label();
    EXPECT_GT(estimate.error_budget.discretization(i), 0);
  }
}

// Neighbours are those of the mesh that was measured.
TEST(RefinedFitOfSpecialScenes, SeesThatTheMaterialIsNotTheSameAllOver) {
  Scene scene = Block({2, 2, 4});
  Scene of_two = scene;
  testing::DivideIntoRegions({1, 1, 2}, {1, 1, 2}, of_two);
  Scene finer = FinerScene(FinerScene(of_two));
  MeasureMaterials(Eigen::Vector4d(5e4, 0.35, 1e5, 0.2), finer);
  testing::TakeDisplacements(finer, scene);
  AddNoise(0.002, 1, scene);
  const Estimate estimate = Fitted(scene);
  EXPECT_TRUE(estimate.is_model_in_doubt);
  EXPECT_GT(estimate.error_budget.model(0), 0);
}

TEST(RefinedFit, RefusesWhatLinearElementsComputed) {
  for (const double noise : {0.0, 0.05}) {
    Scene scene = testing::SmallScene("organ");
    Measure(kSpecimen, scene);
    if (noise > 0) {
      AddNoise(noise, 1, scene);
    }
    scene.origin = Origin::kMeasured;
    const Estimate estimate = Fitted(scene);
    EXPECT_EQ(estimate.status, Status::kNotIdentifiable);
    EXPECT_TRUE(estimate.Has(FindingCode::kComputedByLinearElements))
        << estimate.message;
  }
}

// A bound that the data contradict is no sign of linear elements.
TEST(RefinedFit, TakesNoBoundForLinearElements) {
  Scene scene = Block({2, 2, 4});
  testing::MeasureInCutWorld(kSpecimen, scene);
  AddNoise(0.003, 1, scene);
  EstimatorOptions options;
  options.youngs_modulus.upper = kSpecimen.youngs_modulus / 2;
  EXPECT_FALSE(
      Fitted(scene, options).Has(FindingCode::kComputedByLinearElements));
}

TEST(RefinedFitOfSpecialScenes, OfAGivenRatioKnowsItsMeshError) {
  Scene scene = Block({2, 2, 4});
  testing::MeasureInCutWorld(kSpecimen, scene);
  AddNoise(0.003, 1, scene);
  EstimatorOptions options;
  options.known_poisson_ratio = kSpecimen.poisson_ratio;
  const Estimate estimate = Fitted(scene, options);
  ASSERT_EQ(estimate.status, Status::kOk) << estimate.message;
  EXPECT_LT(
      std::abs(estimate.elasticity.youngs_modulus - kSpecimen.youngs_modulus),
      3 * *estimate.YoungsModulusStandardError());
  EXPECT_GT(*estimate.discretization_error, 0);
  EXPECT_FALSE(estimate.Has(FindingCode::kMeshErrorUnknown));
}

TEST(RefinedFitOfSpecialScenes, WithALossWithstandsOutliers) {
  Scene scene = Block({2, 2, 4});
  testing::MeasureInCutWorld(kSpecimen, scene);
  MeasurementErrors errors;
  errors.relative_noise = 0.005;
  errors.law = NoiseLaw::kGaussian;
  errors.outliers = 0.1;
  std::mt19937_64 generator(3);
  AddErrors(errors, scene.mesh.nodes, scene.supports.held, generator,
            scene.load_cases[0].displacement);
  EstimatorOptions options;
  options.loss = Loss::kHuber;
  const Estimate huber = Fitted(scene, options);
  ExpectToHold(kSpecimen, huber);
  EXPECT_TRUE(huber.outliers.empty());
  const Estimate left_out = Fitted(scene);
  ExpectToHold(kSpecimen, left_out);
  EXPECT_FALSE(left_out.outliers.empty());
}

TEST(RefinedFitOfSpecialScenes, OfQuadraticElementsDividesThem) {
  Scene scene = Block({1, 1, 2});
  Scene quadratic = QuadraticScene(scene);
  testing::MeasureInCutWorld(kSpecimen, quadratic);
  AddNoise(0.003, 1, quadratic);
  const Estimate estimate = Fitted(quadratic);
  ExpectToHold(kSpecimen, estimate);
  EXPECT_EQ(estimate.mesh_divisions, 1);
}

// A bar that a clamp holds from x = 0 to beyond the middle of the edges around
// its end, of which the mask of its nodes does not tell.
TEST(RefinedFitOfSpecialScenesLong, HoldsWhatTheEndOfASupportLeavesOpen) {
  Scene scene;
  scene.mesh = testing::BoxMesh({10, 3, 3}, {3, 1, 1});
  const Eigen::Index num_nodes = scene.mesh.NumNodes();
  constexpr double kEnd = 0.5;
  const HeldBox clamp = {
      Eigen::Vector3d(-1, -1, -1), Eigen::Vector3d(kEnd, 2, 2),
      Eigen::Array3<bool>::Constant(true), Eigen::Vector3d::Zero()};
  scene.supports = {ComponentMask::Constant(3, num_nodes, false),
                    Eigen::MatrixXd::Zero(3, num_nodes),
                    {clamp}};
  for (Eigen::Index node = 0; node < num_nodes; ++node) {
    scene.supports.held.col(node).setConstant(scene.mesh.nodes(0, node) <=
                                              kEnd);
  }
  LoadCase load_case;
  load_case.loads = {BodyForce{Eigen::Vector3d(40, -5, -3)}};
  scene.load_cases = {load_case};
  testing::MeasureInCutWorld(kSpecimen, scene);
  const Estimate of_box = Fitted(scene);
  ExpectToHold(kSpecimen, of_box);
  scene.supports.boxes.clear();
  const Estimate of_mask = Fitted(scene);
  ASSERT_EQ(of_mask.parameters.size(), 2U);
  EXPECT_TRUE(of_mask.Has(FindingCode::kSupportsEndWithinElements));
  ExpectToHold(kSpecimen, of_mask);
  EXPECT_GT(*of_mask.YoungsModulusStandardError(),
            *of_box.YoungsModulusStandardError());
}

// A bar of four by one (by one), of so many cells along each axis, that is held
// at x = 0 and bent by its weight.
Scene BentBar(const std::vector<int>& cells) {
  const auto dimension = Eigen::Index(cells.size());
  std::vector<Eigen::Index> num_nodes;
  std::vector<Eigen::Index> steps = {1};
  for (const int along : cells) {
    num_nodes.push_back(along + 1);
    steps.push_back(steps.back() * (along + 1));
  }
  Scene scene;
  scene.mesh.kind = dimension == 3 ? ElementKind::kHex8 : ElementKind::kQuad4;
  scene.mesh.section.model =
      dimension == 3 ? SectionModel::kSolid : SectionModel::kPlaneStrain;
  scene.mesh.nodes.resize(dimension, steps.back());
  std::vector<int> first_nodes;
  for (Eigen::Index node = 0; node < steps.back(); ++node) {
    bool is_first = true;
    for (Eigen::Index k = 0; k < dimension; ++k) {
      const Eigen::Index place = node / steps[k] % num_nodes[k];
      scene.mesh.nodes(k, node) = (k == 0 ? 4.0 : 1.0) * place / cells[k];
      is_first = is_first && place < cells[k];
    }
    if (is_first) {
      first_nodes.push_back(static_cast<int>(node));
    }
  }
  scene.mesh.elements.resize(scene.mesh.Topology().num_nodes,
                             Eigen::Index(first_nodes.size()));
  for (Eigen::Index i = 0; i < scene.mesh.elements.rows(); ++i) {
    const Eigen::Index away = (i % 4 == 1 || i % 4 == 2 ? steps[0] : 0) +
                              (i % 4 >= 2 ? steps[1] : 0) +
                              (i >= 4 ? steps[2] : 0);
    for (Eigen::Index e = 0; e < scene.mesh.NumElements(); ++e) {
      scene.mesh.elements(i, e) = first_nodes[e] + static_cast<int>(away);
    }
  }
  scene.supports.held =
      (scene.mesh.nodes.row(0).array() == 0).replicate(dimension, 1);
  scene.supports.displacement =
      Eigen::MatrixXd::Zero(dimension, scene.mesh.NumNodes());
  scene.load_cases.resize(1);
  BodyForce weight = {Eigen::VectorXd::Constant(dimension, 1)};
  weight.force_density(dimension - 1) = -2;
  scene.load_cases[0].loads = {weight};
  return scene;
}

// Returns the fit of a coarse bar whose displacements are those of linear
// elements of a sixth of the size (an eighth in the plane).
Estimate FittedToFinerBar(const std::vector<int>& cells) {
  const int finer = cells.size() == 3 ? 6 : 8;
  std::vector<int> many = cells;
  for (int& along : many) {
    along *= finer;
  }
  Scene scene = BentBar(cells);
  Scene specimen = BentBar(many);
  Measure(kSpecimen, specimen);
  // Each node of the coarse grid is one of the finer grid.
  scene.load_cases[0].displacement = scene.mesh.nodes;
  for (Eigen::Index i = 0; i < scene.mesh.NumNodes(); ++i) {
    Eigen::Index node = 0;
    (specimen.mesh.nodes.colwise() - scene.mesh.nodes.col(i))
        .colwise()
        .squaredNorm()
        .minCoeff(&node);
    scene.load_cases[0].displacement.col(i) =
        specimen.load_cases[0].displacement.col(node);
  }
  return Fitted(scene);
}

// Simplices into which these hexahedra are cut leave errors of 420 and 0.047.
TEST(RefinedFitOfBlocks, HoldsTheTruthOfManyHexahedra) {
  const Estimate estimate = FittedToFinerBar({8, 2, 2});
  ExpectToHold(kSpecimen, estimate);
  EXPECT_EQ(estimate.mesh_divisions, 1);
  EXPECT_LT(*estimate.YoungsModulusStandardError(), 300);
  EXPECT_LT(*estimate.PoissonRatioStandardError(), 0.035);
}

// Triangles into which these quadrilaterals are cut leave 1070 and 0.021.
TEST(RefinedFitOfBlocks, HoldsTheTruthOfManyQuadrilaterals) {
  const Estimate estimate = FittedToFinerBar({8, 2});
  ExpectToHold(kSpecimen, estimate);
  EXPECT_EQ(estimate.mesh_divisions, 1);
  EXPECT_LT(*estimate.YoungsModulusStandardError(), 1050);
  EXPECT_LT(*estimate.PoissonRatioStandardError(), 0.02);
}

}  // namespace
}  // namespace elastimate
