#include "elastimate/core/scene/simplicial_scene.h"

#include <gtest/gtest.h>

#include <random>

#include "elastimate/core/equilibrium/simulated_measurement.h"
#include "elastimate/core/scene/finer_scene.h"
#include "elastimate/core/scene/loads.h"
#include "tests/element_kinds.h"

namespace elastimate {
namespace {

using testing::KindOfSection;

class SimplicialSceneOfKind : public ::testing::TestWithParam<KindOfSection> {
 protected:
  SimplicialSceneOfKind() {
    const int dimension = scene_.mesh.Dimension();
    const Eigen::MatrixXi facets = BoundaryFacets(scene_.mesh);
    const Eigen::VectorXd ones = Eigen::VectorXd::Ones(dimension);
    scene_.load_cases[0].loads = {BodyForce{ones}, Traction{facets, 2 * ones},
                                  Pressure{facets.leftCols(3), 4},
                                  SurfaceForce{facets.leftCols(5), ones}};
    Measure({3e3, 0.3}, scene_);
    std::mt19937_64 generator(1);
    PointDisplacements& points = scene_.load_cases[0].points;
    points.points = DrawPoints(scene_.mesh, 20, generator);
    points.displacement = Interpolate(scene_.mesh, points.points,
                                      scene_.load_cases[0].displacement);
    simplicial_ = SimplicialScene(scene_);
  }

  // Half of it is the strain energy.
  static double WorkOfLoads(const Scene& scene) {
    return AssembleLoads(scene.mesh, scene.load_cases[0].loads)
        .cwiseProduct(scene.load_cases[0].displacement)
        .sum();
  }

  Scene scene_ = testing::SceneOfKind(GetParam());
  Scene simplicial_;
};

TEST_P(SimplicialSceneOfKind, IsTheSameExperiment) {
  ValidateScene(simplicial_);
  EXPECT_TRUE((simplicial_.supports.held == scene_.supports.held).all());
  EXPECT_EQ(simplicial_.load_cases[0].displacement,
            scene_.load_cases[0].displacement);
  EXPECT_EQ(simplicial_.load_cases[0].points.displacement,
            scene_.load_cases[0].points.displacement);
  // Sides of distorted hexahedra are not flat.
  const double tolerance =
      scene_.mesh.kind == ElementKind::kHex8 || IsCurved(scene_.mesh.kind)
          ? 0.02
          : 1e-10;
  for (std::size_t i = 0; i < scene_.load_cases[0].loads.size(); ++i) {
    const LoadResultant expected =
        ResultantOf(scene_.mesh, scene_.load_cases[0].loads[i]);
    const LoadResultant resultant =
        ResultantOf(simplicial_.mesh, simplicial_.load_cases[0].loads[i]);
    EXPECT_LT((resultant.force - expected.force).norm(),
              tolerance * expected.force.norm());
  }
}

// Which quadratic elements of these simplices give way to more.
TEST_P(SimplicialSceneOfKind, BecomesOneOfFinerElements) {
  Scene finer = FinerScene(scene_);
  finer.load_cases[0].points = {};
  ValidateScene(finer);
  Measure({3e3, 0.3}, finer);
  EXPECT_GT(WorkOfLoads(finer), 1.001 * WorkOfLoads(scene_));
}

INSTANTIATE_TEST_SUITE_P(All, SimplicialSceneOfKind,
                         ::testing::ValuesIn(testing::AllKindsOfSections()),
                         testing::KindTestName);

}  // namespace
}  // namespace elastimate
