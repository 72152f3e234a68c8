#include "elastimate/core/scene/loads.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "elastimate/core/mesh/mesh.h"
#include "tests/quadratic_reference.h"
#include "tests/scenes.h"

namespace elastimate {
namespace {

using testing::BoxMesh;
using testing::Distorted;
using testing::QuadraticField;
using testing::SmallScene;
using testing::WithMidEdgeNodes;

// Sums of some hundred numbers of size 1 to 10 have rounding errors far below
// this.
constexpr double kTolerance = 1e-12;

Eigen::Vector3d Moment(const Mesh& mesh, const Eigen::MatrixXd& force) {
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
  for (Eigen::Index node = 0; node < mesh.NumNodes(); ++node) {
    moment += Eigen::Vector3d(mesh.nodes.col(node))
                  .cross(Eigen::Vector3d(force.col(node)));
  }
  return moment;
}

// Returns the boundary facets all of whose nodes have this coordinate.
Eigen::MatrixXi FacetsAt(const Mesh& mesh, int axis, double coordinate) {
  const Eigen::MatrixXi facets = BoundaryFacets(mesh);
  std::vector<Eigen::Index> chosen;
  for (Eigen::Index i = 0; i < facets.cols(); ++i) {
    bool all = true;
    for (const int node : facets.col(i)) {
      all = all && mesh.nodes(axis, node) == coordinate;
    }
    if (all) {
      chosen.push_back(i);
    }
  }
  return facets(Eigen::all, chosen);
}

// The box is [0, 2] x [0, 3] x [0, 4]; some of its elements have a negative
// orientation.
class LoadedBox : public ::testing::Test {
 protected:
  LoadedBox() : mesh_(BoxMesh({2, 3, 2}, {2, 3, 4})) {
    mesh_.elements.row(1).head(30).swap(mesh_.elements.row(2).head(30));
  }

  Mesh mesh_;
};

TEST_F(LoadedBox, BodyForceIsVolumeTimesDensityAtTheCentroid) {
  const Eigen::Vector3d density(0.5, -1, 2);
  const Eigen::MatrixXd force = AssembleLoads(mesh_, {BodyForce{density}});
  const Eigen::Vector3d total = 24 * density;
  EXPECT_NEAR((force.rowwise().sum() - total).norm(), 0, kTolerance * 60);
  const Eigen::Vector3d moment = Eigen::Vector3d(1, 1.5, 2).cross(total);
  EXPECT_NEAR((Moment(mesh_, force) - moment).norm(), 0, kTolerance * 100);
}

TEST_F(LoadedBox, BodyForceOfOneTetrahedronIsAQuarterPerNode) {
  Mesh mesh;
  mesh.nodes.resize(3, 4);
  mesh.nodes << 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1;
  for (const Eigen::Vector4i& nodes :
       {Eigen::Vector4i(0, 1, 2, 3), Eigen::Vector4i(1, 0, 2, 3)}) {
    mesh.elements = nodes;
    const Eigen::MatrixXd force =
        AssembleLoads(mesh, {BodyForce{Eigen::Vector3d(0, 0, 24)}});
    EXPECT_TRUE(force.row(2).isConstant(1, kTolerance)) << force;
    EXPECT_TRUE(force.topRows(2).isZero(0)) << force;
  }
}

TEST_F(LoadedBox, TractionIsAreaTimesTractionAtTheMiddleOfTheFace) {
  const Eigen::Vector3d traction(0.5, -1, 2);
  const Eigen::MatrixXd force =
      AssembleLoads(mesh_, {Traction{FacetsAt(mesh_, 0, 2), traction}});
  const Eigen::Vector3d total = 12 * traction;
  EXPECT_NEAR((force.rowwise().sum() - total).norm(), 0, kTolerance * 30);
  const Eigen::Vector3d moment = Eigen::Vector3d(2, 1.5, 2).cross(total);
  EXPECT_NEAR((Moment(mesh_, force) - moment).norm(), 0, kTolerance * 100);
}

TEST_F(LoadedBox, LoadsThatCancelLeaveNothing) {
  const Eigen::MatrixXi facets = FacetsAt(mesh_, 0, 2);
  const Eigen::Vector3d traction(0.1, -0.7, 0.3);
  EXPECT_TRUE(AssembleLoads(mesh_, {Traction{facets, traction},
                                    Traction{facets, -traction / 3},
                                    Traction{facets, -traction * 2 / 3}})
                  .isZero(0));
}

TEST_F(LoadedBox, TractionDoesNotDependOnTheOrderOfFacetNodes) {
  Eigen::MatrixXi facets = FacetsAt(mesh_, 2, 4);
  const Eigen::MatrixXd force =
      AssembleLoads(mesh_, {Traction{facets, Eigen::Vector3d(1, 2, 3)}});
  facets.row(0).swap(facets.row(1));
  const Eigen::MatrixXd swapped =
      AssembleLoads(mesh_, {Traction{facets, Eigen::Vector3d(1, 2, 3)}});
  EXPECT_NEAR((force - swapped).norm(), 0, kTolerance * force.norm());
}

TEST_F(LoadedBox, PressureOnAFacePushesAgainstItsNormal) {
  const Eigen::Vector3d edges(2, 3, 4);
  for (int axis = 0; axis < 3; ++axis) {
    for (const bool far : {false, true}) {
      const Eigen::MatrixXi facets =
          FacetsAt(mesh_, axis, far ? edges(axis) : 0);
      const Eigen::MatrixXd force =
          AssembleLoads(mesh_, {Pressure{facets, 2.5}});
      const double area = 24 / edges(axis);
      const Eigen::Vector3d total =
          (far ? -1 : 1) * 2.5 * area * Eigen::Vector3d::Unit(axis);
      EXPECT_NEAR((force.rowwise().sum() - total).norm(), 0, kTolerance * 30);
    }
  }
}

// A closed surface has no vector area; the moment vanishes because the curl of
// a position does.
TEST_F(LoadedBox, PressureAllAroundHasNoResultant) {
  const Mesh mesh = Distorted(mesh_);
  const Eigen::MatrixXd force =
      AssembleLoads(mesh, {Pressure{BoundaryFacets(mesh), 3}});
  EXPECT_GT(force.norm(), 1);
  EXPECT_NEAR(force.rowwise().sum().norm(), 0, kTolerance * force.norm() * 10);
  EXPECT_NEAR(Moment(mesh, force).norm(), 0, kTolerance * force.norm() * 50);
}

// Linear elements represent u = G x + c exactly.  So the virtual work of the
// nodal forces is the integral over the face, A tau . u(middle).
TEST_F(LoadedBox, VirtualWorkOfATractionIsExactForLinearFields) {
  Eigen::Matrix3d gradient;
  gradient << 1, 2, 3, -4, 5, 6, 7, 8, -9;
  const Eigen::Vector3d shift(1, -2, 3);
  const Eigen::MatrixXd u = (gradient * mesh_.nodes).colwise() + shift;
  const Eigen::Vector3d traction(0.5, -1, 2);
  const Eigen::MatrixXd force =
      AssembleLoads(mesh_, {Traction{FacetsAt(mesh_, 2, 4), traction}});
  const double exact =
      6 * traction.dot(gradient * Eigen::Vector3d(1, 1.5, 4) + shift);
  EXPECT_NEAR(force.cwiseProduct(u).sum(), exact, kTolerance * 1000);
}

// A pressure p does the virtual work -p times the change of volume, which is
// tr(G) V for u = G x.
TEST_F(LoadedBox, VirtualWorkOfAPressureIsMinusPressureTimesVolumeChange) {
  Eigen::Matrix3d gradient;
  gradient << 1, 2, 3, -4, 5, 6, 7, 8, -9;
  const Eigen::MatrixXd u = gradient * mesh_.nodes;
  const Eigen::MatrixXd force =
      AssembleLoads(mesh_, {Pressure{BoundaryFacets(mesh_), 0.25}});
  EXPECT_NEAR(force.cwiseProduct(u).sum(), -0.25 * gradient.trace() * 24,
              kTolerance * 1000);
}

// The closed form on facets of any shape: a third of the force on each facet
// acts on each of its nodes.
TEST_F(LoadedBox, SurfaceForceIsSpreadByArea) {
  const Mesh mesh = Distorted(mesh_);
  const Eigen::MatrixXi facets = BoundaryFacets(mesh).leftCols(20);
  const Eigen::Vector3d total(0.5, -1, 2);
  Eigen::VectorXd area(facets.cols());
  for (Eigen::Index i = 0; i < facets.cols(); ++i) {
    const Eigen::Vector3d origin = mesh.nodes.col(facets(0, i));
    const Eigen::Vector3d e1 = mesh.nodes.col(facets(1, i)) - origin;
    const Eigen::Vector3d e2 = mesh.nodes.col(facets(2, i)) - origin;
    area(i) = e1.cross(e2).norm() / 2;
  }
  Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(3, mesh.NumNodes());
  for (Eigen::Index i = 0; i < facets.cols(); ++i) {
    for (const int node : facets.col(i)) {
      expected.col(node) += area(i) / area.sum() / 3 * total;
    }
  }
  const Eigen::MatrixXd force =
      AssembleLoads(mesh, {SurfaceForce{facets, total}});
  EXPECT_NEAR((force - expected).norm(), 0, kTolerance * total.norm());
  EXPECT_NEAR((force.rowwise().sum() - total).norm(), 0, kTolerance * 30);
}

TEST_F(LoadedBox, SurfaceForceActsAtTheMiddleOfTheFaceHoweverFineTheMesh) {
  const Eigen::Vector3d total(0.5, -1, 2);
  const Eigen::Vector3d moment = Eigen::Vector3d(1, 1.5, 4).cross(total);
  for (const int cells : {1, 2, 5}) {
    const Mesh linear = BoxMesh({cells, cells + 1, 2}, {2, 3, 4});
    for (const Mesh& mesh : {linear, WithMidEdgeNodes(linear)}) {
      const Eigen::MatrixXd force =
          AssembleLoads(mesh, {SurfaceForce{FacetsAt(mesh, 2, 4), total}});
      EXPECT_NEAR((force.rowwise().sum() - total).norm(), 0, kTolerance * 30);
      EXPECT_NEAR((Moment(mesh, force) - moment).norm(), 0, kTolerance * 100);
    }
  }
}

// The box [0, 2] x [0, 3] x [0, 4] has a face of area 12 at x = 2, and one of
// area 8 at y = 3.
TEST_F(LoadedBox, ResultantsFollowFromTheGeometry) {
  Eigen::MatrixXd nodal = Eigen::MatrixXd::Zero(3, mesh_.NumNodes());
  nodal.col(1) << 1, 2, 3;
  nodal.col(7) << 1, -2, 4;
  struct Expected {
    Load load;
    std::string type;
    Eigen::Vector3d force;
    std::optional<double> area;
  };
  for (const Mesh& mesh : {mesh_, WithMidEdgeNodes(mesh_)}) {
    Eigen::MatrixXd all = Eigen::MatrixXd::Zero(3, mesh.NumNodes());
    all.leftCols(nodal.cols()) = nodal;
    const Eigen::MatrixXi side = FacetsAt(mesh, 0, 2);
    const std::vector<Expected> cases = {
        {NodalForces{all}, "nodal_force", {2, 0, 7}, std::nullopt},
        {BodyForce{Eigen::Vector3d(0, 1, -10)},
         "body_force",
         {0, 24, -240},
         std::nullopt},
        {Traction{side, Eigen::Vector3d(1, 0, -3)},
         "traction",
         {12, 0, -36},
         12},
        {Pressure{FacetsAt(mesh, 1, 3), 5}, "pressure", {0, -40, 0}, 8},
        {Pressure{BoundaryFacets(mesh), 5}, "pressure", {0, 0, 0}, 52},
        {SurfaceForce{side, Eigen::Vector3d(0, 0, -3)},
         "force",
         {0, 0, -3},
         12}};
    for (const Expected& expected : cases) {
      SCOPED_TRACE(expected.type);
      const LoadResultant resultant = ResultantOf(mesh, expected.load);
      EXPECT_EQ(resultant.type, expected.type);
      EXPECT_NEAR((resultant.force - expected.force).norm(), 0,
                  kTolerance * 300);
      ASSERT_EQ(resultant.area.has_value(), expected.area.has_value());
      EXPECT_NEAR(resultant.area.value_or(0), expected.area.value_or(0),
                  kTolerance * 60);
      EXPECT_NEAR((AssembleLoads(mesh, {expected.load}).rowwise().sum() -
                   expected.force)
                      .norm(),
                  0, kTolerance * 300);
    }
  }
}

TEST_F(LoadedBox, LoadsAddUp) {
  const Eigen::MatrixXi facets = BoundaryFacets(mesh_);
  const std::vector<Load> loads = {
      NodalForces{Eigen::MatrixXd::Constant(3, mesh_.NumNodes(), 0.5)},
      BodyForce{Eigen::Vector3d(1, 2, 3)},
      Traction{facets, Eigen::Vector3d(-1, 0, 1)}, Pressure{facets, 2},
      SurfaceForce{facets, Eigen::Vector3d(3, 2, 1)}};
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(3, mesh_.NumNodes());
  for (const Load& load : loads) {
    sum += AssembleLoads(mesh_, {load});
  }
  const Eigen::MatrixXd force = AssembleLoads(mesh_, loads);
  EXPECT_NEAR((force - sum).norm(), 0, kTolerance * sum.norm());
}

TEST_F(LoadedBox, NodalForcesAreTakenAsTheyAre) {
  const NodalForces load{mesh_.nodes};
  EXPECT_EQ(AssembleLoads(mesh_, {load}), mesh_.nodes);
}

TEST_F(LoadedBox, WithoutLoadsThereIsNoForce) {
  const Eigen::MatrixXd force = AssembleLoads(mesh_, {});
  EXPECT_EQ(force.cols(), mesh_.NumNodes());
  EXPECT_TRUE(force.isZero(0));
}

// ---------------------------------------------------------------------------
// Quadratic tetrahedra.

// The box of LoadedBox, with quadratic elements.
class QuadraticLoadedBox : public LoadedBox {
 protected:
  QuadraticLoadedBox() : linear_(mesh_) { mesh_ = WithMidEdgeNodes(mesh_); }

  Mesh linear_;
};

TEST_F(QuadraticLoadedBox, BodyForceOfOneTetrahedron) {
  Mesh mesh;
  mesh.nodes.resize(3, 4);
  mesh.nodes << 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1;
  for (const Eigen::Vector4i& nodes :
       {Eigen::Vector4i(0, 1, 2, 3), Eigen::Vector4i(1, 0, 2, 3)}) {
    mesh.elements = nodes;
    const Eigen::MatrixXd force = AssembleLoads(
        WithMidEdgeNodes(mesh), {BodyForce{Eigen::Vector3d(0, 0, 120)}});
    EXPECT_TRUE(force.row(2).head<4>().isConstant(-1, kTolerance)) << force;
    EXPECT_TRUE(force.row(2).tail<6>().isConstant(4, kTolerance)) << force;
    EXPECT_TRUE(force.topRows(2).isZero(0)) << force;
  }
}

TEST_F(QuadraticLoadedBox, LoadsHaveTheResultantAndMomentOfLinearElements) {
  const Mesh linear = Distorted(linear_);
  const Mesh mesh = WithMidEdgeNodes(linear);
  const Eigen::MatrixXi facets = BoundaryFacets(mesh).leftCols(20);
  const Eigen::MatrixXi linear_facets = BoundaryFacets(linear).leftCols(20);
  const std::vector<std::pair<Load, Load>> loads = {
      {BodyForce{Eigen::Vector3d(1, 2, 3)},
       BodyForce{Eigen::Vector3d(1, 2, 3)}},
      {Traction{facets, Eigen::Vector3d(1, 2, 3)},
       Traction{linear_facets, Eigen::Vector3d(1, 2, 3)}},
      {Pressure{facets, 2}, Pressure{linear_facets, 2}},
      {SurfaceForce{facets, Eigen::Vector3d(1, 2, 3)},
       SurfaceForce{linear_facets, Eigen::Vector3d(1, 2, 3)}}};
  for (const auto& [load, linear_load] : loads) {
    const Eigen::MatrixXd force = AssembleLoads(mesh, {load});
    const Eigen::MatrixXd expected = AssembleLoads(linear, {linear_load});
    const double scale = expected.cwiseAbs().sum();
    EXPECT_NEAR((force.rowwise().sum() - expected.rowwise().sum()).norm(), 0,
                kTolerance * scale);
    EXPECT_NEAR((Moment(mesh, force) - Moment(linear, expected)).norm(), 0,
                kTolerance * scale * 10);
  }
}

// Integrals of x, y, z and of their products over [0, a] x [0, b] (x [0, c])
// are known.  The virtual work on quadratic fields must equal them exactly.
TEST_F(QuadraticLoadedBox, VirtualWorkIsExactForQuadraticFields) {
  const QuadraticField field;
  const Eigen::MatrixXd u = field.Displacements(mesh_.nodes);
  const Eigen::Vector3d load(0.5, -1, 2);
  // The mean of x x^T over a box with the middle m and the edges e is m m^T +
  // diag(e^2) / 12.
  const auto mean = [&](const Eigen::Vector3d& middle,
                        const Eigen::Vector3d& edges) {
    Eigen::Vector3d value = field.Displacement(middle);
    for (int i = 0; i < 3; ++i) {
      value(i) += field.curvature[i].diagonal().dot(edges.cwiseAbs2()) / 12 / 2;
    }
    return value;
  };
  const Eigen::MatrixXd body = AssembleLoads(mesh_, {BodyForce{load}});
  EXPECT_NEAR(body.cwiseProduct(u).sum(),
              24 * load.dot(mean({1, 1.5, 2}, {2, 3, 4})), kTolerance * 1000);
  const Eigen::MatrixXd traction =
      AssembleLoads(mesh_, {Traction{FacetsAt(mesh_, 2, 4), load}});
  EXPECT_NEAR(traction.cwiseProduct(u).sum(),
              6 * load.dot(mean({1, 1.5, 4}, {2, 3, 0})), kTolerance * 1000);
  const Eigen::MatrixXd pressure =
      AssembleLoads(mesh_, {Pressure{FacetsAt(mesh_, 0, 2), 2.5}});
  EXPECT_NEAR(pressure.cwiseProduct(u).sum(),
              -2.5 * 12 * mean({2, 1.5, 2}, {0, 3, 4})(0), kTolerance * 1000);
}

TEST_F(QuadraticLoadedBox, TractionActsAtTheMiddlesOfTheEdges) {
  const Eigen::MatrixXd force = AssembleLoads(
      mesh_, {Traction{FacetsAt(mesh_, 2, 4), Eigen::Vector3d(1, 2, 3)}});
  EXPECT_TRUE(force.leftCols(linear_.NumNodes()).isZero(0));
  // An edge inside of the face belongs to two facets of area 1/2.
  EXPECT_NEAR(force.row(0).maxCoeff(), 2 * 0.5 / 3, kTolerance);
}

TEST(AssembleLoadCases, HasOneColumnForEachLoadCase) {
  Scene scene = SmallScene("organ");
  scene.load_cases.resize(3);
  scene.load_cases[1].loads = {BodyForce{Eigen::Vector3d(0, 0, -1)},
                               BodyForce{Eigen::Vector3d(2, 0, 0)}};
  const Eigen::MatrixXd force = AssembleLoadCases(scene);
  ASSERT_EQ(force.rows(), 3 * scene.mesh.NumNodes());
  ASSERT_EQ(force.cols(), 3);
  for (Eigen::Index i = 0; i < 3; ++i) {
    const Eigen::MatrixXd expected =
        AssembleLoads(scene.mesh, scene.load_cases[i].loads);
    for (Eigen::Index node = 0; node < scene.mesh.NumNodes(); ++node) {
      for (int component = 0; component < 3; ++component) {
        EXPECT_EQ(force(3 * node + component, i), expected(component, node));
      }
    }
  }
}

}  // namespace
}  // namespace elastimate
