#include "elastimate/estimators/material_fit/facet_error.h"

#include <gtest/gtest.h>

#include <cmath>

#include "elastimate/core/mesh/facets.h"
#include "elastimate/estimators/registry.h"
#include "tests/scenes.h"

namespace elastimate {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kModulusOfBar = 5e4;

// Of a round bar in tension, as it was measured at the nodes of a mesh of flat
// facets.
Scene RoundBar(int cells_per_side) {
  constexpr double kPoissonRatio = 0.3;
  constexpr double kStress = 100;
  const Mesh mesh = testing::CylinderMesh(cells_per_side);
  Scene scene = testing::HeldAtBottom(mesh, mesh, Eigen::Vector3d::Zero());
  const Eigen::MatrixXi top = BoundaryFacetsWhere(
      mesh, [&](int node) { return mesh.nodes(2, node) > 0.999; });
  scene.load_cases[0].loads = {Traction{
      top, Eigen::Vector3d(0, 0, kStress * kPi / FacetArea(mesh, top))}};
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
