#include "elastimate/estimators/material_fit/facet_error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <variant>

#include "elastimate/core/mesh/facets.h"
#include "elastimate/estimators/registry.h"
#include "tests/scenes.h"

namespace elastimate {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kModulusOfBar = 5e4;

// Returns a round bar in tension, as it was measured at the nodes of a mesh of
// flat facets.
Scene RoundBar(int cells_per_side) {
  constexpr double kPoissonRatio = 0.3;
  constexpr double kStress = 100;
  const Mesh mesh = testing::CylinderMesh(cells_per_side);
  Scene scene = testing::HeldAtBottom(mesh, mesh, Eigen::Vector3d::Zero());
  const Eigen::MatrixXi top = BoundaryFacetsWhere(
      mesh, [&](int node) { return mesh.nodes(2, node) > 0.999; });
  scene.load_cases[0].loads = {
      SurfaceForce{top, Eigen::Vector3d(0, 0, kStress * kPi)}};
  const double strain = kStress / kModulusOfBar;
  scene.load_cases[0].displacement =
      Eigen::Vector3d(-kPoissonRatio * strain, -kPoissonRatio * strain, strain)
          .asDiagonal() *
      mesh.nodes;
  scene.supports.displacement = scene.load_cases[0].displacement;
  scene.origin = Origin::kMeasured;
  return scene;
}

TEST(FacetError, IsThatOfTheModulusOfARoundBar) {
  for (const int cells_per_side : {3, 4}) {
    const Scene scene = RoundBar(cells_per_side);
    const Estimate estimate = MakeEstimator("reduced-fe")->Run(scene, {});
    ASSERT_EQ(estimate.status, Status::kOk) << estimate.message;
    EXPECT_TRUE(estimate.Has(FindingCode::kFlatFacets));
    const std::optional<double> error = ErrorByFacets(
        scene, estimate, scene.load_cases[0].displacement.reshaped());
    const double true_error =
        estimate.elasticity.youngs_modulus / kModulusOfBar - 1;
    EXPECT_GT(true_error, 0.02);
    ASSERT_TRUE(error.has_value());
    EXPECT_NEAR(*error, true_error, 0.05 * true_error);
  }
}

// A traction acts on the area of the mesh, which is too small by as much.
TEST(FacetError, IsNotThatOfTractions) {
  Scene scene = RoundBar(3);
  const auto force = std::get<SurfaceForce>(scene.load_cases[0].loads[0]);
  scene.load_cases[0].loads = {
      Traction{force.facets, Eigen::Vector3d(0, 0, force.force(2) / kPi)}};
  const Estimate estimate = MakeEstimator("reduced-fe")->Run(scene, {});
  ASSERT_EQ(estimate.status, Status::kOk) << estimate.message;
  EXPECT_NEAR(estimate.elasticity.youngs_modulus, kModulusOfBar,
              1e-6 * kModulusOfBar);
  EXPECT_FALSE(estimate.Has(FindingCode::kFlatFacets));
}

// The shear modulus may be well known where E is not.
TEST(FacetError, CountsBesideTheErrorOfTheShearModulus) {
  const Scene scene = RoundBar(3);
  Estimate estimate;
  estimate.Accept();
  estimate.parameters.resize(2);
  estimate.parameters[0].value = kModulusOfBar;
  estimate.parameters[0].is_modulus = true;
  estimate.parameters[1].value = 0.3;
  estimate.parameter_covariance =
      Eigen::Vector2d(std::pow(kModulusOfBar, 2), 1).asDiagonal();
  const Eigen::MatrixXd displacement =
      scene.load_cases[0].displacement.reshaped();
  WarnOfFlatFacets(scene, displacement, estimate);
  EXPECT_FALSE(estimate.Has(FindingCode::kFlatFacets));
  estimate.shear_modulus = {kModulusOfBar / 2.6, 0.01 * kModulusOfBar};
  WarnOfFlatFacets(scene, displacement, estimate);
  EXPECT_TRUE(estimate.Has(FindingCode::kFlatFacets));
}

TEST(FacetError, IsNotLookedForWhereTheMeshIsTheSpecimen) {
  Scene scene = RoundBar(4);
  scene.origin = Origin::kComputed;
  const Estimate estimate = MakeEstimator("reduced-fe")->Run(scene, {});
  ASSERT_EQ(estimate.status, Status::kOk) << estimate.message;
  EXPECT_FALSE(estimate.Has(FindingCode::kFlatFacets));
}

TEST(FacetError, IsZeroForABlock) {
  const Scene scene = testing::ShearedBlock();
  Estimate estimate;
  estimate.parameters.resize(2);
  estimate.parameters[0].value = kModulusOfBar;
  estimate.parameters[1].value = 0.3;
  const std::optional<double> error = ErrorByFacets(
      scene, estimate, scene.load_cases[0].displacement.reshaped());
  ASSERT_TRUE(error.has_value());
  EXPECT_NEAR(*error, 0, 1e-12);
}

}  // namespace
}  // namespace elastimate
