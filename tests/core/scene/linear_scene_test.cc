#include "elastimate/core/scene/linear_scene.h"

#include <gtest/gtest.h>

#include <random>

#include "elastimate/core/equilibrium/simulated_measurement.h"
#include "elastimate/core/scene/finer_scene.h"
#include "elastimate/core/scene/loads.h"
#include "tests/element_kinds.h"

namespace elastimate {
namespace {

using testing::KindOfSection;

class LinearSceneOfKind : public ::testing::TestWithParam<KindOfSection> {
 protected:
  LinearSceneOfKind() {
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
    linear_ = LinearScene(scene_);
  }

  // Half of it is the strain energy.
  static double WorkOfLoads(const Scene& scene) {
    return AssembleLoads(scene.mesh, scene.load_cases[0].loads)
        .cwiseProduct(scene.load_cases[0].displacement)
        .sum();
  }

  Scene scene_ = testing::SceneOfKind(GetParam());
  Scene linear_;
};

TEST_P(LinearSceneOfKind, IsTheSameExperiment) {
  ValidateScene(linear_);
  EXPECT_TRUE((linear_.supports.held == scene_.supports.held).all());
  EXPECT_EQ(linear_.load_cases[0].displacement,
            scene_.load_cases[0].displacement);
  EXPECT_EQ(linear_.load_cases[0].points.displacement,
            scene_.load_cases[0].points.displacement);
  // Parts of curved elements are not curved.  Areas of sides that are not flat
  // are integrated in parts more exactly.
  const double tolerance =
      IsCurved(scene_.mesh.kind)                                    ? 0.02
      : IsSimplex(scene_.mesh.kind) || scene_.mesh.Dimension() == 2 ? 1e-10
                                                                    : 1e-3;
  for (std::size_t i = 0; i < scene_.load_cases[0].loads.size(); ++i) {
    const LoadResultant expected =
        ResultantOf(scene_.mesh, scene_.load_cases[0].loads[i]);
    const LoadResultant resultant =
        ResultantOf(linear_.mesh, linear_.load_cases[0].loads[i]);
    EXPECT_LT((resultant.force - expected.force).norm(),
              tolerance * expected.force.norm());
  }
}

// Which quadratic elements of these parts give way to more.
TEST_P(LinearSceneOfKind, BecomesOneOfFinerElements) {
  Scene finer = FinerScene(scene_);
  finer.load_cases[0].points = {};
  ValidateScene(finer);
  Measure({3e3, 0.3}, finer);
  EXPECT_GT(WorkOfLoads(finer), 1.001 * WorkOfLoads(scene_));
}

INSTANTIATE_TEST_SUITE_P(All, LinearSceneOfKind,
                         ::testing::ValuesIn(testing::AllKindsOfSections()),
                         testing::KindTestName);

}  // namespace
}  // namespace elastimate
