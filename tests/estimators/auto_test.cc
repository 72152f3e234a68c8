#include "elastimate/estimators/auto.h"

#include <gtest/gtest.h>

#include <random>

#include "elastimate/core/equilibrium/simulated_measurement.h"
#include "elastimate/core/scene/quadratic_scene.h"
#include "elastimate/estimators/displacement_fit/reduced_fe.h"
#include "elastimate/estimators/force_balance/closed_form.h"
#include "tests/regions.h"
#include "tests/scenes.h"
#include "tests/throws.h"

namespace elastimate {
namespace {

using testing::AddNoise;
using testing::Measure;
using testing::MeasureInFinerWorld;
using testing::SmallScene;
using testing::UnderBodyForce;

// Measured on quadratic elements, which linear ones cannot follow, under a
// load that is the same for both.
Scene FinerWorld(const std::string& shape, const IsotropicElasticity& truth) {
  Scene scene = UnderBodyForce(SmallScene(shape));
  MeasureInFinerWorld(truth, scene);
  return scene;
}

// Bends in a direction in which it has two cells.
Scene SlenderBar() {
  const Mesh mesh = testing::BoxMesh({2, 2, 20}, {0.1, 0.1, 1});
  Scene scene = testing::HeldAtBottom(mesh, mesh, Eigen::Vector3d::Zero());
  scene.load_cases[0].loads = {BodyForce{Eigen::Vector3d(1e4, 0, 0)}};
  return scene;
}

void ExpectBooksToBalance(const Estimate& estimate) {
  Work work;
  for (const Rung& rung : estimate.rungs) {
    work = work + rung.work;
    EXPECT_NE(rung.decision, "");
    EXPECT_EQ(rung.decision.find("passed over") == 0, !rung.status);
  }
  EXPECT_EQ(estimate.work.element_passes, work.element_passes);
  EXPECT_EQ(estimate.work.factorizations, work.factorizations);
  EXPECT_EQ(estimate.work.solves, work.solves);
}

TEST(Auto, StopsAtTheClosedFormWithoutNoise) {
  Scene scene = SmallScene("organ");
  Measure({5e4, 0.3}, scene);
  const Estimate estimate = Auto().Run(scene, {});
  ASSERT_EQ(estimate.status, Status::kOk) << estimate.message;
  ASSERT_EQ(estimate.rungs.size(), 1);
  EXPECT_EQ(estimate.rungs[0].estimator, "closed-form");
  EXPECT_EQ(estimate.work.factorizations, 0);
  EXPECT_EQ(estimate.element_order, 1);
  ExpectBooksToBalance(estimate);
}

// Loads that do not balance but for rounding may be those of finer elements, of
// which closed-form knows nothing.
TEST(Auto, TakesNoClosedFormForASpecimen) {
  Scene scene = testing::BlockUnderTraction({4, 4, 8}, {1, 1, 2});
  Measure({5e4, 0.3}, scene);
  testing::AddNoise(1e-6, 1, scene);
  Scene of_two = scene;
  testing::DivideIntoRegions({1, 1, 2}, {1, 1, 2}, of_two);
  for (const Scene& measured : {scene, of_two}) {
    const Estimate closed_form = ClosedForm().Run(measured, {});
    ASSERT_TRUE(closed_form.IsUsable()) << closed_form.message;
    for (const ParameterEstimate& parameter : closed_form.parameters) {
      EXPECT_LT(*parameter.standard_error / parameter.ErrorUnit(), 0.01);
    }
    const Estimate estimate = Auto().Run(measured, {});
    ASSERT_TRUE(estimate.IsUsable()) << estimate.message;
    ASSERT_GT(estimate.rungs.size(), 1U);
    EXPECT_EQ(estimate.rungs[0].decision,
              "went on: what its elements miss is not known");
  }
}

TEST(Auto, ClimbsWhereNoiseAsksForIt) {
  Scene scene = SmallScene("organ");
  Measure({5e4, 0.3}, scene);
  AddNoise(0.05, 1, scene);
  const Estimate estimate = Auto().Run(scene, {});
  ASSERT_EQ(estimate.status, Status::kOk) << estimate.message;
  ASSERT_EQ(estimate.rungs.size(), 3);
  EXPECT_EQ(estimate.rungs[2].estimator, "reduced-fe");
  EXPECT_NE(estimate.rungs[2].decision.find("statistical limit"),
            std::string::npos);
  EXPECT_EQ(estimate.element_order, 1);
  // The data tell that they come from these elements.
  EXPECT_LT(*estimate.discretization_error,
            0.3 * estimate.error_budget.noise(0));
  EXPECT_TRUE(estimate.findings.empty());
  ASSERT_TRUE(estimate.model_mismatch.has_value());
  EXPECT_GT(estimate.model_mismatch->p_value, 1e-3);
  const Estimate fit = ReducedFe().Run(scene, {});
  EXPECT_EQ(estimate.elasticity.youngs_modulus, fit.elasticity.youngs_modulus);
  EXPECT_EQ(estimate.estimator, "auto");
  ExpectBooksToBalance(estimate);
}

TEST(Auto, RaisesTheOrderWhereLinearElementsAreNotEnough) {
  for (const std::string shape : {"cuboid", "organ"}) {
    SCOPED_TRACE(shape);
    const Scene scene = FinerWorld(shape, {5e4, 0.3});
    const Estimate linear = ReducedFe().Run(scene, {});
    ASSERT_TRUE(!linear.IsUsable() ||
                std::abs((*linear.discretization_correction)(0)) > 0.02);
    const Estimate estimate = Auto().Run(scene, {});
    ASSERT_EQ(estimate.status, Status::kOk) << estimate.message;
    EXPECT_EQ(estimate.element_order, 2);
    EXPECT_NEAR(estimate.elasticity.youngs_modulus / 5e4, 1, 1e-6);
    EXPECT_NEAR(estimate.elasticity.poisson_ratio, 0.3, 1e-6);
    ASSERT_EQ(estimate.rungs.size(), 4);
    EXPECT_EQ(estimate.rungs[3].element_order, 2);
    ExpectBooksToBalance(estimate);
  }
}

TEST(Auto, RaisesTheOrderOfSeveralMaterials) {
  Scene scene = SlenderBar();
  scene.mesh.regions = Eigen::VectorXi::Ones(scene.mesh.NumElements());
  scene.mesh.regions.tail(scene.mesh.NumElements() / 2).setConstant(2);
  scene.materials = IsotropicMaterialOfEachRegion(scene.mesh);
  for (Material& material : scene.materials) {
    material.known.push_back({"poisson_ratio", 0.3});
  }
  Scene quadratic = QuadraticScene(scene);
  MeasureMaterials(Eigen::Vector4d(1e7, 0.3, 2e7, 0.3), quadratic);
  scene.load_cases[0].displacement =
      quadratic.load_cases[0].displacement.leftCols(scene.mesh.NumNodes());
  scene.is_of_linear_elasticity = true;
  const Estimate estimate = Auto().Run(scene, {});
  ASSERT_EQ(estimate.status, Status::kOk) << estimate.message;
  EXPECT_EQ(estimate.rungs.back().element_order, 2);
  EXPECT_NEAR(estimate.parameters[0].value / 1e7, 1, 1e-5);
  EXPECT_NEAR(estimate.parameters[2].value / 2e7, 1, 1e-5);
  ExpectBooksToBalance(estimate);
}

// The scene is of linear elements, the estimate is not.
TEST(Auto, DoesNotWarnOfElementsThatItHasLeft) {
  const Scene scene = FinerWorld("organ", {5e4, 0.47});
  const Estimate estimate = Auto().Run(scene, {});
  ASSERT_EQ(estimate.status, Status::kOk) << estimate.message;
  ASSERT_EQ(estimate.element_order, 2);
  EXPECT_NEAR(estimate.elasticity.poisson_ratio, 0.47, 1e-6);
  EXPECT_FALSE(estimate.Has(FindingCode::kLocking));
}

// Linear elements whose virtual work is off balance contradict themselves.
TEST(Auto, DoesNotHoldQuadraticElementsAgainstABalanceThatIsNone) {
  const Mesh mesh = testing::BoxMesh({2, 2, 8}, {2, 2, 8});
  Scene scene = testing::HeldAtBottom(mesh, mesh, Eigen::Vector3d::Zero());
  scene.load_cases[0].loads = {BodyForce{Eigen::Vector3d(0, 0, -10)}};
  testing::MeasureInRefinedWorld({5000, 0.45}, scene);
  AddNoise(0.03, 1, scene);
  const Estimate estimate = Auto().Run(scene, {});
  ASSERT_EQ(estimate.status, Status::kOk) << estimate.message;
  ASSERT_EQ(estimate.element_order, 2);
  EXPECT_LT(std::abs(estimate.elasticity.youngs_modulus - 5000),
            2 * *estimate.YoungsModulusStandardError());
  EXPECT_FALSE(estimate.Has(FindingCode::kModelMismatch));
}

TEST(Auto, DoesNotAdviseWhatItHasTried) {
  int num_kept = 0;
  for (int seed = 1; seed <= 2; ++seed) {
    Scene scene = SlenderBar();
    Measure({1e7, 0}, scene);
    AddNoise(0.1, seed, scene);
    const Estimate estimate = Auto().Run(scene, {});
    if (estimate.element_order == 2 ||
        estimate.rungs.back().element_order == 1) {
      continue;
    }
    ++num_kept;
    for (const Finding& finding : estimate.findings) {
      EXPECT_EQ(Sentence(finding).find("order 2"), std::string::npos)
          << Sentence(finding);
    }
  }
  EXPECT_GT(num_kept, 0);
}

TEST(AutoStatistics, DoesNotRaiseTheOrderForNoise) {
  for (int seed = 1; seed <= 20; ++seed) {
    Scene scene = SmallScene("organ");
    Measure({5e4, 0.47}, scene);
    AddNoise(0.05, seed, scene);
    EXPECT_EQ(Auto().Run(scene, {}).element_order, 1) << seed;
  }
}

TEST(AutoStatistics, TellsWhichElementsTheDisplacementsComeFrom) {
  EstimatorOptions options;
  options.known_poisson_ratio = 0.3;
  for (const int order : {1, 2}) {
    Scene scene = SlenderBar();
    order == 1 ? Measure({1e7, 0.3}, scene)
               : MeasureInFinerWorld({1e7, 0.3}, scene);
    for (int seed = 1; seed <= 5; ++seed) {
      SCOPED_TRACE(seed);
      Scene measured = scene;
      AddNoise(0.05, seed, measured);
      const Estimate estimate = Auto().Run(measured, options);
      ASSERT_EQ(estimate.status, Status::kOk) << estimate.message;
      EXPECT_EQ(estimate.element_order, order);
      EXPECT_NEAR(estimate.elasticity.youngs_modulus, 1e7,
                  4 * *estimate.YoungsModulusStandardError());
    }
  }
}

// Gross errors are far larger than what tells the elements apart.
TEST(AutoStatistics, OutliersDoNotHideWhichElementsTheDisplacementsComeFrom) {
  EstimatorOptions options;
  options.known_poisson_ratio = 0.3;
  for (const int order : {1, 2}) {
    Scene exact = SlenderBar();
    order == 1 ? Measure({1e7, 0.3}, exact)
               : MeasureInFinerWorld({1e7, 0.3}, exact);
    for (int seed = 1; seed <= 10; ++seed) {
      SCOPED_TRACE(seed);
      Scene measured = exact;
      MeasurementErrors errors;
      errors.relative_noise = 0.02;
      errors.law = NoiseLaw::kGaussian;
      errors.outliers = 0.03;
      std::mt19937_64 generator(seed);
      AddErrors(errors, measured.mesh.nodes, measured.supports.held, generator,
                measured.load_cases[0].displacement);
      const Estimate estimate = Auto().Run(measured, options);
      ASSERT_EQ(estimate.status, Status::kOk) << estimate.message;
      EXPECT_EQ(estimate.element_order, order);
      EXPECT_NEAR(estimate.elasticity.youngs_modulus, 1e7,
                  4 * *estimate.YoungsModulusStandardError());
    }
  }
}

// From one displacement nothing can be told, and linear elements, which are too
// stiff by half, may have made it.
TEST(Auto, AsksWhichElementsAreMeantWhereBothExplainTheDisplacements) {
  Scene scene = SlenderBar();
  MeasureInFinerWorld({1e7, 0.3}, scene);
  LoadCase& load_case = scene.load_cases[0];
  load_case.noise_sd = 0.001 * load_case.displacement.cwiseAbs().maxCoeff();
  load_case.observed = ComponentMask::Constant(3, scene.mesh.NumNodes(), false);
  load_case.observed(0, scene.mesh.NumNodes() - 1) = true;
  EstimatorOptions options;
  options.known_poisson_ratio = 0.3;
  const Estimate estimate = Auto().Run(scene, options);
  EXPECT_EQ(estimate.status, Status::kNotIdentifiable);
  EXPECT_NE(estimate.message.find("order 2, or 1 for simulations"),
            std::string::npos)
      << estimate.message;
  const Estimate of_specimen = ReducedFe().Run(QuadraticScene(scene), options);
  ASSERT_EQ(of_specimen.status, Status::kOk) << of_specimen.message;
  const double error = *of_specimen.YoungsModulusStandardError() / 1e7;
  EXPECT_LT(error, 0.01);
  EXPECT_NEAR(of_specimen.elasticity.youngs_modulus / 1e7, 1, 2 * error);
}

TEST(Auto, PassesOverWhatCannotServe) {
  Scene scene = SmallScene("organ");
  Measure({5e4, 0.3}, scene);
  AddNoise(0.01, 1, scene);
  EstimatorOptions options;
  options.loss = Loss::kHuber;
  const Estimate robust = Auto().Run(scene, options);
  ASSERT_EQ(robust.status, Status::kOk) << robust.message;
  ASSERT_EQ(robust.rungs.size(), 3);
  EXPECT_FALSE(robust.rungs[0].status.has_value());
  EXPECT_FALSE(robust.rungs[1].status.has_value());
  EXPECT_EQ(robust.rungs[2].estimator, "reduced-fe");
  ExpectBooksToBalance(robust);

  Scene loose = scene;
  loose.supports.held.setConstant(false);
  EXPECT_THROWS_WITH(Auto().Run(loose, options), "without strain");
}

}  // namespace
}  // namespace elastimate
