#include "elastimate/estimators/reduced_model/reduced_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "elastimate/core/equilibrium/equilibrium.h"
#include "elastimate/core/mechanics/stiffness_product.h"
#include "elastimate/core/scene/degrees_of_freedom.h"
#include "tests/scenes.h"
#include "tests/shapes.h"

namespace elastimate {
namespace {

using testing::Measure;
using testing::SmallScene;
using testing::SmallSceneNames;

// Returns the responses w and v of the full model.
Eigen::MatrixXd FullResponses(const Scene& scene, double nu) {
  Equilibrium model(scene, SolverKind::kCholesky);
  const auto elasticity =
      IsotropicElasticity::FromComplianceScale(1, nu, scene.mesh.section.model);
  EXPECT_TRUE(
      model.Solve(model.Forces().Parameters().Moduli(elasticity.Parameters())));
  const Eigen::MatrixXd& of_supports = model.SupportResponse();
  Eigen::MatrixXd responses(of_supports.rows(), of_supports.cols() + 1);
  responses << model.Displacement() - of_supports,
      of_supports.col(0) - HeldDisplacement(scene.supports);
  return responses;
}

Eigen::VectorXd ReducedResponse(const ReducedModel& model, Eigen::Index k,
                                double nu) {
  const ReducedModes& modes = model.Modes(k);
  return model.Basis(k) * (modes.vectors * modes.At(nu));
}

// Returns ||x||_A by the stiffness products.
double EnergyNorm(const Mesh& mesh, const Eigen::VectorXd& x, double nu) {
  const StiffnessProducts products = MultiplyStiffnessBasis(mesh, x);
  return std::sqrt(
      std::max(0.0, x.dot(products.h.col(0) + nu * products.j.col(0))));
}

Scene PulledScene() {
  Scene scene = testing::WithThreeForces(SmallScene("organ"));
  for (Eigen::Index node = 0; node < scene.mesh.NumNodes(); ++node) {
    scene.supports.displacement.col(node) << 0.01 * scene.mesh.nodes(1, node),
        -0.02, 0.03;
  }
  return scene;
}

// The bound is above the error at every nu, with poles far from nu and near it,
// with few vectors and with many.
TEST(ReducedModel, ErrorIsBelowItsBound) {
  for (const std::string& shape : testing::ShapeNames()) {
    Scene scene = testing::ShapeScene(shape, "gravity");
    for (Eigen::Index node = 0; node < scene.mesh.NumNodes(); ++node) {
      scene.supports.displacement.col(node) << 0.1 * scene.mesh.nodes(1, node),
          -0.2, 0.3;
    }
    for (const double pole : {-0.6, 0.3, 0.49}) {
      ReducedModel model(scene);
      EXPECT_EQ(model.ErrorBound(0, 0.1),
                std::numeric_limits<double>::infinity());
      ASSERT_TRUE(model.SetPole(pole));
      for (int vectors = 0; vectors < 13; ++vectors) {
        if (vectors == 0 || vectors == 2 || vectors == 12) {
          for (const double nu : {-0.99, -0.3, 0.2, 0.47, 0.4995, 0.49999}) {
            SCOPED_TRACE(shape + ", pole " + std::to_string(pole) + ", nu " +
                         std::to_string(nu) + ", vectors " +
                         std::to_string(vectors));
            const Eigen::MatrixXd exact = FullResponses(scene, nu);
            for (Eigen::Index k = 0; k < exact.cols(); ++k) {
              const double error = EnergyNorm(
                  scene.mesh, exact.col(k) - ReducedResponse(model, k, nu), nu);
              // The reference has rounding errors, since its condition number
              // is 1 / (1 - 2 nu).
              const double rounding =
                  1e-9 * EnergyNorm(scene.mesh, exact.col(k), nu);
              EXPECT_LE(error, model.ErrorBound(k, nu) + rounding);
            }
          }
        }
        ASSERT_TRUE(model.Enlarge());
      }
    }
  }
}

// The sum of the spaces of two poles is at least as good as either.
TEST(ReducedModel, BoundsHoldForSeveralPoles) {
  const Scene scene = testing::ShapeScene("dumbbell", "bending");
  ReducedModel model(scene);
  double bound = std::numeric_limits<double>::infinity();
  for (const double pole : {0.4995, -0.9, 0.3}) {
    ASSERT_TRUE(model.SetPole(pole));
    for (int i = 0; i < 6; ++i) {
      ASSERT_TRUE(model.Enlarge());
    }
    EXPECT_LE(model.ErrorBound(0, 0.48), bound);
    bound = model.ErrorBound(0, 0.48);
    for (const double nu : {-0.95, 0.0, 0.48, 0.499}) {
      const Eigen::VectorXd exact = FullResponses(scene, nu).col(0);
      EXPECT_LE(
          EnergyNorm(scene.mesh, exact - ReducedResponse(model, 0, nu), nu),
          model.ErrorBound(0, nu) + 1e-9 * EnergyNorm(scene.mesh, exact, nu));
    }
  }
}

TEST(ReducedModel, RefinesUntilItAgreesWithTheFullModel) {
  const Scene scene = PulledScene();
  ReducedModel model(scene);
  ASSERT_TRUE(model.SetPole(0.3));
  for (int i = 0; model.RelativeErrorBound(0.1) > 1e-8 ||
                  model.RelativeErrorBound(0.45) > 1e-8;
       ++i) {
    ASSERT_LT(i, 30);
    ASSERT_TRUE(model.Enlarge());
  }
  ASSERT_TRUE(model.HasSupportResponse());
  for (const double nu : {0.1, 0.45}) {
    const Eigen::MatrixXd exact = FullResponses(scene, nu);
    for (Eigen::Index k = 0; k < exact.cols(); ++k) {
      EXPECT_LT((ReducedResponse(model, k, nu) - exact.col(k)).norm(),
                1e-7 * exact.col(k).norm());
    }
  }
}

TEST(ReducedModel, ErrorFallsByOrdersWithEachFewVectors) {
  const Scene scene = SmallScene("organ");
  ReducedModel model(scene);
  ASSERT_TRUE(model.SetPole(0.3));
  for (int i = 0; i < 6; ++i) {
    ASSERT_TRUE(model.Enlarge());
  }
  // Eight vectors from the pole 0.3 leave 1e-7 at 0.4 and 3e-5 at 0.45
  // [measured with another code on another mesh].
  EXPECT_LT(model.RelativeErrorBound(0.4), 1e-5);
  EXPECT_LT(model.RelativeErrorBound(0.45), 1e-3);
}

// J does not act on this displacement, so the response is a known function of
// nu, and no vector is left to add.
TEST(ReducedModel, SaysWhenNoVectorIsLeft) {
  Scene scene = testing::ShearedBlock();
  const IsotropicElasticity unit = {1, 0.3};
  Measure(unit, scene);
  ReducedModel model(scene);
  ASSERT_TRUE(model.SetPole(0.3));
  int vectors = 0;
  while (model.Enlarge()) {
    ASSERT_LT(++vectors, 30);
  }
  EXPECT_LT(model.RelativeErrorBound(-0.9), 1e-7);
  EXPECT_LT(model.RelativeErrorBound(0.499), 1e-7);
}

TEST(ReducedModel, DerivativesAgreeWithFiniteDifferences) {
  const Scene scene = PulledScene();
  ReducedModel model(scene);
  ASSERT_TRUE(model.SetPole(0.2));
  for (int i = 0; i < 4; ++i) {
    ASSERT_TRUE(model.Enlarge());
  }
  constexpr double kStep = 1e-5;
  for (Eigen::Index k = 0; k <= model.NumLoadCases(); ++k) {
    const ReducedModes& modes = model.Modes(k);
    for (const double nu : {-0.5, 0.2, 0.4}) {
      const Eigen::VectorXd difference =
          (modes.At(nu + kStep) - modes.At(nu - kStep)) / (2 * kStep);
      EXPECT_LT((modes.DerivativeAt(nu) - difference).norm(),
                1e-7 * (1 + difference.norm()));
    }
  }
}

TEST(ReducedModel, CountsItsWork) {
  const Scene scene = SmallScene("cuboid");
  ReducedModel model(scene);
  ASSERT_TRUE(model.SetPole(0.3));
  ASSERT_TRUE(model.Enlarge());
  const Work work = model.WorkDone();
  EXPECT_EQ(work.factorizations, 1);
  EXPECT_EQ(work.solves, 3);
  // The assembly; of three vectors, and of the part of two that is new.
  EXPECT_EQ(work.element_passes, 6);
}

TEST(ReducedModel, RefusesAPoleWithoutAStiffness) {
  const Scene scene = SmallScene("cuboid");
  ReducedModel model(scene);
  EXPECT_FALSE(model.SetPole(0.5));
  EXPECT_FALSE(model.SetPole(-1));
}

}  // namespace
}  // namespace elastimate
