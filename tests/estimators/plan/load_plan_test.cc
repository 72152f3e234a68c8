#include "elastimate/estimators/plan/load_plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "elastimate/core/scene/finer_scene.h"
#include "elastimate/core/scene/loads.h"
#include "elastimate/core/scene/observed_displacements.h"
#include "elastimate/core/scene/rigid_motion.h"
#include "elastimate/core/scene/scene_builder.h"
#include "elastimate/estimators/plan/expected_information.h"
#include "elastimate/estimators/plan/unit_loads.h"
#include "tests/regions.h"
#include "tests/scenes.h"
#include "tests/throws.h"

namespace elastimate {
namespace {

using testing::SmallScene;

constexpr double kBarYoungsModulus = 5e4;
constexpr double kBarPoissonRatio = 0.3;
constexpr double kBarNoise = 1e-4;
const Eigen::Vector2d kBarParameters(kBarYoungsModulus, kBarPoissonRatio);

Eigen::MatrixXi FacesAt(const Mesh& mesh, int axis, double coordinate) {
  Eigen::Vector3d lower(-9, -9, -9);
  Eigen::Vector3d upper(9, 9, 9);
  lower(axis) = upper(axis) = coordinate;
  return FacetsInBox(mesh, lower, upper);
}

// A bar of 4 x 1 x 1 on rollers is pulled along x by a stress of 100, so that u
// = 100 / E (x, -nu y, -nu z).
Scene BarOnRollers() {
  Scene scene;
  scene.mesh = testing::BoxMesh({4, 2, 2}, {4, 1, 1});
  scene.supports.held = scene.mesh.nodes.array() == 0;
  scene.supports.displacement.setZero(3, scene.mesh.NumNodes());
  scene.load_cases.resize(1);
  scene.load_cases[0].loads = {
      Traction{FacesAt(scene.mesh, 0, 4), 100 * Eigen::Vector3d::UnitX()}};
  scene.load_cases[0].noise_sd = kBarNoise;
  return scene;
}

ComponentMask AxialOnly(const Mesh& mesh) {
  ComponentMask observed = ComponentMask::Constant(3, mesh.NumNodes(), false);
  observed.row(0).setConstant(true);
  return observed;
}

CandidateLoad Sideways(const Scene& scene) {
  LoadCase load_case = ObservedAs(scene.load_cases[0], {});
  load_case.loads = {
      Traction{FacesAt(scene.mesh, 1, 1), 100 * Eigen::Vector3d::UnitY()}};
  return {"sideways", load_case};
}

TEST(PlanLoads, KnowsThatAPullDoesNotDetermineNuWithoutLateralData) {
  Scene scene = BarOnRollers();
  scene.load_cases[0].observed = AxialOnly(scene.mesh);
  CandidateLoad again = {"again", scene.load_cases[0]};
  const LoadPlan plan =
      PlanLoads(scene, {again, Sideways(scene)}, kBarParameters, 0.01);
  // The scene gives u_x = 100 x / E, with the derivative d u_x / d ln E = -100
  // x / E.
  const double sum =
      (100 / kBarYoungsModulus * scene.mesh.nodes.row(0)).squaredNorm();
  EXPECT_EQ(plan.before.NumUndetermined(), 1);
  EXPECT_NEAR(plan.before.OfParameters()(0) * std::sqrt(sum) / kBarNoise, 1,
              1e-6);
  EXPECT_TRUE(std::isinf(plan.before.OfParameters()(1)));
  EXPECT_EQ(CombinationInWords(plan.before.directions.col(0), plan.Free()),
            "nu");

  // A pull along y gives u_x = -100 nu x / E, which adds nu / E.
  ASSERT_EQ(plan.loads[0].candidate, 1U);
  const Eigen::Vector2d s(kBarPoissonRatio, -1);
  const Eigen::Matrix2d information =
      sum / (kBarNoise * kBarNoise) *
      (Eigen::Vector2d(1, 0).asDiagonal().toDenseMatrix() + s * s.transpose());
  const Eigen::Matrix2d covariance = information.inverse();
  const Eigen::VectorXd after = plan.loads[0].errors.OfParameters();
  EXPECT_NEAR(after(0) / std::sqrt(covariance(0, 0)), 1, 1e-6);
  EXPECT_NEAR(after(1) / std::sqrt(covariance(1, 1)), 1, 1e-6);

  // Another pull along x improves E alone, and leaves nu undetermined.
  EXPECT_NEAR(
      plan.loads[1].errors.OfParameters()(0) * std::sqrt(2 * sum) / kBarNoise,
      1, 1e-6);
  EXPECT_TRUE(std::isinf(plan.loads[1].errors.OfParameters()(1)));
  ASSERT_EQ(plan.sequence.size(), 1U);
  EXPECT_EQ(plan.sequence[0].candidate, 1U);
  EXPECT_FALSE(plan.AreDetermined(plan.before));
  EXPECT_TRUE(plan.AreDetermined(plan.sequence[0].errors));
}

// Linear elements bend too little, and are as wrong about nu.  Fits of measured
// displacements use quadratic ones.
TEST(PlanLoads, UsesTheElementsOfFits) {
  Scene scene =
      testing::HeldAtBottom(testing::BoxMesh({1, 1, 8}, {1, 1, 8}),
                            testing::BoxMesh({1, 1, 8}, {1, 1, 8}), {1, 0, 0});
  scene.load_cases[0].noise_sd = kBarNoise;
  const auto errors_of = [](const Scene& bent) {
    return PlanLoads(bent, {{"again", bent.load_cases[0]}}, kBarParameters,
                     0.01)
        .before.OfParameters();
  };
  scene.origin = Origin::kMeasured;
  const Eigen::VectorXd of_measured = errors_of(scene);
  const Eigen::VectorXd of_quadratic = errors_of(FinerScene(scene));
  EXPECT_LT((of_measured - of_quadratic).norm(), 1e-9 * of_quadratic.norm());
  scene.origin = Origin::kComputed;
  EXPECT_GT((errors_of(scene) - of_quadratic).norm(),
            0.5 * of_quadratic.norm());
}

// Axial data say all of E and nothing of nu, and the prior the other way round.
TEST(PlanLoads, CountsPriors) {
  Scene scene = BarOnRollers();
  scene.load_cases[0].observed = AxialOnly(scene.mesh);
  const std::vector<CandidateLoad> again = {{"again", scene.load_cases[0]}};
  const LoadPlan without = PlanLoads(scene, again, kBarParameters, 0.01);
  Material material;
  material.priors = {{"poisson_ratio", 0.25, 0.05}};
  scene.materials = {material};
  const LoadPlan with = PlanLoads(scene, again, kBarParameters, 0.01);
  EXPECT_NEAR(with.before.OfParameters()(0), without.before.OfParameters()(0),
              1e-9);
  EXPECT_NEAR(with.before.OfParameters()(1), 0.05, 1e-9);
  EXPECT_TRUE(with.AreDetermined(with.before));
}

TEST(PlanLoads, KnowsThatLateralDataDetermineNu) {
  const Scene scene = BarOnRollers();
  const LoadPlan plan =
      PlanLoads(scene, {Sideways(scene)}, kBarParameters, 0.01);
  EXPECT_EQ(plan.before.NumUndetermined(), 0);
}

// In pure shear, mu = E / (2 (1 + nu)) alone acts on the displacement.
TEST(PlanLoads, KnowsThatShearDeterminesTheShearModulusAlone) {
  Scene scene = testing::ShearedBlock();
  scene.load_cases[0].noise_sd = kBarNoise;
  CandidateLoad shear = {"shear", scene.load_cases[0]};
  CandidateLoad compression = {"compression", scene.load_cases[0]};
  compression.load_case.loads = {
      Pressure{FacesAt(scene.mesh, 0, 0), 100},
      Pressure{FacesAt(scene.mesh, 0, scene.mesh.nodes.row(0).maxCoeff()),
               100}};
  const LoadPlan plan =
      PlanLoads(scene, {shear, compression}, kBarParameters, 0.01);
  ASSERT_EQ(plan.before.NumUndetermined(), 1);
  const Eigen::Vector2d undetermined = plan.before.directions.col(0);
  EXPECT_NEAR(undetermined(1) / undetermined(0), 1 + kBarPoissonRatio, 1e-6);
  EXPECT_EQ(CombinationInWords(undetermined, plan.Free()), "nu up with E up");
  // The data determine ln mu alone.  E and nu change it with the least norm
  // along its gradient.
  const Eigen::Vector2d gradient(1, -1 / (1 + kBarPoissonRatio));
  const double norm = (scene.supports.held.cast<double>() == 1)
                          .select(0, scene.load_cases[0].displacement.array())
                          .matrix()
                          .norm();
  EXPECT_NEAR(plan.before.Along(gradient) * norm / kBarNoise, 1, 1e-6);

  EXPECT_EQ(plan.loads[0].candidate, 1U);
  EXPECT_EQ(plan.loads[0].errors.NumUndetermined(), 0);
  EXPECT_EQ(plan.loads[1].errors.NumUndetermined(), 1);
}

TEST(PlanLoads, AgreesWithTheCramerRaoBound) {
  Scene scene = testing::WithThreeForces(SmallScene("organ"));
  scene.origin = Origin::kComputed;
  const Eigen::Vector3d noise(1e-4, 2e-4, 5e-5);
  for (int k = 0; k < 3; ++k) {
    scene.load_cases[k].noise_sd = noise(k);
  }
  Scene first = scene;
  first.load_cases.resize(1);
  const LoadPlan plan =
      PlanLoads(first, {{"y", scene.load_cases[1]}, {"z", scene.load_cases[2]}},
                kBarParameters, 0.01);
  const auto expect_bound = [&](const ExpectedErrors& errors, const Scene& of) {
    Eigen::VectorXd sd(Eigen::Index(of.load_cases.size()));
    for (Eigen::Index k = 0; k < sd.size(); ++k) {
      sd(k) = *of.load_cases[k].noise_sd;
    }
    const Eigen::Matrix2d bound = CramerRaoBound(of, kBarParameters, sd);
    EXPECT_NEAR(
        errors.OfParameters()(0) * kBarYoungsModulus / std::sqrt(bound(0, 0)),
        1, 1e-8);
    EXPECT_NEAR(errors.OfParameters()(1) / std::sqrt(bound(1, 1)), 1, 1e-8);
  };
  expect_bound(plan.before, first);
  for (const PlannedLoad& load : plan.loads) {
    Scene both = first;
    both.load_cases.push_back(scene.load_cases[load.candidate + 1]);
    expect_bound(load.errors, both);
  }
  EXPECT_LE(plan.loads[0].errors.standard_errors(0),
            plan.loads[1].errors.standard_errors(0));
}

const std::vector<IsotropicElasticity> kTwoElasticities = {{3e4, 0.3},
                                                           {9e4, 0.2}};

// Returns d u / d (ln E, nu) for both regions, by differences of dense
// solutions.
Eigen::MatrixXd TextbookSensitivities(const Scene& scene) {
  constexpr double kStep = 1e-4;
  Eigen::MatrixXd sensitivities(scene.mesh.NumDofs(), 4);
  for (int i = 0; i < 4; ++i) {
    const auto at = [&](double step) {
      std::vector<IsotropicElasticity> elasticities = kTwoElasticities;
      IsotropicElasticity& changed = elasticities[i / 2];
      (i % 2 == 0 ? changed.youngs_modulus : changed.poisson_ratio) +=
          i % 2 == 0 ? step * changed.youngs_modulus : step;
      return Eigen::VectorXd(
          testing::SolveByTextbook(scene, elasticities).col(0));
    };
    sensitivities.col(i) = (at(kStep) - at(-kStep)) / (2 * kStep);
  }
  return sensitivities;
}

Eigen::Vector4d TwoParameters() {
  return {kTwoElasticities[0].youngs_modulus, kTwoElasticities[0].poisson_ratio,
          kTwoElasticities[1].youngs_modulus,
          kTwoElasticities[1].poisson_ratio};
}

Scene TwoRegions() {
  Scene scene = testing::TwoRegionScene(
      {ElementKind::kQuad4, SectionModel::kPlaneStrain});
  scene.load_cases[0].displacement.resize(0, 0);
  scene.load_cases[0].noise_sd = kBarNoise;
  scene.origin = Origin::kComputed;
  return scene;
}

void ExpectErrorsOf(const Eigen::MatrixXd& sensitivities,
                    const ExpectedErrors& errors) {
  const Eigen::MatrixXd covariance =
      (sensitivities.transpose() * sensitivities / (kBarNoise * kBarNoise))
          .inverse();
  const Eigen::VectorXd of_parameters = errors.OfParameters();
  ASSERT_EQ(of_parameters.size(), sensitivities.cols());
  for (Eigen::Index i = 0; i < of_parameters.size(); ++i) {
    EXPECT_NEAR(of_parameters(i) / std::sqrt(covariance(i, i)), 1, 1e-4);
  }
}

TEST(PlanLoads, AgreesWithDifferencesOfTwoMaterials) {
  const Scene scene = TwoRegions();
  const LoadPlan plan =
      PlanLoads(scene, {{"again", scene.load_cases[0]}}, TwoParameters(), 0.01);
  ExpectErrorsOf(TextbookSensitivities(scene), plan.before);
  EXPECT_NEAR(plan.loads[0].errors.OfParameters()(2) * std::sqrt(2) /
                  plan.before.OfParameters()(2),
              1, 1e-8);
}

TEST(PlanLoads, LeavesKnownParametersOut) {
  Scene scene = TwoRegions();
  scene.materials[0].known = {{"poisson_ratio", 0.3}};
  const LoadPlan plan =
      PlanLoads(scene, {{"again", scene.load_cases[0]}}, TwoParameters(), 0.01);
  EXPECT_EQ(plan.parameters.size(), 4U);
  EXPECT_EQ(plan.Free().size(), 3U);
  EXPECT_EQ(plan.Free()[1].Label(), "E of region 7");
  ExpectErrorsOf(
      TextbookSensitivities(scene)(Eigen::all, std::vector<int>{0, 2, 3}),
      plan.before);
}

TEST(PlanLoads, ProjectsTheMotionOfTheCameraOut) {
  Scene scene = TwoRegions();
  scene.is_rigid_motion_free = true;
  const LoadPlan plan =
      PlanLoads(scene, {{"again", scene.load_cases[0]}}, TwoParameters(), 0.01);
  Eigen::MatrixXd motions(scene.mesh.NumDofs(), 3);
  for (Eigen::Index node = 0; node < scene.mesh.NumNodes(); ++node) {
    motions.middleRows(2 * node, 2) =
        RigidMotionsAt(scene.mesh.nodes.col(node));
  }
  const Eigen::MatrixXd s = TextbookSensitivities(scene);
  ExpectErrorsOf(s - motions * motions.colPivHouseholderQr().solve(s),
                 plan.before);
}

TEST(PlanLoads, LooksAtPointsAsAtNodes) {
  Scene scene = BarOnRollers();
  const Mesh& mesh = scene.mesh;
  // The scene gets 40 measured points.
  LoadCase& load_case = scene.load_cases[0];
  std::mt19937_64 generator(3);
  load_case.points.points = DrawPoints(mesh, 40, generator);
  load_case.points.displacement =
      Interpolate(mesh, load_case.points.points, mesh.nodes) * 1e-3;
  load_case.points.displacement.row(2).setConstant(testing::kNan);
  const LoadPlan plan = PlanLoads(
      scene, UnitCandidates(scene, FacesAt(mesh, 0, 4)), kBarParameters, 0.01);
  // At the points, u = 100 / E (x, -nu y).
  const Eigen::MatrixXd at =
      100 / kBarYoungsModulus *
      Interpolate(mesh, load_case.points.points, mesh.nodes);
  Eigen::Matrix2d information = Eigen::Matrix2d::Zero();
  for (const auto& point : at.colwise()) {
    const Eigen::Vector2d of_x(-point(0), 0);
    const Eigen::Vector2d of_y(kBarPoissonRatio * point(1), -point(1));
    information += of_x * of_x.transpose() + of_y * of_y.transpose();
  }
  const Eigen::Matrix2d covariance =
      kBarNoise * kBarNoise * information.inverse();
  EXPECT_NEAR(plan.before.OfParameters()(1) / std::sqrt(covariance(1, 1)), 1,
              1e-6);
  EXPECT_EQ(plan.loads.size(), 6U);
  for (const PlannedLoad& load : plan.loads) {
    EXPECT_LE(load.errors.OfParameters()(1), plan.before.OfParameters()(1));
  }
}

TEST(PlanLoads, SizesUnitLoadsByTheDisplacementOfTheScene) {
  const Scene scene = BarOnRollers();
  std::vector<CandidateLoad> unit =
      UnitCandidates(scene, FacesAt(scene.mesh, 0, 4));
  ASSERT_EQ(unit[0].name, "force along x");
  const LoadPlan plan = PlanLoads(scene, unit, kBarParameters, 0.01);
  const auto of = [&](const LoadPlan& a_plan, std::size_t candidate) {
    return *std::find_if(
        a_plan.loads.begin(), a_plan.loads.end(),
        [&](const PlannedLoad& load) { return load.candidate == candidate; });
  };
  // The force of the scene is 100 on an area of 1, so this candidate is the
  // same load again.
  EXPECT_NEAR(of(plan, 0).factor.value(), 100, 1e-6);
  EXPECT_NEAR(of(plan, 0).errors.standard_errors(0) * std::sqrt(2) /
                  plan.before.standard_errors(0),
              1, 1e-8);
  // The unit of a candidate does not matter, since its factor scales it to the
  // displacement of the scene.
  for (CandidateLoad& candidate : unit) {
    for (Load& load : candidate.load_case.loads) {
      load = Scaled(load, 7);
    }
  }
  const LoadPlan scaled = PlanLoads(scene, unit, kBarParameters, 0.01);
  for (std::size_t i = 0; i < unit.size(); ++i) {
    EXPECT_NEAR(of(scaled, i).factor.value() * 7 / of(plan, i).factor.value(),
                1, 1e-8);
    EXPECT_NEAR(of(scaled, i).errors.standard_errors(0) /
                    of(plan, i).errors.standard_errors(0),
                1, 1e-8);
  }
}

TEST(PlanLoads, TakesNoiseRelativeToEachLoadCaseWhereNoneIsGiven) {
  Scene scene = BarOnRollers();
  scene.load_cases[0].noise_sd.reset();
  CandidateLoad large = {"large", scene.load_cases[0]};
  large.load_case.loads[0] = Scaled(large.load_case.loads[0], 1000);
  const LoadPlan plan = PlanLoads(scene, {large}, kBarParameters, 0.01);
  // With a known nu, the error of ln E is 1 % over the root of the number of
  // rows.
  const Eigen::Index rows = (!scene.supports.held).count();
  const Eigen::Matrix2d information =
      plan.before.directions *
      plan.before.standard_errors.cwiseAbs2().cwiseInverse().asDiagonal() *
      plan.before.directions.transpose();
  EXPECT_NEAR(information(0, 0), double(rows) / (0.01 * 0.01),
              1e-6 * rows / 1e-4);
  EXPECT_NEAR(plan.loads[0].errors.standard_errors(0) * std::sqrt(2) /
                  plan.before.standard_errors(0),
              1, 1e-8);
}

TEST(PlanLoads, SaysOfALoadOnSupportsThatItMovesNothing) {
  const Scene scene = BarOnRollers();
  CandidateLoad held = Sideways(scene);
  held.load_case.loads = {
      Traction{FacesAt(scene.mesh, 0, 0), Eigen::Vector3d::UnitX()}};
  const LoadPlan plan = PlanLoads(scene, {held}, kBarParameters, 0.01);
  EXPECT_FALSE(plan.loads[0].factor);
  EXPECT_NEAR(
      plan.loads[0].errors.standard_errors(0) / plan.before.standard_errors(0),
      1, 1e-12);
  EXPECT_TRUE(plan.sequence.empty());
}

TEST(PlanLoads, TriesAllLoadsWhereNoneDeterminesTheParameters) {
  // Each load gives u_x = -100 nu x / E, so that only nu / E is determined,
  // however often it is repeated.
  Scene scene = BarOnRollers();
  scene.load_cases[0].observed = AxialOnly(scene.mesh);
  scene.load_cases[0].loads = Sideways(scene).load_case.loads;
  const CandidateLoad same = {"same", scene.load_cases[0]};
  const LoadPlan plan = PlanLoads(scene, {same, same}, kBarParameters, 0.01);
  ASSERT_EQ(plan.sequence.size(), 2U);
  EXPECT_EQ(plan.sequence[1].errors.NumUndetermined(), 1);
  EXPECT_FALSE(plan.AreDetermined(plan.sequence[1].errors));
}

TEST(PlanLoads, RefusesWhatNoPlanCanBeMadeOf) {
  const Scene scene = BarOnRollers();
  const std::vector<CandidateLoad> sideways = {Sideways(scene)};
  EXPECT_THROWS_WITH(PlanLoads(scene, {}, kBarParameters, 0.01), "candidates");
  EXPECT_THROWS_WITH(PlanLoads(scene, sideways, kBarParameters, 0), "positive");
  EXPECT_THROWS_WITH(PlanLoads(scene, sideways, Eigen::VectorXd::Ones(3), 0.01),
                     "each parameter");
  Scene loose = scene;
  loose.supports.held.setConstant(false);
  EXPECT_THROWS_WITH(PlanLoads(loose, sideways, kBarParameters, 0.01),
                     "without strain");
  Scene known = scene;
  known.materials = {Material{}};
  known.materials[0].known = {{"youngs_modulus", 1}, {"poisson_ratio", 0.3}};
  EXPECT_THROWS_WITH(PlanLoads(known, sideways, kBarParameters, 0.01), "known");
  Scene unloaded = scene;
  unloaded.load_cases[0].loads.clear();
  EXPECT_THROWS_WITH(PlanLoads(unloaded, sideways, kBarParameters, 0.01),
                     "moves");
}

TEST(TypicalParameters, HaveModuliThatFitTheMeasurement) {
  Scene scene = BarOnRollers();
  EXPECT_EQ(TypicalParameters(scene, SolverKind::kCholesky),
            Eigen::VectorXd(Eigen::Vector2d(1, 0.3)));
  Measure({7e3, 0.3}, scene);
  EXPECT_NEAR(TypicalParameters(scene, SolverKind::kCholesky)(0), 7e3, 1e-4);
}

TEST(CombinationInWords, NamesTheLargestShares) {
  const auto parameter = [](const std::string& symbol, int region) {
    ParameterEstimate estimate;
    estimate.symbol = symbol;
    estimate.regions = {region};
    return estimate;
  };
  const std::vector<ParameterEstimate> free = {
      parameter("E", 1),  parameter("nu", 1), parameter("E", 2),
      parameter("nu", 2), parameter("E", 3),  parameter("nu", 3)};
  Eigen::VectorXd combination(6);
  combination << 0.1, 0, 1, -0.5, 0, 0;
  EXPECT_EQ(CombinationInWords(combination, free),
            "E of region 2 up with nu of region 2 down");
  combination << 1, 1, 1, 1, -1, 1;
  EXPECT_EQ(CombinationInWords(combination, free),
            "E of region 1 up with nu of region 1 up, E of region 2 up, nu of "
            "region 2 up and 2 more");
}

}  // namespace
}  // namespace elastimate
