#include "elastimate/estimators/validation/cross_validation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <variant>
#include <vector>

#include "elastimate/core/equilibrium/large_strain_equilibrium.h"
#include "elastimate/core/scene/rigid_motion.h"
#include "elastimate/estimators/registry.h"
#include "tests/regions.h"
#include "tests/scenes.h"
#include "tests/throws.h"

namespace elastimate {
namespace {

Scene ComputedColumn() {
  const Mesh mesh = testing::BoxMesh({2, 2, 4}, {1, 1, 2});
  Scene scene =
      testing::HeldAtBottom(testing::Distorted(mesh), mesh, {0.3, 0.1, -1});
  testing::Measure({100, 0.3}, scene);
  scene.origin = Origin::kComputed;
  return scene;
}

CrossValidation Validate(const Scene& scene,
                         HeldOutPart part = HeldOutPart::kAutomatic) {
  return CrossValidate(scene, DivideMeasurement(scene, part, 4),
                       *MakeEstimator("iterative-fe"), {}, [](int) {});
}

TEST(CrossValidation, FindsTheErrorOfAPartThatTheRestContradicts) {
  Scene scene = ComputedColumn();
  scene.load_cases[0].noise_sd = 1e-6;
  const Folds folds = DivideMeasurement(scene, HeldOutPart::kPoints, 4);
  const Eigen::Vector3d offset(3e-4, -4e-4, 0);
  // The fold that is held out must not take part in the fit.
  constexpr int kFold = 2;
  int num_nodes = 0;
  for (int node = 0; node < scene.mesh.NumNodes(); ++node) {
    if (folds.of_nodes[0](node) == kFold) {
      scene.load_cases[0].displacement.col(node) += offset;
      ++num_nodes;
    }
  }
  const CrossValidation validation = CrossValidate(
      scene, folds, *MakeEstimator("iterative-fe"), {}, [](int) {});
  const Prediction& off = validation.folds[kFold].prediction;
  EXPECT_EQ(off.num_values, 3 * num_nodes);
  EXPECT_NEAR(off.RmsError(), offset.norm() / std::sqrt(3), 1e-9);
  EXPECT_TRUE(off.IsOff());
  for (int node = 0; node < scene.mesh.NumNodes(); ++node) {
    if (folds.of_nodes[0](node) == kFold) {
      EXPECT_LT((validation.errors[0].of_nodes.col(node) - offset).norm(),
                1e-8);
      EXPECT_NEAR(validation.errors[0].standardised_of_nodes(0, node), 300, 9);
    }
  }
}

// Returns chi^2 per value of 20 draws of noise on all nodes, with 4 folds each.
double MeanChiSquare(const Scene& exact, bool is_noise_known) {
  constexpr int kDraws = 20;
  constexpr double kNoise = 3e-4;
  std::mt19937_64 generator(1);
  std::normal_distribution<double> normal(0, kNoise);
  double chi_square = 0;
  double num_values = 0;
  for (int draw = 0; draw < kDraws; ++draw) {
    Scene scene = exact;
    for (LoadCase& load_case : scene.load_cases) {
      load_case.displacement = load_case.displacement.unaryExpr(
          [&](double u) { return u + normal(generator); });
      if (is_noise_known) {
        load_case.noise_sd = kNoise;
      }
    }
    const Prediction total = Validate(scene).Total();
    chi_square += total.chi_square;
    num_values += static_cast<double>(total.num_values);
  }
  // The standard deviation of the mean is sqrt(2 / num_values) = 0.03, and
  // somewhat more, because fits of one draw share most of their data.
  EXPECT_GT(num_values, 2000);
  return chi_square / num_values;
}

TEST(CrossValidationStatistics, AreCalibratedOverPoints) {
  EXPECT_NEAR(MeanChiSquare(ComputedColumn(), true), 1, 0.12);
  EXPECT_NEAR(MeanChiSquare(ComputedColumn(), false), 1, 0.12);
}

TEST(CrossValidationStatistics, AreCalibratedOverLoadCases) {
  Scene scene = testing::WithThreeForces(ComputedColumn());
  testing::Measure({100, 0.3}, scene);
  EXPECT_NEAR(MeanChiSquare(scene, true), 1, 0.12);
}

TEST(CrossValidationStatistics, AreCalibratedUnderUnknownMotion) {
  Scene scene = ComputedColumn();
  scene.is_rigid_motion_free = true;
  EXPECT_NEAR(MeanChiSquare(scene, true), 1, 0.12);
}

// Turns the camera by a finite rotation.
Scene SeenByATurnedCamera(Scene scene) {
  const Eigen::MatrixXd& nodes = scene.mesh.nodes;
  for (LoadCase& load_case : scene.load_cases) {
    load_case.displacement =
        MovedRigidly(nodes + load_case.displacement,
                     (Eigen::VectorXd(6) << 0.1, 0.2, -0.1, 0.05, 0.3, -0.1)
                         .finished()) -
        nodes;
  }
  scene.is_rigid_motion_free = true;
  return scene;
}

TEST(CrossValidationStatistics, AreCalibratedUnderACameraThatTurned) {
  // A computed column of small strains, of 4e-3.
  Scene scene = ComputedColumn();
  testing::Measure({2500, 0.3}, scene);
  EXPECT_NEAR(MeanChiSquare(SeenByATurnedCamera(scene), true), 1, 0.12);
}

TEST(CrossValidationLong, PredictsWhatACameraMeasuredThatTurned) {
  Scene scene = testing::ShearedBlock();
  scene.origin = Origin::kMeasured;
  scene.load_cases[0].displacement /= 10;
  std::get<NodalForces>(scene.load_cases[0].loads[0]).force /= 10;
  scene = SeenByATurnedCamera(scene);
  constexpr double kNoise = 1e-5;
  scene.load_cases[0].noise_sd = kNoise;
  std::mt19937_64 generator(3);
  std::normal_distribution<double> normal(0, kNoise);
  for (double& value : scene.load_cases[0].displacement.reshaped()) {
    value += normal(generator);
  }
  const CrossValidation validation = Validate(scene);
  EXPECT_TRUE(validation.IsComplete());
  EXPECT_NEAR(validation.Total().ErrorRatio(), 1, 0.25);
}

TEST(CrossValidation, TellsAModelThatIsTooSimple) {
  Scene scene = testing::BlockUnderTraction({3, 3, 6}, {1, 1, 2});
  testing::DivideIntoRegions({1, 1, 2}, {1, 1, 2}, scene);
  testing::MeasureByTextbook({{100, 0.3}, {300, 0.3}}, scene);
  scene.origin = Origin::kComputed;
  scene.load_cases[0].noise_sd = testing::AddNoise(0.01, 5, scene);
  const Prediction right = Validate(scene).Total();
  EXPECT_FALSE(right.IsOff()) << right.ErrorRatio();
  EXPECT_LT(right.RelativeError(), 0.02);
  scene.materials.clear();
  const CrossValidation wrong = Validate(scene);
  EXPECT_TRUE(wrong.Total().IsOff()) << wrong.Total().ErrorRatio();
  EXPECT_GT(wrong.Total().RelativeError(), 0.03);
}

TEST(CrossValidation, PredictsAtLargeStrains) {
  Scene scene = ComputedColumn();
  scene.materials.resize(1);
  scene.materials[0].law = "neo_hookean";
  scene.origin = Origin::kComputedAtLargeStrains;
  LargeStrainEquilibrium model(scene);
  const LargeStrainState state = model.Solve(
      model.Forces().Parameters().Moduli(Eigen::Vector2d(2000, 0.3)), 0);
  ASSERT_EQ(state.status, EquilibriumStatus::kDone);
  scene.load_cases[0].displacement =
      state.displacement.reshaped(3, scene.mesh.NumNodes());
  scene.load_cases[0].noise_sd = testing::AddNoise(0.02, 5, scene);
  const CrossValidation validation = Validate(scene);
  EXPECT_TRUE(validation.IsComplete());
  EXPECT_NEAR(validation.Total().ErrorRatio(), 1, 0.25);
}

TEST(CrossValidation, SaysWhyAPartIsNotPredicted) {
  Scene scene = ComputedColumn();
  // Displacements against the loads have no modulus.
  scene.load_cases[0].displacement *= -1;
  const CrossValidation validation = Validate(scene);
  EXPECT_FALSE(validation.IsComplete());
  EXPECT_FALSE(validation.folds[0].why_not.empty());
  EXPECT_EQ(validation.Total().num_values, 0);
}

TEST(CrossValidation, RefusesMaps) {
  Scene scene = ComputedColumn();
  scene.materials.resize(1);
  scene.materials[0].fields = {"youngs_modulus"};
  EXPECT_THROWS_WITH(Validate(scene), "a map cannot be validated");
}

}  // namespace
}  // namespace elastimate
