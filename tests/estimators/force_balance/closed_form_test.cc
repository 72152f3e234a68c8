#include "elastimate/estimators/force_balance/closed_form.h"

#include <gtest/gtest.h>

#include <cmath>

#include "elastimate/core/scene/degrees_of_freedom.h"
#include "elastimate/core/scene/loads.h"
#include "elastimate/core/scene/quadratic_scene.h"
#include "tests/bias_law.h"
#include "tests/dense_reference.h"
#include "tests/scenes.h"
#include "tests/throws.h"

namespace elastimate {
namespace {

using testing::AddNoise;
using testing::Measure;
using testing::SmallScene;

// Sets the displacement by a dense solver that shares no code with the library.
void MeasureDensely(const IsotropicElasticity& elasticity, Scene& scene) {
  const DegreesOfFreedom dofs(scene.supports);
  Eigen::VectorXd u = Eigen::VectorXd::Zero(dofs.NumAll());
  u(dofs.free) = testing::DenseFreeDisplacement(scene, elasticity, 0);
  scene.load_cases[0].displacement = u.reshaped(3, scene.mesh.NumNodes());
  scene.origin = Origin::kComputed;
}

class ExactData : public ::testing::TestWithParam<double> {};

TEST_P(ExactData, IsRecoveredToRounding) {
  const double nu = GetParam();
  const double tolerance = nu > 0.49 ? 1e-8 : 1e-10;
  for (const std::string& shape : testing::SmallSceneNames()) {
    SCOPED_TRACE(shape);
    Scene scene = SmallScene(shape);
    MeasureDensely({5e4, nu}, scene);
    const Estimate estimate = ClosedForm().Run(scene, {});
    ASSERT_EQ(estimate.status, Status::kOk) << estimate.message;
    EXPECT_NEAR(estimate.elasticity.youngs_modulus / 5e4, 1, tolerance);
    EXPECT_NEAR(estimate.elasticity.poisson_ratio, nu, tolerance);
    EXPECT_LT(*estimate.force_residual, tolerance);
    EXPECT_LT(*estimate.noise_attenuation, tolerance);
    EXPECT_EQ(estimate.work.factorizations, 0);
    EXPECT_EQ(estimate.work.element_passes, 3);
  }
}

INSTANTIATE_TEST_SUITE_P(PoissonRatios, ExactData,
                         ::testing::Values(-0.9, -0.5, 0.0, 0.3, 0.45, 0.49,
                                           0.499));

TEST(ClosedForm, NeedsNoSupports) {
  Scene scene = SmallScene("organ");
  MeasureDensely({5e4, 0.3}, scene);
  // The reactions of the supports become loads.
  const Eigen::MatrixXd stiffness = testing::DenseStiffness<double>(
      scene.mesh, testing::HookeMatrix(5e4, 0.3));
  scene.load_cases[0].loads = {
      NodalForces{(stiffness * scene.load_cases[0].displacement.reshaped())
                      .reshaped(3, scene.mesh.NumNodes())}};
  scene.supports.held.setConstant(false);
  const Estimate estimate = ClosedForm().Run(scene, {});
  ASSERT_EQ(estimate.status, Status::kOk) << estimate.message;
  EXPECT_NEAR(estimate.elasticity.youngs_modulus / 5e4, 1, 1e-10);
  EXPECT_NEAR(estimate.elasticity.poisson_ratio, 0.3, 1e-10);
}

// The expected values are ordinary least squares on dense matrices, by normal
// equations.
TEST(ClosedForm, IsTheLeastSquaresSolutionUnderNoise) {
  Scene scene = SmallScene("organ");
  Measure({5e4, 0.3}, scene);
  AddNoise(0.01, 4, scene);
  const DegreesOfFreedom dofs(scene.supports);
  const Eigen::VectorXd q = scene.load_cases[0].displacement.reshaped();
  Eigen::MatrixXd columns(dofs.NumAll(), 3);
  columns << testing::DenseStiffness<double>(scene.mesh, testing::DenseDH()) *
                 q,
      testing::DenseStiffness<double>(scene.mesh, testing::DenseDJ()) * q,
      AssembleLoadCases(scene);
  const Eigen::MatrixXd free = columns(dofs.free, Eigen::all);
  Eigen::MatrixXd x(free.rows(), 2);
  x << free.col(1), -free.col(2);
  const Eigen::Vector2d solution =
      -testing::SolveDensely(x.transpose() * x, x.transpose() * free.col(0));
  const double nu = solution(0);
  const Estimate estimate = ClosedForm().Run(scene, {});
  EXPECT_NEAR(estimate.elasticity.poisson_ratio, nu, 1e-9);
  EXPECT_NEAR(estimate.elasticity.youngs_modulus /
                  ((1 + nu) * (1 - 2 * nu) / solution(1)),
              1, 1e-8);
}

// The bias law is E[nu_hat] = nu + rho (nu_n - nu): the estimate is drawn
// towards nu_n, which pure noise would give.
TEST(ClosedForm, FollowsTheBiasLaw) {
  constexpr int kSeeds = 100;
  constexpr double kNu = 0.3;
  Scene exact = SmallScene("organ");
  Measure({5e4, kNu}, exact);
  const double relative_noise = 0.02;
  const auto [rho, noise_poisson_ratio] =
      testing::BiasLawOf(exact, relative_noise);
  const double expected = kNu + rho * (noise_poisson_ratio - kNu);
  double sum = 0;
  double square_sum = 0;
  double attenuation_sum = 0;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    Scene scene = exact;
    AddNoise(relative_noise, seed, scene);
    const Estimate estimate = ClosedForm().Run(scene, {});
    const double nu = estimate.elasticity.poisson_ratio;
    sum += nu;
    square_sum += nu * nu;
    attenuation_sum += *estimate.noise_attenuation;
  }
  const double mean = sum / kSeeds;
  const double sd = std::sqrt((square_sum / kSeeds - mean * mean) / kSeeds);
  ASSERT_GT(rho, 0.1) << "the noise is too small to test the law";
  // The mean has a Monte Carlo error.  The next order of the law, of 1 / number
  // of equations, comes from a ratio of means in place of a mean of ratios.
  EXPECT_NEAR(mean, expected, 4 * sd + std::abs(expected - kNu) / 50);
  EXPECT_NEAR(attenuation_sum / kSeeds, rho, 0.05 * rho);
}

TEST(ClosedForm, SaysThatNoiseMakesItUnusable) {
  Scene scene = SmallScene("organ");
  Measure({5e4, 0.3}, scene);
  AddNoise(0.05, 1, scene);
  const Estimate estimate = ClosedForm().Run(scene, {});
  EXPECT_FALSE(estimate.IsUsable());
  EXPECT_NE(estimate.message.find("noise"), std::string::npos);
  EXPECT_NE(estimate.message.find("--estimator=auto"), std::string::npos);
  EXPECT_FALSE(estimate.YoungsModulusStandardError().has_value());
  EXPECT_FALSE(estimate.why_no_standard_error.empty());
}

// The noise of these twenty measurements biases nu by more than E.
TEST(ClosedForm, SaysThatNoiseBiasesNu) {
  for (int seed = 1; seed <= 20; ++seed) {
    Scene scene = testing::SmallScene("bar");
    testing::Measure({5e4, 0.3}, scene);
    testing::AddNoise(3e-3, seed, scene);
    const Estimate estimate = ClosedForm().Run(scene, {});
    if (estimate.IsUsable()) {
      EXPECT_NEAR(estimate.elasticity.poisson_ratio, 0.3,
                  0.03 + 3 * *estimate.PoissonRatioStandardError());
    }
  }
}

TEST(ClosedForm, AKnownPoissonRatioLeavesNoBias) {
  constexpr int kSeeds = 50;
  Scene exact = SmallScene("organ");
  Measure({5e4, 0.3}, exact);
  EstimatorOptions options;
  options.known_poisson_ratio = 0.3;
  double error_sum = 0;  // Of 1 / E, which is linear in the data.
  double variance_sum = 0;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    Scene scene = exact;
    AddNoise(0.02, seed, scene);
    const Estimate estimate = ClosedForm().Run(scene, options);
    const double youngs = estimate.elasticity.youngs_modulus;
    error_sum += 5e4 / youngs - 1;
    variance_sum +=
        std::pow(*estimate.YoungsModulusStandardError() / youngs, 2);
  }
  EXPECT_NEAR(error_sum / kSeeds, 0, 4 * std::sqrt(variance_sum) / kSeeds);
}

TEST(ClosedForm, SaysThatTheDataContradictAKnownPoissonRatio) {
  Scene scene = SmallScene("cuboid");
  MeasureDensely({5e4, 0.3}, scene);
  EstimatorOptions options;
  options.known_poisson_ratio = 0.45;
  for (const double noise : {0.0, 1e-3}) {
    AddNoise(noise, 1, scene);
    const Estimate estimate = ClosedForm().Run(scene, options);
    EXPECT_EQ(estimate.status, Status::kNotIdentifiable);
    EXPECT_NE(estimate.message.find("fit best with 0.3 "), std::string::npos)
        << estimate.message;
    EXPECT_FALSE(estimate.YoungsModulusStandardError().has_value());
  }
}

TEST(ClosedForm, DoesNotBelieveLoadsThatContradictTheData) {
  Scene exact = SmallScene("cuboid");
  MeasureDensely({5e4, 0.3}, exact);
  const Eigen::MatrixXd force =
      std::get<NodalForces>(exact.load_cases[0].loads[0]).force;
  Eigen::MatrixXd at_one_node = Eigen::MatrixXd::Zero(3, force.cols());
  at_one_node.rightCols<1>() = force.rowwise().sum();
  Eigen::MatrixXd turned = force;
  turned.row(0) = 0.7 * force.row(2);
  Eigen::MatrixXd uneven = force;
  for (Eigen::Index node = 0; node < force.cols(); ++node) {
    uneven.col(node) *= exact.mesh.nodes(0, node);
  }
  for (const Eigen::MatrixXd& wrong : {at_one_node, turned, uneven}) {
    for (const double noise : {0.0, 1e-2}) {
      Scene scene = exact;
      scene.load_cases[0].loads = {NodalForces{wrong}};
      AddNoise(noise, 1, scene);
      for (const bool is_known : {false, true}) {
        EstimatorOptions options;
        if (is_known) {
          options.known_poisson_ratio = 0.3;
        }
        const Estimate estimate = ClosedForm().Run(scene, options);
        const double error = std::abs(estimate.elasticity.youngs_modulus - 5e4);
        if (estimate.IsUsable() && error > 0.1 * 5e4) {
          EXPECT_LT(error, 3 * *estimate.YoungsModulusStandardError());
        }
      }
    }
  }
}

TEST(ClosedForm, BlamesNoiseForANuAboveOneHalf) {
  Scene scene = SmallScene("organ");
  MeasureDensely({5e4, 0.45}, scene);
  AddNoise(0.1, 1, scene);
  const Estimate estimate = ClosedForm().Run(scene, {});
  ASSERT_EQ(estimate.status, Status::kUnphysical);
  ASSERT_GT(estimate.elasticity.poisson_ratio, 0.5);
  EXPECT_TRUE(estimate.IsRefusedFor(FindingCode::kUnphysical));
  EXPECT_NE(estimate.message.find("which noise or coarse elements can cause"),
            std::string::npos);
}

TEST(ClosedForm, RefusesWhatItCannotHonour) {
  Scene scene = SmallScene("cuboid");
  Measure({5e4, 0.3}, scene);
  EstimatorOptions bounds;
  bounds.poisson_ratio.upper = 0.4;
  EXPECT_THROWS_WITH(ClosedForm().Run(scene, bounds),
                     "use --estimator=bounded");
  EstimatorOptions loss;
  loss.loss = Loss::kHuber;
  EXPECT_THROWS_WITH(ClosedForm().Run(scene, loss),
                     "use --estimator=reduced-fe");
  scene.load_cases[0].observed =
      ComponentMask::Constant(3, scene.mesh.NumNodes(), true);
  scene.load_cases[0].observed(1, 20) = false;
  EXPECT_THROWS_WITH(ClosedForm().Run(scene, {}),
                     "node 20 \\(y\\) of load case 1 was not observed");
}

TEST(ClosedForm, SaysThatMidEdgeNodesAreNotMeasured) {
  const std::string why =
      ClosedForm().WhyUnsupported(QuadraticScene(SmallScene("cuboid")), {});
  EXPECT_NE(why.find("order 2"), std::string::npos) << why;
  EXPECT_NE(why.find("use --estimator=reduced-fe"), std::string::npos) << why;
}

// Only a simulation measures mid-edge nodes as well.
TEST(ClosedForm, TakesQuadraticElementsMeasuredAtEveryNode) {
  Scene scene = QuadraticScene(SmallScene("organ"));
  Measure({5e4, 0.3}, scene);
  scene.load_cases[0].observed.resize(3, 0);
  const Estimate estimate = ClosedForm().Run(scene, {});
  EXPECT_TRUE(estimate.IsUsable()) << estimate.message;
  EXPECT_NEAR(estimate.elasticity.youngs_modulus / 5e4, 1, 1e-8);
  EXPECT_NEAR(estimate.elasticity.poisson_ratio, 0.3, 1e-8);
}

TEST(ClosedForm, DoesNotNeedHeldNodesToBeObserved) {
  Scene scene = SmallScene("cuboid");
  Measure({5e4, 0.3}, scene);
  scene.load_cases[0].observed = !scene.supports.held;
  EXPECT_TRUE(ClosedForm().Run(scene, {}).IsUsable());
}

// With as many equations as unknowns there is no residual that shows the noise.
TEST(ClosedForm, SaysWhyThereIsNoStandardError) {
  const Mesh mesh = testing::BoxMesh({1, 1, 1}, {1, 2, 3});
  Scene scene = testing::HeldAtBottom(mesh, mesh, {0, 0, -1});
  scene.supports.held.setConstant(true);
  scene.supports.held.col(7) << false, true, false;
  NodalForces forces{Eigen::MatrixXd::Zero(3, 8)};
  forces.force.col(7) << 1, 0, 2;
  scene.load_cases[0].loads = {forces};
  MeasureDensely({5e4, 0.3}, scene);
  const Estimate estimate = ClosedForm().Run(scene, {});
  ASSERT_EQ(estimate.status, Status::kOk) << estimate.message;
  EXPECT_NEAR(estimate.elasticity.poisson_ratio, 0.3, 1e-10);
  EXPECT_FALSE(estimate.YoungsModulusStandardError().has_value());
  EXPECT_NE(estimate.why_no_standard_error.find("no more equations"),
            std::string::npos);
  scene.load_cases[0].noise_sd = 1e-9;
  const Estimate with_noise_sd = ClosedForm().Run(scene, {});
  EXPECT_TRUE(with_noise_sd.YoungsModulusStandardError().has_value());
}

TEST(ClosedForm, StandardErrorsOfLargeMeshesAreAsGood) {
  const Mesh mesh = testing::BoxMesh({12, 12, 12}, {1, 1, 1});
  ASSERT_GT(mesh.NumElements(), 10000);
  Scene scene = testing::HeldAtBottom(mesh, mesh, {0, 0, -1});
  Measure({5e4, 0.3}, scene);
  const double sd = AddNoise(1e-5, 1, scene);
  const Estimate estimate = ClosedForm().Run(scene, {});
  // With 6084 free components, the noise of white residuals is known to 0.9 %;
  // the probes of the trace add an error of their own.
  EXPECT_NEAR(*estimate.noise_sd / sd, 1, 4 * 2 * 0.009);
  EXPECT_EQ(estimate.work.element_passes, 3);
}

}  // namespace
}  // namespace elastimate
