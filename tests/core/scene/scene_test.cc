#include "elastimate/core/scene/scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "elastimate/core/mesh/facets.h"
#include "tests/quadratic_reference.h"
#include "tests/scenes.h"
#include "tests/throws.h"

namespace elastimate {
namespace {

using testing::BoxMesh;
using testing::kNan;
using testing::SmallScene;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// A valid scene: everything of which may then be broken once.
class ValidatedScene : public ::testing::Test {
 protected:
  ValidatedScene() : scene_(SmallScene("cuboid")) {
    const Eigen::MatrixXi facets = BoundaryFacets(scene_.mesh);
    LoadCase second;
    second.loads.emplace_back(BodyForce{Eigen::Vector3d(0, 0, -9.81)});
    second.loads.emplace_back(Traction{facets, Eigen::Vector3d(1, 0, 0)});
    second.loads.emplace_back(Pressure{facets, 2.0});
    second.loads.emplace_back(SurfaceForce{facets, Eigen::Vector3d(0, 0, -5)});
    second.displacement = Eigen::MatrixXd::Zero(3, NumNodes());
    second.observed = ComponentMask::Constant(3, NumNodes(), true);
    second.noise_sd = 1e-3;
    scene_.load_cases.push_back(second);
  }

  Eigen::Index NumNodes() const { return scene_.mesh.NumNodes(); }
  LoadCase& Second() { return scene_.load_cases[1]; }
  template <typename LoadType>
  LoadType& SecondLoad(int index) {
    return std::get<LoadType>(Second().loads[index]);
  }

  Scene scene_;
};

TEST_F(ValidatedScene, IsValid) { EXPECT_NO_THROW(ValidateScene(scene_)); }

TEST_F(ValidatedScene, MayHaveNoMeasurementAndNoMask) {
  Second().displacement.resize(3, 0);
  Second().observed.resize(3, 0);
  Second().noise_sd.reset();
  EXPECT_NO_THROW(ValidateScene(scene_));
}

TEST_F(ValidatedScene, MayBeFree) {
  scene_.supports.held.setConstant(false);
  EXPECT_NO_THROW(ValidateScene(scene_));
}

TEST_F(ValidatedScene, NeedsLargeStrainsForAPressureThatFollows) {
  Pressure pressure = {BoundaryFacets(scene_.mesh), 1};
  scene_.load_cases[0].loads = {pressure};
  EXPECT_NO_THROW(ValidateScene(scene_));
  pressure.follows = true;
  scene_.load_cases[0].loads = {pressure};
  EXPECT_THROWS_WITH(ValidateScene(scene_),
                     "load 1 of load case 1 follows .*laws of small strains; "
                     "give them a law of large strains");
  scene_.materials.resize(1);
  scene_.materials[0].law = "neo_hookean";
  EXPECT_NO_THROW(ValidateScene(scene_));
}

TEST_F(ValidatedScene, NeedsAValidMesh) {
  scene_.mesh.nodes(0, 3) = kNan;
  EXPECT_THROWS_WITH(ValidateScene(scene_), "node 3 .*not finite");
}

TEST_F(ValidatedScene, NeedsAFlagForEachComponent) {
  scene_.supports.held.resize(3, 5);
  EXPECT_THROWS_WITH(
      ValidateScene(scene_),
      "mask of held components has 5 columns for 48 nodes; give one for each");
}

TEST_F(ValidatedScene, NeedsASupportDisplacementForEachNode) {
  scene_.supports.displacement.resize(3, 47);
  EXPECT_THROWS_WITH(
      ValidateScene(scene_),
      "displacement of the supports has 47 columns for 48 nodes");
}

TEST_F(ValidatedScene, NeedsFiniteSupportDisplacements) {
  for (const double bad : {kNan, kInfinity, -kInfinity}) {
    scene_.supports.displacement(1, 2) = bad;
    EXPECT_THROWS_WITH(ValidateScene(scene_),
                       "displacement of the supports of node 2 is not finite");
  }
}

TEST_F(ValidatedScene, IgnoresSupportDisplacementsOfFreeComponents) {
  scene_.supports.held.col(7).setConstant(false);
  scene_.supports.displacement.col(7).setConstant(kNan);
  EXPECT_NO_THROW(ValidateScene(scene_));
}

TEST_F(ValidatedScene, NeedsAFreeDegreeOfFreedom) {
  scene_.supports.held.setConstant(true);
  EXPECT_THROWS_WITH(ValidateScene(scene_), "every degree of freedom is held");
  scene_.supports.held(1, 7) = false;
  EXPECT_NO_THROW(ValidateScene(scene_));
}

TEST_F(ValidatedScene, NeedsALoadCase) {
  scene_.load_cases.clear();
  EXPECT_THROWS_WITH(ValidateScene(scene_), "no load case");
}

TEST_F(ValidatedScene, NeedsANodalForceForEachNode) {
  Second().loads[1] = NodalForces{Eigen::MatrixXd::Zero(3, 49)};
  EXPECT_THROWS_WITH(
      ValidateScene(scene_),
      "the force in load 2 of load case 2 has 49 columns for 48 nodes");
}

TEST_F(ValidatedScene, NeedsFiniteNodalForces) {
  std::get<NodalForces>(scene_.load_cases[0].loads[0]).force(2, 11) = kInfinity;
  EXPECT_THROWS_WITH(
      ValidateScene(scene_),
      "the force in load 1 of load case 1 of node 11 is not finite");
}

TEST_F(ValidatedScene, NeedsAFiniteBodyForce) {
  SecondLoad<BodyForce>(0).force_density(2) = kNan;
  EXPECT_THROWS_WITH(ValidateScene(scene_),
                     "the body force in load 1 of load case 2 is not finite");
}

TEST_F(ValidatedScene, NeedsAFiniteTraction) {
  SecondLoad<Traction>(1).traction(0) = kNan;
  EXPECT_THROWS_WITH(ValidateScene(scene_),
                     "the traction in load 2 of load case 2 is not finite");
}

TEST_F(ValidatedScene, NeedsAFiniteForceOnASurface) {
  SecondLoad<SurfaceForce>(3).force(1) = kInfinity;
  EXPECT_THROWS_WITH(ValidateScene(scene_),
                     "the force on a surface in load 4 of load case 2 is not "
                     "finite");
  SecondLoad<SurfaceForce>(3).force(1) = 1e60;
  EXPECT_THROWS_WITH(ValidateScene(scene_),
                     "the force on a surface in load 4 of load case 2 has the "
                     "magnitude 1e\\+60");
}

TEST_F(ValidatedScene, NeedsFacetsThatAreFaces) {
  Eigen::MatrixXi& facets = SecondLoad<SurfaceForce>(3).facets;
  const Eigen::Vector3i face = facets.col(3);
  facets.col(3) << face(1), face(0), face(2);  // Whichever way around.
  EXPECT_NO_THROW(ValidateScene(scene_));
  // Some nodes are corners of opposite sides of the block, others the same.
  for (const auto& none : {Eigen::Vector3i(0, 1, scene_.mesh.NumNodes() - 1),
                           Eigen::Vector3i(face(0), face(0), face(1))}) {
    facets.col(3) = none;
    EXPECT_THROWS_WITH(ValidateScene(scene_),
                       "facet 3 of the force on a surface in load 4 of load "
                       "case 2 is not a face");
  }
}

TEST_F(ValidatedScene, NeedsAFacetUnderAForceOnASurface) {
  SecondLoad<SurfaceForce>(3).facets.resize(3, 0);
  EXPECT_THROWS_WITH(ValidateScene(scene_),
                     "the force on a surface in load 4 of load case 2 acts on "
                     "no facet");
}

TEST_F(ValidatedScene, NeedsAFinitePressure) {
  SecondLoad<Pressure>(2).pressure = -kInfinity;
  EXPECT_THROWS_WITH(ValidateScene(scene_),
                     "the pressure in load 3 of load case 2 is not finite");
}

TEST_F(ValidatedScene, NeedsFacets) {
  Second().loads[1] = Traction{Eigen::MatrixXi(3, 0), Eigen::Vector3d(1, 0, 0)};
  EXPECT_THROWS_WITH(ValidateScene(scene_),
                     "the traction in load 2 of load case 2 acts on no facet");
  Second().loads[1] = Pressure{Eigen::MatrixXi(), 1};
  EXPECT_THROWS_WITH(ValidateScene(scene_),
                     "the pressure in load 2 of load case 2 acts on no facet");
}

TEST_F(ValidatedScene, NeedsTriangles) {
  SecondLoad<Traction>(1).facets = Eigen::MatrixXi::Zero(4, 2);
  EXPECT_THROWS_WITH(ValidateScene(scene_), "traction .*4 nodes per facet");
  SecondLoad<Traction>(1).facets = BoundaryFacets(scene_.mesh);
  SecondLoad<Pressure>(2).facets = Eigen::MatrixXi::Zero(6, 2);
  EXPECT_THROWS_WITH(ValidateScene(scene_), "pressure .*6 nodes per facet");
}

TEST_F(ValidatedScene, NeedsQuadraticFacetsOnQuadraticTetrahedra) {
  const Mesh mesh = testing::WithMidEdgeNodes(scene_.mesh);
  Scene scene;
  scene.mesh = mesh;
  scene.supports.held = ComponentMask::Constant(3, mesh.NumNodes(), false);
  scene.supports.displacement = Eigen::MatrixXd::Zero(3, mesh.NumNodes());
  scene.load_cases.resize(1);
  Traction traction{BoundaryFacets(mesh), Eigen::Vector3d(1, 0, 0)};
  scene.load_cases[0].loads = {traction};
  EXPECT_NO_THROW(ValidateScene(scene));
  std::swap(traction.facets(3, 2), traction.facets(4, 2));
  scene.load_cases[0].loads = {traction};
  EXPECT_THROWS_WITH(
      ValidateScene(scene),
      "of facet 2 of the traction in load 1 of load case 1 is not in the "
      "middle");
  scene.load_cases[0].loads = {Pressure{BoundaryFacets(scene_.mesh), 1}};
  EXPECT_THROWS_WITH(ValidateScene(scene),
                     "3 nodes per facet; the facets of quadratic tetrahedra "
                     "have 6");
}

TEST_F(ValidatedScene, NeedsFacetNodesInRange) {
  for (const int bad : {-1, 48}) {
    Eigen::MatrixXi facets = BoundaryFacets(scene_.mesh);
    facets(1, 5) = bad;
    SecondLoad<Traction>(1).facets = facets;
    EXPECT_THROWS_WITH(ValidateScene(scene_),
                       "facet 5 of the traction .*outside 0..47");
    SecondLoad<Traction>(1).facets = BoundaryFacets(scene_.mesh);
    SecondLoad<Pressure>(2).facets = facets;
    EXPECT_THROWS_WITH(ValidateScene(scene_),
                       "facet 5 of the pressure .*outside 0..47");
    SecondLoad<Pressure>(2).facets = BoundaryFacets(scene_.mesh);
  }
}

TEST_F(ValidatedScene, NeedsAMeasurementOfEachNode) {
  Second().displacement.resize(3, 40);
  EXPECT_THROWS_WITH(
      ValidateScene(scene_),
      "measured displacement of load case 2 has 40 columns for 48 nodes");
}

TEST_F(ValidatedScene, NeedsAnObservationFlagForEachNode) {
  Second().observed.resize(3, 1);
  EXPECT_THROWS_WITH(ValidateScene(scene_),
                     "mask of observed components of load case 2 has 1 column");
}

TEST_F(ValidatedScene, NeedsFiniteDisplacementsWhereObserved) {
  for (const double bad : {kNan, kInfinity}) {
    Second().displacement(1, 40) = bad;
    EXPECT_THROWS_WITH(
        ValidateScene(scene_),
        "node 40 \\(y\\) in load case 2 is not finite; .*not observed");
  }
  Second().observed.resize(3, 0);
  EXPECT_THROWS_WITH(ValidateScene(scene_), "node 40 \\(y\\)");
}

TEST_F(ValidatedScene, IgnoresDisplacementsThatWereNotObserved) {
  Second().displacement(1, 40) = kNan;
  Second().observed(1, 40) = false;
  EXPECT_NO_THROW(ValidateScene(scene_));
}

TEST_F(ValidatedScene, NeedsAPositiveNoise) {
  Second().noise_sd = -2e-9;
  EXPECT_THROWS_WITH(ValidateScene(scene_), "is -2e-09; it must be positive");
  for (const double bad : {0.0, -1e-3, kNan, kInfinity}) {
    Second().noise_sd = bad;
    EXPECT_THROWS_WITH(ValidateScene(scene_),
                       "noise standard deviation of load case 2 is .*positive");
  }
}

// Beyond these, squares and products of three lengths leave the range of a
// double.
TEST_F(ValidatedScene, NeedsUnitsWhoseSquaresAreNumbers) {
  const Scene valid = scene_;
  for (const double unit : {1e-60, 1e60, 1e200}) {
    scene_.mesh.nodes = unit * valid.mesh.nodes;
    EXPECT_THROWS_WITH(ValidateScene(scene_),
                       "^the extent of the mesh has the magnitude .*e[+-].*; "
                       "choose units in which it is between 1e-50 and "
                       "1e\\+50$");
    scene_ = valid;
    Second().displacement(1, 40) = unit;
    EXPECT_THROWS_WITH(
        ValidateScene(scene_),
        "the measured displacement of load case 2 has the magnitude "
        ".*; choose units");
    Second().observed(1, 40) = false;
    EXPECT_NO_THROW(ValidateScene(scene_));
    scene_ = valid;
    scene_.supports.held(1, 2) = true;
    scene_.supports.displacement(1, 2) = -unit;
    EXPECT_THROWS_WITH(ValidateScene(scene_),
                       "the displacement of the supports has the magnitude");
    scene_ = valid;
    Second().loads[1] =
        NodalForces{Eigen::MatrixXd::Constant(3, NumNodes(), unit)};
    EXPECT_THROWS_WITH(ValidateScene(scene_),
                       "the force in load 2 of load case 2 has the magnitude");
    scene_ = valid;
    SecondLoad<BodyForce>(0).force_density(2) = unit;
    EXPECT_THROWS_WITH(
        ValidateScene(scene_),
        "the body force in load 1 of load case 2 has the magnitude");
    scene_ = valid;
    SecondLoad<Traction>(1).traction *= unit;
    EXPECT_THROWS_WITH(
        ValidateScene(scene_),
        "the traction in load 2 of load case 2 has the magnitude");
    scene_ = valid;
    SecondLoad<Pressure>(2).pressure = -unit;
    EXPECT_THROWS_WITH(
        ValidateScene(scene_),
        "the pressure in load 3 of load case 2 has the magnitude");
    scene_ = valid;
    Second().noise_sd = unit;
    EXPECT_THROWS_WITH(ValidateScene(scene_),
                       "the noise standard deviation of load case 2 has");
    scene_ = valid;
  }
}

}  // namespace
}  // namespace elastimate
