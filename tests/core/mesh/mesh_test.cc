#include "elastimate/core/mesh/mesh.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "tests/element_kinds.h"
#include "tests/quadratic_reference.h"
#include "tests/scenes.h"
#include "tests/throws.h"

namespace elastimate {
namespace {

using testing::BoxMesh;
using testing::Distorted;
using testing::WithMidEdgeNodes;

Mesh OneTetrahedron() {
  Mesh mesh;
  mesh.nodes.resize(3, 4);
  mesh.nodes << 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1;
  mesh.elements.resize(4, 1);
  mesh.elements << 0, 1, 2, 3;
  return mesh;
}

TEST(ValidateMesh, AcceptsEitherOrientation) {
  Mesh mesh = OneTetrahedron();
  EXPECT_NO_THROW(ValidateMesh(mesh));
  std::swap(mesh.elements(0), mesh.elements(1));
  EXPECT_NO_THROW(ValidateMesh(mesh));
}

TEST(ValidateMesh, NamesANodeThatIsNotFinite) {
  Mesh mesh = OneTetrahedron();
  mesh.nodes(1, 2) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROWS_WITH(ValidateMesh(mesh), "node 2 .*not finite");
  mesh.nodes(1, 2) = std::numeric_limits<double>::infinity();
  EXPECT_THROWS_WITH(ValidateMesh(mesh), "node 2 .*not finite");
}

TEST(ValidateMesh, RejectsNoElements) {
  Mesh mesh = OneTetrahedron();
  mesh.elements.resize(4, 0);
  EXPECT_THROWS_WITH(ValidateMesh(mesh), "no tetrahedra");
}

TEST(ValidateMesh, RejectsOtherNumbersOfNodesPerElement) {
  Mesh mesh = OneTetrahedron();
  mesh.elements = Eigen::MatrixXi::Zero(3, 1);
  EXPECT_THROWS_WITH(ValidateMesh(mesh), "3 nodes per element");
}

TEST(ValidateMesh, AcceptsQuadraticTetrahedra) {
  for (const double unit : {1e-6, 1.0, 1e6}) {
    Mesh mesh = WithMidEdgeNodes(Distorted(BoxMesh({2, 1, 1}, {1, 1, 1})));
    mesh.nodes *= unit;
    EXPECT_NO_THROW(ValidateMesh(mesh));
    // Positions in single precision are rounded, so mid-edge nodes are off the
    // middle by that.
    mesh.nodes = mesh.nodes.cast<float>().cast<double>().eval();
    EXPECT_NO_THROW(ValidateMesh(mesh));
  }
}

TEST(ValidateMesh, NamesAMidEdgeNodeThatIsNotInTheMiddle) {
  Mesh mesh = WithMidEdgeNodes(OneTetrahedron());
  mesh.nodes(2, 5) += 1e-5;
  EXPECT_THROWS_WITH(
      ValidateMesh(mesh),
      "mid-edge node 5 of tetrahedron 0 \\(nodes 0 1 2 3\\) is not in the "
      "middle between 1 and 2");
  // The mid-edge nodes are in another order than that of VTK.
  mesh = WithMidEdgeNodes(OneTetrahedron());
  std::swap(mesh.elements(4), mesh.elements(7));
  EXPECT_THROWS_WITH(ValidateMesh(mesh), "mid-edge node 7 .*as VTK does");
}

TEST(ValidateMesh, NamesAMidEdgeNodeBeforeTheVertices) {
  Mesh mesh = WithMidEdgeNodes(OneTetrahedron());
  mesh.nodes.col(0).swap(mesh.nodes.col(4));
  mesh.elements(0) = 4;
  mesh.elements(4) = 0;
  EXPECT_THROWS_WITH(ValidateMesh(mesh),
                     "mid-edge node 0 of tetrahedron 0 .*before vertex 4");
}

TEST(ValidateMesh, NamesAQuadraticElementWithANodeOutOfRange) {
  Mesh mesh = WithMidEdgeNodes(OneTetrahedron());
  mesh.elements(9) = 10;
  EXPECT_THROWS_WITH(ValidateMesh(mesh), "tetrahedron 0 .*outside 0..9");
}

TEST(ValidateMesh, NamesAnElementWithANodeOutOfRange) {
  Mesh mesh = OneTetrahedron();
  mesh.elements(3) = 4;
  EXPECT_THROWS_WITH(ValidateMesh(mesh), "tetrahedron 0 .*outside 0..3");
  mesh.elements(3) = -1;
  EXPECT_THROWS_WITH(ValidateMesh(mesh), "tetrahedron 0 .*outside 0..3");
}

TEST(ValidateMesh, NamesAFlatElement) {
  Mesh mesh = OneTetrahedron();
  mesh.nodes.col(3) << 0.3, 0.3, 0;
  EXPECT_THROWS_WITH(ValidateMesh(mesh), "tetrahedron 0 .*flat");
  mesh.nodes.col(3) << 0.3, 0.3, 1e-8;
  EXPECT_THROWS_WITH(ValidateMesh(mesh), "tetrahedron 0 .*flat");
  mesh.nodes.col(3) = mesh.nodes.col(0);
  EXPECT_THROWS_WITH(ValidateMesh(mesh), "tetrahedron 0 .*flat");
  mesh.nodes.setZero();
  EXPECT_THROWS_WITH(ValidateMesh(mesh), "tetrahedron 0 .*flat");
}

TEST(ValidateMesh, FlatnessDoesNotDependOnTheOrderOfTheNodes) {
  // The longest edge is 1, and in some orders it is opposite to the first node.
  // The smallest height is just below and just above a millionth.
  for (const double ratio : {0.99, 1.01}) {
    Mesh mesh = OneTetrahedron();
    mesh.nodes.col(2) << 0.5, 0.1, 0;
    mesh.nodes.col(3) << 0.5, 0.05, 1e-6 * ratio;
    std::array<int, 4> order = {0, 1, 2, 3};
    do {
      mesh.elements = Eigen::Map<Eigen::Vector4i>(order.data());
      if (ratio < 1) {
        EXPECT_THROWS_WITH(ValidateMesh(mesh), "flat");
      } else {
        EXPECT_NO_THROW(ValidateMesh(mesh));
      }
    } while (std::next_permutation(order.begin(), order.end()));
  }
}

TEST(ValidateMesh, AcceptsASliver) {
  Mesh mesh = OneTetrahedron();
  mesh.nodes.col(3) << 0.3, 0.3, 1e-3;
  EXPECT_NO_THROW(ValidateMesh(mesh));
}

TEST(ValidateMesh, FlatnessDoesNotDependOnUnits) {
  for (const double unit : {1e-6, 1e6}) {
    Mesh mesh = OneTetrahedron();
    mesh.nodes *= unit;
    EXPECT_NO_THROW(ValidateMesh(mesh));
    mesh.nodes(2, 3) = 1e-8 * unit;
    EXPECT_THROWS_WITH(ValidateMesh(mesh), "flat");
  }
}

TEST(ValidateMesh, NamesAnUnusedNode) {
  Mesh mesh = OneTetrahedron();
  mesh.nodes.conservativeResize(3, 5);
  mesh.nodes.col(4).setOnes();
  EXPECT_THROWS_WITH(ValidateMesh(mesh), "node 4 belongs to no");
}

TEST(ValidateMesh, RejectsRegionsOfSomeElements) {
  Mesh mesh = OneTetrahedron();
  mesh.regions.setOnes(2);
  EXPECT_THROWS_WITH(ValidateMesh(mesh), "2 region ids for 1");
}

// By the divergence theorem, a closed surface with outward normals has zero
// vector area, and encloses the volume (1/3) sum of x . n.
TEST(BoundaryFacets, EncloseTheVolumeWithOutwardNormals) {
  Mesh mesh = BoxMesh({3, 2, 4}, {1, 2, 3});
  // Some elements get a negative orientation.
  mesh.elements.row(0).head(20).swap(mesh.elements.row(1).head(20));
  const Eigen::MatrixXi facets = BoundaryFacets(mesh);
  ASSERT_EQ(facets.cols(), 2 * 2 * (3 * 2 + 2 * 4 + 3 * 4));
  Eigen::Vector3d area = Eigen::Vector3d::Zero();
  double volume = 0;
  for (Eigen::Index i = 0; i < facets.cols(); ++i) {
    const Eigen::Vector3d p = mesh.nodes.col(facets(0, i));
    const Eigen::Vector3d e1 = mesh.nodes.col(facets(1, i)) - p;
    const Eigen::Vector3d e2 = mesh.nodes.col(facets(2, i)) - p;
    const Eigen::Vector3d normal = e1.cross(e2) / 2;
    area += normal;
    volume += p.dot(normal) / 3;
  }
  EXPECT_NEAR(area.norm(), 0, 1e-12);
  EXPECT_NEAR(volume, 6, 1e-12);
}

TEST(SmallestDihedralAngles, OfTheRegularTetrahedronAndOfACorner) {
  Mesh regular = OneTetrahedron();
  regular.nodes << 1, 1, -1, -1, 1, -1, 1, -1, 1, -1, -1, 1;
  EXPECT_NEAR(SmallestDihedralAngles(regular)(0), std::acos(1.0 / 3), 1e-12);
  // The angle is between a coordinate plane and the plane x + y + z = 1.
  EXPECT_NEAR(SmallestDihedralAngles(OneTetrahedron())(0),
              std::acos(1 / std::sqrt(3.0)), 1e-12);
}

// The upper face is turned by a quarter against the lower one, though every
// vertex has the right orientation.
TEST(ValidateMesh, RefusesAHexahedronThatIsTurnedAgainstItsNeighbour) {
  Mesh mesh = testing::MeshOfKind({ElementKind::kHex8, SectionModel::kSolid});
  EXPECT_NO_THROW(ValidateMesh(mesh));
  const Eigen::VectorXi nodes = mesh.elements.col(0);
  mesh.elements.col(0) << nodes.head(4), nodes(5), nodes(6), nodes(7), nodes(4);
  EXPECT_THROWS_WITH(ValidateMesh(mesh), "share three nodes");
}

}  // namespace
}  // namespace elastimate
