#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

#include "elastimate/estimators/material_fit/iterative_fe.h"
#include "elastimate/estimators/material_fit/reduced_fe.h"
#include "tests/scenes.h"

namespace elastimate {
namespace {

using testing::AddNoise;
using testing::Measure;
using testing::SmallScene;

Scene MeasuredOrgan() {
  Scene scene = SmallScene("organ");
  Measure({5e4, 0.3}, scene);
  return scene;
}

TEST(DisplacementFit, IndependentNoiseDoesNotWidenTheStandardErrors) {
  for (int seed = 1; seed <= 20; ++seed) {
    Scene scene = MeasuredOrgan();
    AddNoise(0.1, seed, scene);
    const Estimate estimate = IterativeFe().Run(scene, {});
    ASSERT_EQ(estimate.status, Status::kOk) << estimate.message;
    EXPECT_FALSE(estimate.is_model_in_doubt);
    EXPECT_FALSE(estimate.Has(FindingCode::kSmoothResidual));
    EXPECT_FALSE(estimate.Has(FindingCode::kResidualAboveNoise));
    EXPECT_LT(std::abs(*estimate.residual_correlation), 0.2);
  }
}

// E and nu must be within three standard errors, or not usable.
void ExpectHonest(const Estimate& estimate) {
  if (!estimate.IsUsable()) {
    return;
  }
  EXPECT_NEAR(estimate.elasticity.youngs_modulus, 5e4,
              3 * *estimate.YoungsModulusStandardError());
  EXPECT_NEAR(estimate.elasticity.poisson_ratio, 0.3,
              3 * *estimate.PoissonRatioStandardError());
}

TEST(DisplacementFit, WrongSupportsWidenTheStandardErrors) {
  for (const bool too_many : {true, false}) {
    SCOPED_TRACE(too_many);
    Scene scene = MeasuredOrgan();
    AddNoise(1e-3, 1, scene);
    for (Eigen::Index node = 0; node < scene.mesh.NumNodes(); ++node) {
      if (too_many && scene.mesh.nodes(2, node) < 0.4) {
        scene.supports.held.col(node) = true;
      } else if (!too_many && scene.mesh.nodes(0, node) > 0.5) {
        scene.supports.held.col(node) = false;
      }
    }
    const Estimate estimate = IterativeFe().Run(scene, {});
    ExpectHonest(estimate);
    EXPECT_GT(*estimate.residual_correlation, 0.3);
    EXPECT_TRUE(estimate.Has(FindingCode::kSmoothResidual));
  }
}

// Noise is given for each component alone, so that its size says nothing of a
// residual that is alike between neighbours.
TEST(DisplacementFit, GivenNoiseOfItsSizeDoesNotExplainASmoothResidual) {
  Scene scene = MeasuredOrgan();
  // A smooth measurement error of the given size.
  Eigen::MatrixXd& q = scene.load_cases[0].displacement;
  const double size = 0.01 * q.norm() / std::sqrt(double(q.size()));
  q.array() += size;
  const Estimate estimate = IterativeFe().Run(scene, {});
  scene.load_cases[0].noise_sd = size;
  const Estimate told = IterativeFe().Run(scene, {});
  EXPECT_TRUE(told.Has(FindingCode::kSmoothResidual));
  EXPECT_FALSE(told.Has(FindingCode::kResidualAboveNoise));
  EXPECT_NEAR(*told.YoungsModulusStandardError(),
              *estimate.YoungsModulusStandardError(),
              0.1 * *estimate.YoungsModulusStandardError());
  ExpectHonest(told);
}

// A cube under pressure from all sides, with the six supports that stop its
// rigid motion.
Scene UnderHydrostaticPressure() {
  Scene scene;
  scene.mesh = testing::BoxMesh({3, 3, 3}, {1, 1, 1});
  const Eigen::Index num_nodes = scene.mesh.NumNodes();
  scene.supports.held = ComponentMask::Constant(3, num_nodes, false);
  scene.supports.displacement = Eigen::MatrixXd::Zero(3, num_nodes);
  for (Eigen::Index node = 0; node < num_nodes; ++node) {
    const Eigen::Vector3d x = scene.mesh.nodes.col(node);
    scene.supports.held(0, node) = x.isZero();
    scene.supports.held(1, node) = x(1) == 0 && x(2) == 0;
    scene.supports.held(2, node) = x(2) == 0 && x(0) * x(1) == 0;
  }
  scene.load_cases.resize(1);
  scene.load_cases[0].loads.emplace_back(
      Pressure{BoundaryFacets(scene.mesh), 100});
  Measure({5e4, 0.3}, scene);
  return scene;
}

TEST(DisplacementFitStatistics, BoundsDoNotHideThatTheDataDoNotDetermineNu) {
  // Rounding decides where in the bounds, or on which of them, a fit ends.
  for (int seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    Scene scene = UnderHydrostaticPressure();
    AddNoise(0.05, seed, scene);
    EstimatorOptions options;
    options.poisson_ratio = {0.0, 0.49};
    const Estimate estimate = IterativeFe().Run(scene, options);
    EXPECT_EQ(estimate.status, Status::kNotIdentifiable);
    // Bounds that leave E little room determine it.
    options.poisson_ratio = {0.299, 0.301};
    const Estimate narrow = IterativeFe().Run(scene, options);
    if (!narrow.active_bounds.empty()) {
      EXPECT_EQ(narrow.status, Status::kOk) << narrow.message;
    }
  }
}

TEST(DisplacementFitStatistics, BoundsDoNotHideThatTheDataDoNotDetermineE) {
  // E = 3 kappa (1 - 2 nu), for any nu.
  const double kappa = 5e4 / 1.2;
  for (const Bounds& bounds :
       {Bounds{0.1 * kappa, 2 * kappa}, Bounds{{}, kappa}, Bounds{kappa, {}}}) {
    for (int seed = 1; seed <= 20; ++seed) {
      SCOPED_TRACE(seed);
      Scene scene = UnderHydrostaticPressure();
      AddNoise(0.05, seed, scene);
      EstimatorOptions options;
      options.youngs_modulus = bounds;
      EXPECT_EQ(IterativeFe().Run(scene, options).status,
                Status::kNotIdentifiable);
      // Bounds that leave nu little room determine it.
      options.youngs_modulus = {4.99e4, 5.01e4};
      const Estimate narrow = IterativeFe().Run(scene, options);
      if (!narrow.active_bounds.empty()) {
        EXPECT_EQ(narrow.status, Status::kOk) << narrow.message;
        EXPECT_NEAR(narrow.elasticity.poisson_ratio, 0.3, 0.01);
      }
    }
  }
}

TEST(DisplacementFit, AKnownNuDoesNotDetermineE) {
  int num_on_bound = 0;
  for (int seed = 1; seed <= 20; ++seed) {
    Scene scene = MeasuredOrgan();
    AddNoise(100, seed, scene);
    EstimatorOptions options;
    options.known_poisson_ratio = 0.3;
    options.youngs_modulus = {4e4, 1e6};
    const Estimate estimate = IterativeFe().Run(scene, options);
    if (!estimate.active_bounds.empty()) {
      ++num_on_bound;
      EXPECT_FALSE(estimate.IsUsable()) << seed;
      EXPECT_TRUE(estimate.Has(FindingCode::kParametersUndetermined))
          << estimate.message;
    }
  }
  EXPECT_GT(num_on_bound, 0);
}

TEST(DisplacementFit, ABoundThatTheDataContradictIsNotCalledUndetermined) {
  Scene scene = MeasuredOrgan();
  AddNoise(0.01, 1, scene);
  EstimatorOptions options;
  options.youngs_modulus = {1e5, 1e6};
  const Estimate estimate = IterativeFe().Run(scene, options);
  ASSERT_FALSE(estimate.active_bounds.empty());
  EXPECT_FALSE(estimate.Has(FindingCode::kParametersUndetermined))
      << estimate.message;
}

TEST(DisplacementFit, NuAtTheLowerEndOfItsRangeIsNotBelieved) {
  // Displacements as they would go on below nu = -1, at a fixed shear modulus.
  Scene scene = SmallScene("cuboid");
  Scene other = scene;
  Measure({2e3 * 0.001, -0.999}, scene);
  Measure({2e3 * 0.1, -0.9}, other);
  scene.load_cases[0].displacement +=
      scene.load_cases[0].displacement - other.load_cases[0].displacement;
  const Estimate estimate = ReducedFe().Run(scene, {});
  ASSERT_LT(estimate.elasticity.poisson_ratio, -0.999);
  EXPECT_EQ(estimate.status, Status::kUnphysical);
  EXPECT_NE(estimate.message.find("Poisson's ratio to -1"), std::string::npos)
      << estimate.message;
  // Iterations approach the end of the range, but do not come to it.
  EXPECT_FALSE(IterativeFe().Run(scene, {}).IsUsable());
}

// The load of a fit is what most nodes say; zeros are a common way to mark what
// was not tracked.
TEST(DisplacementFit, LeavesOutliersOut) {
  for (int seed = 1; seed <= 10; ++seed) {
    Scene scene = MeasuredOrgan();
    AddNoise(0.01, seed, scene);
    std::mt19937_64 generator(seed);
    for (int i = 0; i < 6; ++i) {
      const Eigen::Index node = std::uniform_int_distribution<Eigen::Index>(
          16, scene.mesh.NumNodes() - 1)(generator);
      scene.load_cases[0].displacement.col(node).setZero();
    }
    const Estimate estimate = IterativeFe().Run(scene, {});
    EXPECT_TRUE(estimate.Has(FindingCode::kOutliersLeftOut));
    if (estimate.IsUsable()) {
      EXPECT_NEAR(estimate.elasticity.youngs_modulus, 5e4,
                  3 * *estimate.YoungsModulusStandardError());
    }
  }
}

TEST(DisplacementFit, ASingleElementHasNoDiscretizationError) {
  Scene scene;
  scene.mesh.nodes.resize(3, 4);
  scene.mesh.nodes << 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1;
  scene.mesh.elements = Eigen::Vector4i(0, 1, 2, 3);
  scene.supports.held = ComponentMask::Constant(3, 4, true);
  scene.supports.held.col(3).setConstant(false);
  scene.supports.displacement = Eigen::MatrixXd::Zero(3, 4);
  Eigen::MatrixXd force = Eigen::MatrixXd::Zero(3, 4);
  force.col(3) << 1, 2, -3;
  scene.load_cases.resize(1);
  scene.load_cases[0].loads = {NodalForces{force}};
  Measure({5e4, 0.3}, scene);
  EXPECT_FALSE(IterativeFe().Run(scene, {}).discretization_error.has_value());
}

TEST(DisplacementFit, TooFewComponentsAreNotUsable) {
  Scene scene = MeasuredOrgan();
  AddNoise(0.01, 1, scene);
  ComponentMask& mask = scene.load_cases[0].observed;
  mask = ComponentMask::Constant(3, scene.mesh.NumNodes(), false);
  mask.rightCols<1>().setConstant(true);
  mask(0, scene.mesh.NumNodes() - 2) = true;
  const Estimate estimate = IterativeFe().Run(scene, {});
  EXPECT_EQ(estimate.status, Status::kNotIdentifiable);
  EXPECT_EQ(estimate.message.find("too few components"), 0);
  EXPECT_FALSE(estimate.why_no_standard_error.empty());

  // One unknown less, or a fifth component, is enough.
  EstimatorOptions known;
  known.known_poisson_ratio = 0.3;
  EXPECT_EQ(IterativeFe().Run(scene, known).why_no_standard_error, "");
  mask(1, scene.mesh.NumNodes() - 2) = true;
  EXPECT_EQ(IterativeFe().Run(scene, {}).why_no_standard_error, "");
}

TEST(DisplacementFit, AModelThatMissesMuchIsNotUsable) {
  Scene scene = MeasuredOrgan();
  // Told to be held at the bottom, held at the top as well.
  Scene other = scene;
  const double top = scene.mesh.nodes.row(2).maxCoeff();
  for (Eigen::Index node = 0; node < scene.mesh.NumNodes(); ++node) {
    if (scene.mesh.nodes(2, node) > 0.9 * top) {
      other.supports.held.col(node).setConstant(true);
    }
  }
  Measure({5e4, 0.3}, other);
  scene.load_cases[0].displacement = other.load_cases[0].displacement;
  scene.origin = Origin::kComputed;
  EstimatorOptions options;
  options.known_poisson_ratio = 0.3;
  const Estimate estimate = IterativeFe().Run(scene, options);
  EXPECT_EQ(estimate.status, Status::kNotIdentifiable);
  EXPECT_TRUE(estimate.Has(FindingCode::kSmoothResidual)) << estimate.message;
}

}  // namespace
}  // namespace elastimate
