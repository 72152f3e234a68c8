#include "elastimate/core/scene/quadratic_scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <set>
#include <utility>
#include <vector>

#include "elastimate/core/mesh/middle_nodes.h"
#include "elastimate/core/mesh/middles.h"
#include "elastimate/core/scene/loads.h"
#include "elastimate/core/scene/rigid_motion.h"
#include "elastimate/core/scene/support_ends.h"
#include "tests/core/random_values.h"
#include "tests/element_kinds.h"
#include "tests/quadratic_reference.h"
#include "tests/scenes.h"
#include "tests/throws.h"

namespace elastimate {
namespace {

using testing::BoxMesh;
using testing::kNan;
using testing::RandomMatrix;
using testing::SmallScene;
using testing::WithBothOrientations;
using testing::WithMidEdgeNodes;

// Returns the node in the middle between two vertices; -1 where there is none.
int NodeBetween(const Mesh& mesh, int a, int b) {
  const Eigen::Vector3d middle = (mesh.nodes.col(a) + mesh.nodes.col(b)) / 2;
  for (Eigen::Index node = mesh.NumVertices(); node < mesh.NumNodes(); ++node) {
    if (mesh.nodes.col(node) == middle) {
      return static_cast<int>(node);
    }
  }
  return -1;
}

// The scene "organ" gets every kind of load and measurement.
class ConvertedOrgan : public ::testing::Test {
 protected:
  ConvertedOrgan() : scene_(SmallScene("organ")) {
    scene_.mesh = WithBothOrientations(scene_.mesh);
    const Eigen::Index num_nodes = scene_.mesh.NumNodes();
    scene_.mesh.regions.setLinSpaced(scene_.mesh.NumElements(), 1, 5);
    scene_.supports.displacement = RandomMatrix(3, num_nodes, 1);
    const Eigen::MatrixXi facets = BoundaryFacets(scene_.mesh);
    LoadCase second;
    second.loads = {BodyForce{Eigen::Vector3d(0, 0, -9.81)},
                    Traction{facets, Eigen::Vector3d(1, 2, 3)},
                    Pressure{facets.leftCols(7), 2},
                    SurfaceForce{facets.leftCols(5), Eigen::Vector3d(3, 2, 1)}};
    second.displacement = RandomMatrix(3, num_nodes, 2);
    second.observed = RandomMatrix(3, num_nodes, 3).array() > 0;
    second.noise_sd = 1e-3;
    scene_.load_cases.push_back(second);
    quadratic_ = QuadraticScene(scene_);
  }

  Eigen::Index NumVertices() const { return scene_.mesh.NumNodes(); }
  Eigen::Index NumMidEdges() const {
    return quadratic_.mesh.NumNodes() - NumVertices();
  }

  Scene scene_;
  Scene quadratic_;
};

TEST_F(ConvertedOrgan, IsAValidScene) {
  EXPECT_NO_THROW(ValidateScene(quadratic_));
  EXPECT_EQ(WhyNotHeld(quadratic_.mesh, quadratic_.supports), "");
}

TEST_F(ConvertedOrgan, HasOneNodeForEachEdge) {
  const Mesh& mesh = quadratic_.mesh;
  EXPECT_EQ(mesh.Order(), 2);
  EXPECT_EQ(mesh.NumVertices(), NumVertices());
  EXPECT_EQ(mesh.nodes.leftCols(NumVertices()), scene_.mesh.nodes);
  EXPECT_EQ(mesh.elements.topRows<4>(), scene_.mesh.elements);
  EXPECT_EQ(mesh.regions, scene_.mesh.regions);
  const Mesh expected = WithMidEdgeNodes(scene_.mesh);
  ASSERT_EQ(mesh.NumNodes(), expected.NumNodes());
  for (Eigen::Index e = 0; e < mesh.NumElements(); ++e) {
    for (int i = 4; i < 10; ++i) {
      EXPECT_EQ(mesh.nodes.col(mesh.elements(i, e)),
                expected.nodes.col(expected.elements(i, e)));
    }
  }
}

TEST_F(ConvertedOrgan, NumbersTheMidEdgeNodesByTheirEnds) {
  const Mesh& mesh = quadratic_.mesh;
  const auto edges = [&] {
    std::set<std::pair<int, int>> sorted;
    for (Eigen::Index e = 0; e < mesh.NumElements(); ++e) {
      for (int i = 0; i < 4; ++i) {
        for (int j = 0; j < 4; ++j) {
          if (mesh.elements(i, e) < mesh.elements(j, e)) {
            sorted.emplace(mesh.elements(i, e), mesh.elements(j, e));
          }
        }
      }
    }
    return sorted;
  }();
  Eigen::Index node = NumVertices();
  for (const auto& [a, b] : edges) {
    EXPECT_EQ(mesh.nodes.col(node),
              (mesh.nodes.col(a) + mesh.nodes.col(b)) / 2);
    ++node;
  }
  EXPECT_EQ(node, mesh.NumNodes());
}

TEST_F(ConvertedOrgan, KeepsTheSupportsOfTheVertices) {
  const Supports& supports = quadratic_.supports;
  EXPECT_TRUE(
      (supports.held.leftCols(NumVertices()) == scene_.supports.held).all());
  EXPECT_EQ(supports.displacement.leftCols(NumVertices()),
            scene_.supports.displacement);
  // One face of 4 x 4 nodes is held.  It has 24 edges and 9 diagonals.
  EXPECT_EQ(supports.held.rightCols(NumMidEdges()).colwise().all().count(), 33);
  EXPECT_EQ(supports.held.rightCols(NumMidEdges()).count(), 3 * 33);
}

TEST_F(ConvertedOrgan, HoldsMidEdgesAtTheMeanOfTheirEnds) {
  for (int a = 0; a < NumVertices(); ++a) {
    for (int b = 0; b < a; ++b) {
      const int node = NodeBetween(quadratic_.mesh, a, b);
      if (node >= 0 && quadratic_.supports.held(0, node)) {
        EXPECT_EQ(quadratic_.supports.displacement.col(node),
                  (scene_.supports.displacement.col(a) +
                   scene_.supports.displacement.col(b)) /
                      2);
      }
    }
  }
}

// The nodal forces become a force that is spread out.  Adding half of the force
// on each mid-edge node to either end of its edge gives the nodal forces back.
TEST_F(ConvertedOrgan, SpreadsNodalForces) {
  const Eigen::MatrixXd force =
      AssembleLoads(quadratic_.mesh, quadratic_.load_cases[0].loads);
  EXPECT_FALSE(force.rightCols(NumMidEdges()).isZero(0));
  const Eigen::MatrixXd& given =
      std::get<NodalForces>(scene_.load_cases[0].loads[0]).force;
  Eigen::MatrixXd at_vertices = force.leftCols(NumVertices());
  const Middles middles(scene_.mesh);
  for (Eigen::Index i = 0; i < NumMidEdges(); ++i) {
    for (const int end : middles.Vertices()[i]) {
      at_vertices.col(end) += force.col(NumVertices() + i) / 2;
    }
  }
  EXPECT_LT((at_vertices - given).norm(), 1e-12 * given.norm());
}

TEST_F(ConvertedOrgan, LetsPointForcesActAtTheirVertex) {
  Scene scene = scene_;
  NodalForces point{Eigen::MatrixXd::Zero(3, NumVertices())};
  point.force(2, NumVertices() - 1) = 3;
  scene.load_cases[0].loads = {point};
  const Scene quadratic = QuadraticScene(scene);
  ASSERT_EQ(quadratic.load_cases[0].loads.size(), 1);
  const auto& force =
      std::get<NodalForces>(quadratic.load_cases[0].loads[0]).force;
  EXPECT_EQ(force.leftCols(NumVertices()), point.force);
  EXPECT_TRUE(force.rightCols(NumMidEdges()).isZero(0));
}

TEST_F(ConvertedOrgan, KeepsWhatTheOtherLoadsAre) {
  const std::vector<Load>& loads = quadratic_.load_cases[1].loads;
  EXPECT_EQ(std::get<BodyForce>(loads[0]).force_density,
            Eigen::Vector3d(0, 0, -9.81));
  const auto& traction = std::get<Traction>(loads[1]);
  EXPECT_EQ(traction.traction, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(traction.facets, BoundaryFacets(quadratic_.mesh));
  const auto& pressure = std::get<Pressure>(loads[2]);
  EXPECT_EQ(pressure.pressure, 2);
  EXPECT_EQ(pressure.facets, BoundaryFacets(quadratic_.mesh).leftCols(7));
  const auto& force = std::get<SurfaceForce>(loads[3]);
  EXPECT_EQ(force.force, Eigen::Vector3d(3, 2, 1));
  EXPECT_EQ(force.facets, BoundaryFacets(quadratic_.mesh).leftCols(5));
}

// On displacements that linear elements can take, the loads do the same work.
TEST_F(ConvertedOrgan, HasTheVertexForcesOfLinearElements) {
  const Eigen::MatrixXd expected = AssembleLoadCases(scene_);
  EXPECT_TRUE(MiddleNodes(quadratic_.mesh)
                  .Restrict(AssembleLoadCases(quadratic_))
                  .isApprox(expected, 1e-13));
}

TEST_F(ConvertedOrgan, ObservesNoMidEdge) {
  const LoadCase& unmeasured = quadratic_.load_cases[0];
  EXPECT_EQ(unmeasured.displacement.size(), 0);
  EXPECT_FALSE(unmeasured.noise_sd.has_value());
  EXPECT_TRUE(unmeasured.observed.leftCols(NumVertices()).all());
  EXPECT_FALSE(unmeasured.observed.rightCols(NumMidEdges()).any());
  const LoadCase& measured = quadratic_.load_cases[1];
  EXPECT_EQ(measured.displacement.leftCols(NumVertices()),
            scene_.load_cases[1].displacement);
  EXPECT_TRUE(measured.displacement.rightCols(NumMidEdges()).isZero(0));
  EXPECT_EQ(measured.noise_sd, 1e-3);
  EXPECT_TRUE((measured.observed.leftCols(NumVertices()) ==
               scene_.load_cases[1].observed)
                  .all());
  EXPECT_FALSE(measured.observed.rightCols(NumMidEdges()).any());
}

TEST_F(ConvertedOrgan, CannotBeConvertedAgain) {
  EXPECT_THROWS_WITH(QuadraticScene(quadratic_), "quadratic elements already");
}

TEST_F(ConvertedOrgan, NeedsFacetsOfTheMesh) {
  std::get<Traction>(scene_.load_cases[1].loads[1]).facets.col(3) << 0, 1, 79;
  EXPECT_THROWS_WITH(QuadraticScene(scene_), "facet 3 .* not a face");
}

// The displacement of a support is ignored in components that are not held,
// even if it is NaN.
TEST_F(ConvertedOrgan, IgnoresSupportDisplacementsOfFreeComponents) {
  scene_.supports.displacement =
      scene_.supports.held.select(scene_.supports.displacement.array(), kNan);
  EXPECT_NO_THROW(ValidateScene(QuadraticScene(scene_)));
}

// ---------------------------------------------------------------------------
// Which mid-edge components are held, by where the vertices are held.

class BoxToConvert : public ::testing::Test {
 protected:
  // The box consists of cubes of size 1.
  explicit BoxToConvert(const Eigen::Vector3i& cells = {3, 3, 3}) {
    scene_.mesh = BoxMesh(cells, cells.cast<double>());
    scene_.supports.held =
        ComponentMask::Constant(3, scene_.mesh.NumNodes(), false);
    scene_.supports.displacement =
        Eigen::MatrixXd::Zero(3, scene_.mesh.NumNodes());
    scene_.load_cases.resize(1);
  }

  void Hold(int component, const Eigen::Array<bool, 1, Eigen::Dynamic>& nodes) {
    scene_.supports.held.row(component) =
        scene_.supports.held.row(component) || nodes;
  }

  // Returns the middles of the held edges, one column each.
  Eigen::MatrixXd HeldMiddles(int component) const {
    const Scene quadratic = QuadraticScene(scene_);
    std::vector<Eigen::Index> held;
    for (Eigen::Index node = scene_.mesh.NumNodes();
         node < quadratic.mesh.NumNodes(); ++node) {
      if (quadratic.supports.held(component, node)) {
        held.push_back(node);
      }
    }
    return quadratic.mesh.nodes(Eigen::all, held);
  }

  auto Coordinate(int axis) const {
    return scene_.mesh.nodes.row(axis).array();
  }

  Scene scene_;
};

TEST_F(BoxToConvert, NothingIsHeldWithoutSupports) {
  EXPECT_EQ(HeldMiddles(0).cols(), 0);
}

TEST_F(BoxToConvert, AHeldFaceHoldsItsEdgesInTheSameComponents) {
  Hold(1, Coordinate(2) == 0);
  const Eigen::MatrixXd middles = HeldMiddles(1);
  // The face has 2 * 3 * 4 edges along the axes, and 3 * 3 diagonals.
  EXPECT_EQ(middles.cols(), 33);
  EXPECT_TRUE(middles.row(2).isZero(0));
  EXPECT_EQ(HeldMiddles(0).cols(), 0);
  EXPECT_EQ(HeldMiddles(2).cols(), 0);
}

TEST_F(BoxToConvert, OneHeldEndHoldsNothing) {
  Hold(0, Coordinate(0) == 0 && Coordinate(1) == 0 && Coordinate(2) == 0);
  EXPECT_EQ(HeldMiddles(0).cols(), 0);
}

TEST_F(BoxToConvert, ALineOfHeldNodesOnTheSurfaceIsAKnifeEdge) {
  Hold(2, Coordinate(1) == 2 && Coordinate(2) == 0);
  const Eigen::MatrixXd middles = HeldMiddles(2);
  EXPECT_EQ(middles.cols(), 3);
  EXPECT_TRUE((middles.row(1).array() == 2).all());
}

TEST_F(BoxToConvert, AHeldVolumeHoldsTheEdgesOfItsInside) {
  Hold(0, Coordinate(2) <= 2);
  const Eigen::MatrixXd middles = HeldMiddles(0);
  const Mesh& mesh = scene_.mesh;
  // The edges from each inner node to its lower neighbours along the axes are
  // held.
  for (Eigen::Index a = 0; a < mesh.NumNodes(); ++a) {
    const auto inner = mesh.nodes.col(a).array();
    if ((inner == 0).any() || (inner == 3).any() || inner(2) > 2) {
      continue;
    }
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::Vector3d middle =
          inner.matrix() - Eigen::Vector3d::Unit(axis) / 2;
      EXPECT_EQ((middles.colwise() - middle).colwise().norm().minCoeff(), 0);
    }
  }
}

TEST_F(BoxToConvert, AHeldVolumeHoldsWhatCrossesItsCorners) {
  Hold(0, Coordinate(2) <= 2);
  const Scene quadratic = QuadraticScene(scene_);
  for (Eigen::Index node = 0; node < quadratic.mesh.NumNodes(); ++node) {
    if (quadratic.mesh.nodes(2, node) <= 2) {
      EXPECT_TRUE(quadratic.supports.held(0, node))
          << quadratic.mesh.nodes.col(node).transpose();
    }
  }
}

// The slab is one layer of elements that is held on both sides.  What is
// between the sides can bulge.
class SlabToConvert : public BoxToConvert {
 protected:
  SlabToConvert() : BoxToConvert({3, 3, 1}) {}
};

TEST_F(SlabToConvert, BetweenTwoSupportsIsFree) {
  Hold(0, Coordinate(2) == 0);
  Hold(0, Coordinate(2) == 1);
  const Eigen::MatrixXd middles = HeldMiddles(0);
  const Scene quadratic = QuadraticScene(scene_);
  for (Eigen::Index i = 0; i < middles.cols(); ++i) {
    const Eigen::Vector3d middle = middles.col(i);
    const bool in_a_face = middle(2) == 0 || middle(2) == 1;
    const bool on_the_rim = (middle.head<2>().array() == 0).any() ||
                            (middle.head<2>().array() == 3).any();
    EXPECT_TRUE(in_a_face || on_the_rim) << middle.transpose();
  }
  const int bottom = 1 + 4 * 1;
  const int between =
      NodeBetween(quadratic.mesh, bottom, bottom + 16);  // Straight above.
  ASSERT_GE(between, 0);
  EXPECT_FALSE(quadratic.supports.held(0, between));
}

// ---------------------------------------------------------------------------
// Where supports may end.

class OpenBoxToConvert : public BoxToConvert {
 protected:
  std::vector<HeldComponent> InDoubt() const {
    return QuadraticScene(scene_).supports.in_doubt;
  }
};

TEST_F(OpenBoxToConvert, AFaceUpToItsCreasesLeavesNothingOpen) {
  Hold(1, Coordinate(2) == 0);
  EXPECT_TRUE(InDoubt().empty());
}

TEST_F(OpenBoxToConvert, APartOfAFaceEndsSomewhereInIt) {
  Hold(1, Coordinate(2) == 0 && Coordinate(0) <= 1);
  const Scene quadratic = QuadraticScene(scene_);
  // Four edges along x and three diagonals cross the end, and their middles all
  // have the same x.
  EXPECT_EQ(quadratic.supports.in_doubt.size(), 7);
  for (const HeldComponent& open : quadratic.supports.in_doubt) {
    EXPECT_EQ(open.component, 1);
    EXPECT_FALSE(quadratic.supports.held(1, open.node));
    EXPECT_EQ(quadratic.mesh.nodes(0, open.node), 1.5);
    EXPECT_EQ(quadratic.mesh.nodes(2, open.node), 0);
  }
}

TEST_F(OpenBoxToConvert, APartOfTheVolumeMayBeHeldWhereItsSupportIs) {
  Hold(0, Coordinate(0) <= 1.2);
  scene_.supports.displacement.setConstant(0.5);
  const Scene quadratic = QuadraticScene(scene_);
  EXPECT_FALSE(quadratic.supports.in_doubt.empty());
  for (const HeldComponent& open : quadratic.supports.in_doubt) {
    EXPECT_FALSE(quadratic.supports.held(0, open.node));
    EXPECT_EQ(quadratic.mesh.nodes(0, open.node), 1.5);
    EXPECT_EQ(open.displacement, 0.5);
  }
}

TEST_F(OpenBoxToConvert, AHeldNodeOrLineIsNoPartOfAFace) {
  Hold(0, Coordinate(0) == 0 && Coordinate(1) == 0 && Coordinate(2) == 0);
  Hold(2, Coordinate(1) == 2 && Coordinate(2) == 0);
  EXPECT_TRUE(InDoubt().empty());
}

TEST_F(OpenBoxToConvert, ABoxDecidesAboutItsNodes) {
  Hold(1, Coordinate(2) == 0 && Coordinate(0) <= 1);
  scene_.supports.boxes = {
      {Eigen::Vector3d(-1, -1, -1), Eigen::Vector3d(1.2, 4, 0.1),
       Eigen::Array3<bool>(false, true, false), Eigen::Vector3d::Zero()}};
  EXPECT_TRUE(InDoubt().empty());
}

TEST_F(OpenBoxToConvert, APartOfTheMeshEndsWithItsNodes) {
  Hold(1, Coordinate(2) == 0 && Coordinate(0) <= 1);
  scene_.supports.delimited = scene_.supports.held;
  EXPECT_TRUE(InDoubt().empty());
}

// A clamp reaches from x = 0 to a place between two layers of nodes, which is
// nearer to the free layer.
TEST(QuadraticSupports, AreDecidedByBoxes) {
  Scene scene = SmallScene("cuboid");
  scene.mesh = BoxMesh({4, 2, 2}, {4, 2, 2});
  const Eigen::Index num_nodes = scene.mesh.NumNodes();
  const HeldBox box = {Eigen::Vector3d(-1, -1, -1), Eigen::Vector3d(1.7, 3, 3),
                       Eigen::Array3<bool>(true, false, true),
                       Eigen::Vector3d(0.1, 7, 0.2)};
  const auto inside = [&box](const Eigen::Vector3d& x) {
    return (x.array() >= box.lower.array()).all() &&
           (x.array() <= box.upper.array()).all();
  };
  scene.supports = {ComponentMask::Constant(3, num_nodes, false),
                    Eigen::MatrixXd::Zero(3, num_nodes),
                    {box}};
  for (Eigen::Index node = 0; node < num_nodes; ++node) {
    if (inside(scene.mesh.nodes.col(node))) {
      scene.supports.held.col(node) = box.components;
      scene.supports.displacement.col(node) = box.displacement;
    }
  }
  scene.load_cases.resize(1);
  scene.load_cases[0].loads = {BodyForce{Eigen::Vector3d(0, 0, -1)}};
  scene.load_cases[0].displacement.resize(0, 0);
  const Scene quadratic = QuadraticScene(scene);
  int num_between = 0;
  for (Eigen::Index node = 0; node < quadratic.mesh.NumNodes(); ++node) {
    const Eigen::Vector3d x = quadratic.mesh.nodes.col(node);
    EXPECT_EQ(quadratic.supports.held(0, node), inside(x));
    EXPECT_FALSE(quadratic.supports.held(1, node));
    EXPECT_EQ(quadratic.supports.held(2, node), inside(x));
    if (inside(x)) {
      EXPECT_EQ(quadratic.supports.displacement(0, node), 0.1);
      EXPECT_EQ(quadratic.supports.displacement(2, node), 0.2);
    }
    num_between += inside(x) && x(0) > 1 ? 1 : 0;
  }
  EXPECT_GT(num_between, 9);
}

// A block of 3 x 3 x 3 hexahedra is held on the first third of its bottom.  The
// middles of the next edges along x and of the faces between them are open.
TEST(QuadraticSupports, MayEndWithinFacesOfHexahedra) {
  Scene scene =
      testing::SceneOfKind({ElementKind::kHex8, SectionModel::kSolid});
  for (Eigen::Index node = 0; node < scene.mesh.NumNodes(); ++node) {
    scene.mesh.nodes.col(node) << double(node % 4), double(node / 4 % 4),
        double(node / 16);
    scene.supports.held.col(node).setConstant(scene.mesh.nodes(0, node) <= 1 &&
                                              scene.mesh.nodes(2, node) == 0);
  }
  scene.supports.displacement.setConstant(0.5);
  const Scene quadratic = QuadraticScene(scene);
  std::set<Eigen::Index> open;
  for (const HeldComponent& component : quadratic.supports.in_doubt) {
    open.insert(component.node);
    EXPECT_EQ(component.displacement, 0.5);
  }
  EXPECT_EQ(quadratic.supports.in_doubt.size(), 3 * open.size());
  EXPECT_EQ(open.size(), 4U + 3U);
  for (Eigen::Index node = 0; node < quadratic.mesh.NumNodes(); ++node) {
    const Eigen::Vector3d x = quadratic.mesh.nodes.col(node);
    EXPECT_EQ(open.count(node), x(0) == 1.5 && x(2) == 0 ? 1U : 0U);
    EXPECT_EQ(quadratic.supports.held(1, node), x(0) <= 1 && x(2) == 0);
  }
}

}  // namespace
}  // namespace elastimate
