#include "elastimate/estimators/plan/unit_loads.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "elastimate/core/mesh/facets.h"
#include "elastimate/core/scene/scene_builder.h"
#include "tests/element_kinds.h"
#include "tests/scenes.h"

namespace elastimate {
namespace {

using testing::BoxMesh;

// Returns the facets of the box mesh at z = 2.
Eigen::MatrixXi Top(const Mesh& mesh) {
  return FacetsInBox(mesh, Eigen::Vector3d(-9, -9, 2),
                     Eigen::Vector3d(9, 9, 2));
}

class UnitLoadsOfKind
    : public ::testing::TestWithParam<testing::KindOfSection> {};

// Sums forces and moments over the nodes about a point off the body: a pure
// moment is the same about every point.
TEST_P(UnitLoadsOfKind, HaveOneResultantEach) {
  const Mesh mesh = testing::MeshOfKind(GetParam());
  const int dimension = mesh.Dimension();
  const Eigen::MatrixXi all = BoundaryFacets(mesh);
  const Eigen::MatrixXi facets = all.leftCols(all.cols() / 3);
  const std::vector<UnitLoad> loads = UnitLoads(mesh, facets);
  ASSERT_EQ(loads.size(), dimension == 3 ? 6U : 3U);
  for (std::size_t k = 0; k < loads.size(); ++k) {
    SCOPED_TRACE(loads[k].name);
    Eigen::MatrixXd force = Eigen::MatrixXd::Zero(3, mesh.NumNodes());
    force.topRows(dimension) = loads[k].load.force;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    Eigen::Vector3d moment = Eigen::Vector3d::Zero();
    for (Eigen::Index node = 0; node < mesh.NumNodes(); ++node) {
      Eigen::Vector3d arm(5, -3, 0);
      arm.head(dimension) += mesh.nodes.col(node);
      const Eigen::Vector3d f = force.col(node);
      sum += f;
      moment += arm.cross(f);
    }
    if (k < std::size_t(dimension)) {
      EXPECT_LT((sum - Eigen::Vector3d::Unit(Eigen::Index(k))).norm(), 1e-10);
    } else {
      const Eigen::Index axis = dimension == 3 ? Eigen::Index(k) - 3 : 2;
      EXPECT_LT(sum.norm(), 1e-10);
      EXPECT_LT((moment - Eigen::Vector3d::Unit(axis)).norm(), 1e-10);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, UnitLoadsOfKind,
                         ::testing::ValuesIn(testing::AllKindsOfSections()),
                         testing::KindTestName);

TEST(UnitLoads, ActOnTheFacetsAlone) {
  const Mesh mesh = BoxMesh({2, 2, 3}, {1, 1, 2});
  for (const UnitLoad& unit : UnitLoads(mesh, Top(mesh))) {
    for (Eigen::Index node = 0; node < mesh.NumNodes(); ++node) {
      EXPECT_TRUE(mesh.nodes(2, node) == 2 ||
                  unit.load.force.col(node).isZero(0));
    }
  }
}

TEST(UnitLoads, BendAndTwistAFlatFace) {
  const Mesh mesh = BoxMesh({4, 4, 2}, {1, 1, 2});
  const std::vector<UnitLoad> loads = UnitLoads(mesh, Top(mesh));
  ASSERT_EQ(loads[3].name, "moment about x");
  ASSERT_EQ(loads[5].name, "moment about z");
  // Bending is made by tractions along the normal, torsion by tractions within
  // the face.
  EXPECT_LT(loads[3].load.force.topRows(2).norm(), 1e-12);
  EXPECT_GT(loads[3].load.force.row(2).norm(), 0.1);
  EXPECT_LT(loads[5].load.force.row(2).norm(), 1e-12);
}

TEST(LoadedFacets, AreThoseOfAllLoadsOnce) {
  const Mesh mesh = BoxMesh({2, 2, 3}, {1, 1, 2});
  const Eigen::MatrixXi top = Top(mesh);
  ASSERT_EQ(top.cols(), 8);
  Scene scene;
  scene.mesh = mesh;
  scene.load_cases.resize(2);
  scene.load_cases[0].loads = {
      Traction{top.leftCols(3), Eigen::Vector3d::UnitX()},
      BodyForce{Eigen::Vector3d::UnitZ()}};
  scene.load_cases[1].loads = {Pressure{top.leftCols(5), 1},
                               SurfaceForce{top, Eigen::Vector3d::UnitY()}};
  EXPECT_EQ(LoadedFacets(scene), top);
}

TEST(LoadedFacets, AreThoseOfWhichAllVerticesHaveANodalForce) {
  const Mesh mesh = BoxMesh({2, 2, 3}, {1, 1, 2});
  Scene scene;
  scene.mesh = mesh;
  NodalForces forces = {Eigen::MatrixXd::Zero(3, mesh.NumNodes())};
  forces.force.row(1) =
      (mesh.nodes.row(2).array() == 2)
          .select(Eigen::RowVectorXd::Ones(mesh.NumNodes()), 0);
  scene.load_cases.resize(1);
  scene.load_cases[0].loads = {forces};
  EXPECT_EQ(LoadedFacets(scene), Top(mesh));
}

TEST(LoadedFacets, AreNoneUnderABodyForce) {
  EXPECT_EQ(LoadedFacets(testing::UnderBodyForce(testing::SmallScene("cuboid")))
                .cols(),
            0);
}

}  // namespace
}  // namespace elastimate
