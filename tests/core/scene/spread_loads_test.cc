#include "elastimate/core/scene/spread_loads.h"

#include <gtest/gtest.h>

#include <cmath>
#include <variant>
#include <vector>

#include "elastimate/core/mesh/facets.h"
#include "elastimate/core/scene/linear_scene.h"
#include "elastimate/core/scene/loads.h"
#include "elastimate/core/scene/quadratic_scene.h"
#include "tests/regions.h"
#include "tests/scenes.h"

namespace elastimate {
namespace {

// A distorted block that is held below, with no load yet.
Scene HeldBlock() {
  Scene scene = testing::BlockUnderTraction({3, 3, 3}, {1, 1, 2});
  scene.mesh = testing::Distorted(scene.mesh);
  scene.load_cases[0].loads.clear();
  return scene;
}

Eigen::MatrixXi FacetsWhere(const Mesh& mesh, double lowest) {
  const Eigen::MatrixXi surface = BoundaryFacets(mesh);
  std::vector<Eigen::Index> found;
  for (Eigen::Index i = 0; i < surface.cols(); ++i) {
    if (mesh.nodes(2, surface.col(i)).minCoeff() > lowest) {
      found.push_back(i);
    }
  }
  return surface(Eigen::all, found);
}

NodalForces NodalForcesOf(const Mesh& mesh, const Load& load) {
  return {AssembleLoads(mesh, {load})};
}

// Expects that nodal forces made of `load`, once they are spread out again, act
// as `load` itself does, on quadratic elements and on the linear ones that
// these are divided into.
void ExpectSameOnOtherElements(Scene scene, const Load& load,
                               double tolerance) {
  scene.load_cases[0].loads = {load};
  const Scene meant = QuadraticScene(scene);
  const Eigen::MatrixXd cut_meant = AssembleLoadCases(LinearScene(meant));
  scene.load_cases[0].loads = {NodalForcesOf(scene.mesh, load)};
  const Scene spread = QuadraticScene(scene);
  const Eigen::MatrixXd force = AssembleLoadCases(meant);
  EXPECT_LT((AssembleLoadCases(spread) - force).norm(),
            tolerance * force.norm());
  EXPECT_LT((AssembleLoadCases(LinearScene(spread)) - cut_meant).norm(),
            tolerance * cut_meant.norm());
}

TEST(SpreadLoads, FindsAUniformTraction) {
  const Scene scene = HeldBlock();
  ExpectSameOnOtherElements(
      scene, Traction{FacetsWhere(scene.mesh, 1.7), Eigen::Vector3d(1, 2, 3)},
      1e-12);
}

// At edges of the block, the forces of two faces add up.
TEST(SpreadLoads, FindsAPressure) {
  const Scene scene = HeldBlock();
  ExpectSameOnOtherElements(scene, Pressure{FacetsWhere(scene.mesh, 0.5), 3},
                            1e-12);
}

TEST(SpreadLoads, FindsABodyForce) {
  ExpectSameOnOtherElements(HeldBlock(), BodyForce{Eigen::Vector3d(1, 2, -9)},
                            1e-12);
}

// Torsion makes such a traction.  The spread forces are within 30 % of it,
// while forces that stay at the vertices would be off by all of it.
TEST(SpreadLoads, FindsALinearTractionNearly) {
  const Scene scene = HeldBlock();
  const Eigen::MatrixXi facets = FacetsWhere(scene.mesh, 1.7);
  Eigen::MatrixXd traction(3, facets.cols());
  for (Eigen::Index i = 0; i < facets.cols(); ++i) {
    const Eigen::Vector3d centre =
        scene.mesh.nodes(Eigen::all, facets.col(i)).rowwise().mean();
    traction.col(i) << 0.5 - centre.y(), centre.x() - 0.5, 0;
  }
  ExpectSameOnOtherElements(scene, Traction{facets, traction}, 0.3);
}

TEST(SpreadLoads, KeepsTheNodalForces) {
  const Scene scene = HeldBlock();
  const Eigen::MatrixXd random =
      Eigen::MatrixXd::Random(3, scene.mesh.NumNodes());
  for (const double share : {0.1, 0.5, 1.0}) {
    NodalForces load{random};
    for (Eigen::Index i = 0; i < random.cols(); ++i) {
      if (std::abs(random(0, i)) > share) {
        load.force.col(i).setZero();
      }
    }
    const std::vector<Load> spread = SpreadLoads(
        scene.mesh, BoundaryFacets(scene.mesh), scene.supports.held, {load});
    EXPECT_LT((AssembleLoads(scene.mesh, spread) - load.force).norm(),
              1e-12 * load.force.norm())
        << share;
  }
}

TEST(SpreadLoads, LeavesPointForcesAndOtherLoads) {
  const Scene scene = HeldBlock();
  NodalForces load{Eigen::MatrixXd::Zero(3, scene.mesh.NumNodes())};
  load.force.rightCols(1).setConstant(2);
  const std::vector<Load> loads = {BodyForce{Eigen::Vector3d(1, 2, 3)}, load};
  const std::vector<Load> spread = SpreadLoads(
      scene.mesh, BoundaryFacets(scene.mesh), scene.supports.held, loads);
  ASSERT_EQ(spread.size(), 2);
  EXPECT_TRUE(std::holds_alternative<BodyForce>(spread[0]));
  EXPECT_EQ(std::get<NodalForces>(spread[1]).force, load.force);
}

}  // namespace
}  // namespace elastimate
