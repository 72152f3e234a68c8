#include "elastimate/estimators/material_fit/shear_modulus.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "elastimate/core/equilibrium/simulated_measurement.h"
#include "elastimate/core/mesh/facets.h"
#include "elastimate/estimators/registry.h"
#include "tests/element_kinds.h"
#include "tests/scenes.h"
#include "tests/shapes.h"

namespace elastimate {
namespace {

constexpr double kYoungsModulusOfShape = 5e4;

Scene TwistedShape(const std::string& shape, double poisson_ratio,
                   double noise) {
  Scene scene = testing::ShapeScene(shape, "torsion");
  testing::MeasureInCutWorld({kYoungsModulusOfShape, poisson_ratio}, scene);
  testing::AddNoise(noise, 1, scene);
  return scene;
}

Estimate FitAtSmallStrains(const std::string& estimator, const Scene& scene) {
  EstimatorOptions options;
  options.kinematics = Kinematics::kSmall;
  return MakeEstimator(estimator)->Run(scene, options);
}

struct Torsion {
  std::string estimator;
  double poisson_ratio;
};

class ShearModulus : public ::testing::TestWithParam<Torsion> {};

TEST_P(ShearModulus, IsWhatTorsionDetermines) {
  const double nu = GetParam().poisson_ratio;
  const IsotropicElasticity truth = {kYoungsModulusOfShape, nu};
  const Estimate estimate = FitAtSmallStrains(
      GetParam().estimator, TwistedShape("dumbbell", nu, 0.02));
  ASSERT_EQ(estimate.status, Status::kOk) << estimate.message;
  ASSERT_TRUE(estimate.shear_modulus.has_value());
  const double error = estimate.shear_modulus->standard_error;
  EXPECT_LT(std::abs(estimate.ShearModulus() - truth.ShearModulus()),
            3 * error);
  EXPECT_LT(error, 0.05 * truth.ShearModulus());
  EXPECT_EQ(estimate.ShearModulusStandardError(), error);
  EXPECT_TRUE(estimate.Has(FindingCode::kParametersUndetermined));
  for (const ParameterEstimate& parameter : estimate.parameters) {
    ASSERT_TRUE(parameter.interval.has_value()) << parameter.name;
    const double true_value =
        parameter.is_modulus ? truth.youngs_modulus : truth.poisson_ratio;
    EXPECT_LT(parameter.interval->lower, true_value) << parameter.name;
    EXPECT_GT(parameter.interval->upper, true_value) << parameter.name;
  }
}

INSTANTIATE_TEST_SUITE_P(
    All, ShearModulus,
    ::testing::Values(Torsion{"reduced-fe", 0.3}, Torsion{"iterative-fe", 0.3},
                      Torsion{"auto", 0.45}),
    [](const auto& test) {
      std::string name = test.param.estimator;
      name.erase(std::remove(name.begin(), name.end(), '-'), name.end());
      return name;
    });

// Exact data of simple shear leave one direction free.
TEST(ShearModulus, OfABlockInSimpleShear) {
  const Estimate estimate =
      FitAtSmallStrains("reduced-fe", testing::ShearedBlock());
  ASSERT_TRUE(estimate.shear_modulus.has_value()) << estimate.message;
  EXPECT_NEAR(estimate.shear_modulus->value, 5e4 / 2.6, 1e-6 * 5e4);
  EXPECT_EQ(estimate.status, Status::kOk) << estimate.message;
}

// Pressure from all sides acts on the bulk modulus alone.
TEST(ShearModulus, IsNotDeterminedByAnotherModulus) {
  constexpr double kPressure = 50;
  const Mesh mesh = testing::BoxMesh({2, 2, 2}, {1, 1, 1});
  Scene scene = testing::HeldAtBottom(mesh, mesh, Eigen::Vector3d::Zero());
  scene.supports.held.setConstant(false);
  scene.load_cases[0].loads.clear();
  const Eigen::MatrixXi facets = BoundaryFacets(mesh);
  for (int axis = 0; axis < 3; ++axis) {
    testing::HoldPlane(axis, 0, 0, scene);
    std::vector<Eigen::Index> of_face;
    for (Eigen::Index i = 0; i < facets.cols(); ++i) {
      if (mesh.nodes(axis, facets.col(i)).minCoeff() > 0.999) {
        of_face.push_back(i);
      }
    }
    scene.load_cases[0].loads.emplace_back(Traction{
        facets(Eigen::all, of_face), -kPressure * Eigen::Vector3d::Unit(axis)});
  }
  Measure({5e4, 0.3}, scene);
  const Estimate estimate = FitAtSmallStrains("reduced-fe", scene);
  EXPECT_TRUE(estimate.IsRefusedFor(FindingCode::kParametersUndetermined))
      << estimate.message;
  EXPECT_FALSE(estimate.shear_modulus.has_value());
}

TEST(ShearModulus, IsNotLookedForWherePoissonRatioIsGiven) {
  EstimatorOptions options;
  options.kinematics = Kinematics::kSmall;
  options.known_poisson_ratio = 0.3;
  const Estimate estimate =
      MakeEstimator("reduced-fe")
          ->Run(TwistedShape("dumbbell", 0.3, 0.02), options);
  EXPECT_FALSE(estimate.shear_modulus.has_value());
  EXPECT_EQ(estimate.status, Status::kOk) << estimate.message;
}

}  // namespace
}  // namespace elastimate
