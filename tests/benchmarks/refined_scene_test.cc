// Quadratic elements of unseen shapes are cut into linear simplices on their
// nodes.  These tests check that the body, its surface and its loads stay.

#include <gtest/gtest.h>

#include <string>

#include "benchmarks/unseen_shapes.h"
#include "elastimate/core/equilibrium/simulated_measurement.h"
#include "elastimate/core/mesh/facets.h"
#include "elastimate/core/scene/linear_scene.h"
#include "elastimate/core/scene/loads.h"
#include "elastimate/core/scene/quadratic_scene.h"

namespace elastimate {
namespace {

constexpr IsotropicElasticity kTruth = {5e3, 0.3};
constexpr double kRounding = 1e-10;  // Relative, of sums.

// Half of it is the strain energy.
double WorkOfLoads(const Scene& scene, std::size_t k) {
  const LoadCase& load_case = scene.load_cases[k];
  return AssembleLoads(scene.mesh, load_case.loads)
      .cwiseProduct(load_case.displacement)
      .sum();
}

class RefinedShape : public ::testing::TestWithParam<UnseenShape> {
 protected:
  Scene scene_ = UnmeasuredScene(GetParam(), TetrahedralMesh(GetParam().body));
  Scene refined_ = LinearScene(QuadraticScene(scene_));
};

TEST_P(RefinedShape, IsTheSameBody) {
  ValidateScene(scene_);
  ValidateScene(refined_);
  EXPECT_EQ(refined_.mesh.NumElements(), 8 * scene_.mesh.NumElements());
  EXPECT_EQ(refined_.mesh.nodes.leftCols(scene_.mesh.NumNodes()),
            scene_.mesh.nodes);

  const Eigen::VectorXd volumes = ElementVolumes(scene_.mesh);
  const Eigen::VectorXd cut = ElementVolumes(refined_.mesh);
  EXPECT_TRUE(cut.isApprox(volumes.transpose().replicate<8, 1>().reshaped() / 8,
                           kRounding));

  const Eigen::MatrixXi facets = BoundaryFacets(scene_.mesh);
  const Eigen::MatrixXi cut_facets = BoundaryFacets(refined_.mesh);
  EXPECT_EQ(cut_facets.cols(), 4 * facets.cols());
  const double area = FacetArea(scene_.mesh, facets);
  EXPECT_NEAR(FacetArea(refined_.mesh, cut_facets), area, kRounding * area);
}

TEST_P(RefinedShape, HasTheSameLoads) {
  for (std::size_t k = 0; k < scene_.load_cases.size(); ++k) {
    const std::vector<Load>& loads = scene_.load_cases[k].loads;
    const std::vector<Load>& cut = refined_.load_cases[k].loads;
    ASSERT_EQ(cut.size(), loads.size());
    ASSERT_GT(loads.size(), 0);
    for (std::size_t i = 0; i < loads.size(); ++i) {
      const LoadResultant whole = ResultantOf(scene_.mesh, loads[i]);
      const LoadResultant parts = ResultantOf(refined_.mesh, cut[i]);
      EXPECT_LT((parts.force - whole.force).norm(),
                kRounding * (1 + whole.force.norm()));
      if (whole.area) {
        EXPECT_GT(*whole.area, 0);
        EXPECT_NEAR(*parts.area, *whole.area, kRounding * *whole.area);
      }
    }
  }
}

// The refined mesh can take every displacement of the mesh, so it is softer and
// takes up more energy.
TEST_P(RefinedShape, IsSofter) {
  Measure(kTruth, scene_);
  Scene finer = refined_;
  Measure(kTruth, finer);
  for (std::size_t k = 0; k < scene_.load_cases.size(); ++k) {
    EXPECT_GT(WorkOfLoads(finer, k), WorkOfLoads(scene_, k));
  }
}

std::string NameOf(const ::testing::TestParamInfo<UnseenShape>& info) {
  std::string name;
  for (const char character : info.param.name) {
    name += character == ' ' ? '_' : character;
  }
  return name;
}

INSTANTIATE_TEST_SUITE_P(All, RefinedShape, ::testing::ValuesIn(UnseenShapes()),
                         NameOf);

}  // namespace
}  // namespace elastimate
