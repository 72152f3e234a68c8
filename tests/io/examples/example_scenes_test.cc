#include "elastimate/io/examples/example_scenes.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "elastimate/core/equilibrium/simulated_measurement.h"
#include "elastimate/core/mesh/mesh.h"
#include "elastimate/core/scene/loads.h"
#include "elastimate/core/scene/rigid_motion.h"
#include "elastimate/core/scene/scene.h"
#include "elastimate/organ/organ_shape.h"

namespace elastimate {
namespace {

constexpr double kDegree = 0.017453292519943295;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Six times the volume of each tetrahedron, with the sign of its orientation.
Eigen::VectorXd Determinants(const Mesh& mesh) {
  Eigen::VectorXd determinants(mesh.NumElements());
  for (Eigen::Index e = 0; e < mesh.NumElements(); ++e) {
    Eigen::Matrix3d edges;
    for (int i = 0; i < 3; ++i) {
      edges.col(i) = mesh.nodes.col(mesh.elements(i + 1, e)) -
                     mesh.nodes.col(mesh.elements(0, e));
    }
    determinants[e] = edges.determinant();
  }
  return determinants;
}

double Volume(const Mesh& mesh) {
  return Determinants(mesh).cwiseAbs().sum() / 6.0;
}

/// The outward normals times the areas of boundary facets.
Eigen::MatrixXd AreaVectors(const Mesh& mesh, const Eigen::MatrixXi& facets) {
  Eigen::MatrixXd areas(3, facets.cols());
  for (Eigen::Index f = 0; f < facets.cols(); ++f) {
    const Eigen::Vector3d first = mesh.nodes.col(facets(0, f));
    const Eigen::Vector3d edge1 = mesh.nodes.col(facets(1, f)) - first;
    const Eigen::Vector3d edge2 = mesh.nodes.col(facets(2, f)) - first;
    areas.col(f) = 0.5 * edge1.cross(edge2);
  }
  return areas;
}

using Edge = std::pair<int, int>;

/// The facets on either side of each edge of a surface.
std::map<Edge, std::vector<Eigen::Index>> FacetsOfEdges(
    const Eigen::MatrixXi& facets) {
  std::map<Edge, std::vector<Eigen::Index>> facets_of_edges;
  for (Eigen::Index f = 0; f < facets.cols(); ++f) {
    for (int i = 0; i < 3; ++i) {
      facets_of_edges[std::minmax<int>({facets(i, f), facets((i + 1) % 3, f)})]
          .push_back(f);
    }
  }
  return facets_of_edges;
}

std::set<int> NodesOf(const Eigen::MatrixXi& facets) {
  return {facets.data(), facets.data() + facets.size()};
}

/// The largest angle between the normals of two facets that share an edge.
double LargestCrease(const Mesh& mesh) {
  const Eigen::MatrixXi facets = BoundaryFacets(mesh);
  const Eigen::MatrixXd normals =
      AreaVectors(mesh, facets).colwise().normalized();
  double smallest_cosine = 1.0;
  for (const auto& [edge, sides] : FacetsOfEdges(facets)) {
    smallest_cosine =
        std::min(smallest_cosine,
                 normals.col(sides.at(0)).dot(normals.col(sides.at(1))));
  }
  return std::acos(smallest_cosine);
}

void ExpectLoadedWhereFree(const Scene& scene, const Eigen::Vector3d& force) {
  ASSERT_EQ(scene.load_cases.size(), 1U);
  const LoadCase& load_case = scene.load_cases[0];
  EXPECT_EQ(load_case.displacement.size(), 0);
  EXPECT_EQ(load_case.observed.size(), 0);
  EXPECT_FALSE(load_case.noise_sd.has_value());
  ASSERT_EQ(load_case.loads.size(), 1U);
  const Eigen::MatrixXd& forces =
      std::get<NodalForces>(load_case.loads[0]).force;
  ASSERT_EQ(forces.cols(), scene.mesh.NumNodes());
  for (Eigen::Index node = 0; node < forces.cols(); ++node) {
    const bool held = scene.supports.held(0, node);
    EXPECT_TRUE((scene.supports.held.col(node) == held).all());
    EXPECT_EQ(forces.col(node), held ? Eigen::Vector3d::Zero() : force);
  }
  EXPECT_TRUE(scene.supports.displacement.isZero(0.0));
}

/// The sentence of the std::invalid_argument that `make_scene` throws.
template <typename MakeScene>
std::string WhyInvalid(MakeScene make_scene) {
  try {
    make_scene();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "nothing was thrown";
}

TEST(CuboidSceneTest, IsOfHexahedraWhereAskedTo) {
  CuboidOptions options;
  options.kind = ElementKind::kHex8;
  const Scene scene = CuboidScene(options);
  ValidateScene(scene);
  EXPECT_EQ(scene.mesh.nodes, CuboidScene({}).mesh.nodes);
  EXPECT_EQ(scene.mesh.NumElements(), options.cells.prod());
  EXPECT_NEAR(ElementVolumes(scene.mesh).sum(), options.size.prod(), 1e-12);
  ExpectLoadedWhereFree(scene, options.force);
  EXPECT_EQ(BoundaryFacets(scene.mesh).cols(), 2 * (25 + 10 + 10));
}

TEST(RectangleSceneTest, IsHeldAtOneEndAndPulledAtTheOther) {
  for (const ElementKind kind : {ElementKind::kTri3, ElementKind::kQuad4}) {
    RectangleOptions options;
    options.kind = kind;
    options.cells = {3, 2};
    options.section = {SectionModel::kPlaneStrain, 0.5};
    options.force = {4, 2};
    const Scene scene = RectangleScene(options);
    ValidateScene(scene);
    EXPECT_EQ(scene.mesh.NumNodes(), 12);
    EXPECT_EQ(scene.mesh.NumElements(), kind == ElementKind::kTri3 ? 12 : 6);
    EXPECT_NEAR(ElementVolumes(scene.mesh).sum(), 0.5 * options.size.prod(),
                1e-12);
    EXPECT_EQ(BoundaryFacets(scene.mesh).cols(), 10);
    const Eigen::MatrixXd force =
        AssembleLoads(scene.mesh, scene.load_cases.at(0).loads);
    for (Eigen::Index node = 0; node < 12; ++node) {
      const double x = scene.mesh.nodes(0, node);
      EXPECT_EQ(scene.supports.held.col(node).all(), x == 0);
      EXPECT_EQ(scene.supports.held.col(node).any(), x == 0);
      const bool is_inner = node / 4 == 1;
      EXPECT_LT((force.col(node) - (x == options.size.x() ? 1.0 : 0.0) *
                                       (is_inner ? 0.5 : 0.25) *
                                       Eigen::Vector2d(4, 2))
                    .norm(),
                1e-12);
    }
  }
}

TEST(RectangleSceneTest, NamesTheOptionThatIsWrong) {
  const auto why = [](auto change) {
    return WhyInvalid([&] {
      RectangleOptions options;
      change(options);
      RectangleScene(options);
    });
  };
  EXPECT_EQ(why([](RectangleOptions& o) {
              o.cells = {0, 1};
            }),
            "cells=0,1; each must be at least 1");
  EXPECT_EQ(why([](RectangleOptions& o) {
              o.cells = {2000001, 1};
            }),
            "cells=2000001,1; the product must be at most 2000000");
  EXPECT_EQ(why([](RectangleOptions& o) { o.kind = ElementKind::kTri6; }),
            "elements=tri6; a rectangle is made of tri3 or quad4");
  EXPECT_EQ(
      why([](RectangleOptions& o) { o.section.model = SectionModel::kSolid; }),
      "model=3d; a rectangle is in plane_stress or plane_strain");
  EXPECT_EQ(why([](RectangleOptions& o) { o.section.thickness = 0; }),
            "thickness=0; it must be from 1e-50 to 1e+50");
}

// From a long and a wide plate to small and large holes.
struct PlateShape {
  Eigen::Vector2d size;
  double hole;
  int cells;
};

class PlateSceneShapes : public ::testing::TestWithParam<PlateShape> {
 protected:
  PlateSceneShapes() {
    options_.size = GetParam().size;
    options_.hole = GetParam().hole;
    options_.cells = GetParam().cells;
  }
  PlateOptions options_;
};

TEST_P(PlateSceneShapes, IsAValidQuarterWithAHole) {
  const double w = options_.size.x();
  const double h = options_.size.y();
  const int n = options_.cells;
  for (const ElementKind kind : {ElementKind::kQuad4, ElementKind::kTri3}) {
    options_.kind = kind;
    const Scene scene = PlateScene(options_);
    EXPECT_NO_THROW(ValidateScene(scene));
    EXPECT_EQ(WhyNotHeld(scene.mesh, scene.supports), "");
    EXPECT_EQ(BoundaryFacets(scene.mesh).cols(), 4 * n);
    Eigen::Index num_on_arc = 0;
    bool has_corner = false;
    for (const auto& node : scene.mesh.nodes.colwise()) {
      EXPECT_GE(node.norm(), options_.hole * (1 - 1e-14));
      num_on_arc += node.norm() < options_.hole * (1 + 1e-13) ? 1 : 0;
      has_corner = has_corner || node == options_.size;
      EXPECT_TRUE(node.x() >= 0 && node.x() <= w);
      EXPECT_TRUE(node.y() >= 0 && node.y() <= h);
    }
    EXPECT_EQ(num_on_arc, n + 1);
    EXPECT_TRUE(has_corner);
  }
}

INSTANTIATE_TEST_SUITE_P(Shapes, PlateSceneShapes,
                         ::testing::Values(PlateShape{{10, 10}, 2.5, 54},
                                           PlateShape{{10, 10}, 9.9, 20},
                                           PlateShape{{3, 1}, 1e-4, 9},
                                           PlateShape{{1, 5}, 0.5, 2},
                                           PlateShape{{100, 1}, 0.99, 30},
                                           PlateShape{{1, 100}, 0.2, 7}));

TEST(PlateSceneTest, DefaultHasAboutThreeThousandNodes) {
  const PlateOptions options;
  const Scene scene = PlateScene(options);
  EXPECT_EQ(scene.mesh.NumNodes(), 55 * 55);
  EXPECT_EQ(scene.mesh.section.thickness, 1);
}

TEST(PlateSceneTest, HasTheAreaOfItsShapeToTheOrderOfTheMesh) {
  PlateOptions options;
  options.size = {4, 3};
  options.hole = 2;
  options.section.thickness = 0.5;
  const double exact = 0.5 * (12 - 0.25 * 4 * 3.141592653589793);
  double error_before = 0;
  for (const int cells : {8, 16, 32, 64}) {
    options.cells = cells;
    const double error = ElementVolumes(PlateScene(options).mesh).sum() - exact;
    // Chords cut off parts of the hole: 1/6 of the square of their angles.
    const double angle = 1.5707963267948966 / cells;
    EXPECT_GT(error, 0);
    EXPECT_NEAR(error, 0.5 * 3.141592653589793 * angle * angle / 6,
                0.1 * error);
    if (error_before > 0) {
      EXPECT_NEAR(error_before / error, 4, 0.3);
    }
    error_before = error;
  }
}

TEST(PlateSceneTest, IsHeldBySymmetryAndPulledByItsForce) {
  PlateOptions options;
  options.cells = 10;
  options.force = -700;
  const Scene scene = PlateScene(options);
  const Eigen::MatrixXd force =
      AssembleLoads(scene.mesh, scene.load_cases.at(0).loads);
  EXPECT_NEAR(force.row(0).sum(), -700, 1e-10);
  EXPECT_EQ(force.row(1).cwiseAbs().maxCoeff(), 0);
  for (Eigen::Index node = 0; node < scene.mesh.NumNodes(); ++node) {
    const auto x = scene.mesh.nodes.col(node);
    EXPECT_EQ(scene.supports.held(0, node), x.x() == 0);
    EXPECT_EQ(scene.supports.held(1, node), x.y() == 0);
    EXPECT_EQ(force(0, node) != 0, x.x() == options.size.x());
  }
  EXPECT_TRUE(scene.supports.displacement.isZero(0));
}

TEST(PlateSceneTest, IsHeldByItsGrips) {
  PlateOptions options;
  options.cells = 10;
  options.ends = PlateEnds::kGrips;
  for (const double elongation : {0.01, -0.3}) {
    if (elongation < 0) {
      options.elongation = elongation;
    }
    const Scene scene = PlateScene(options);
    EXPECT_NO_THROW(ValidateScene(scene));
    EXPECT_TRUE(scene.load_cases.at(0).loads.empty());
    for (Eigen::Index node = 0; node < scene.mesh.NumNodes(); ++node) {
      const auto x = scene.mesh.nodes.col(node);
      const bool is_gripped = x.x() == options.size.x();
      EXPECT_EQ(scene.supports.held(0, node), is_gripped || x.x() == 0);
      EXPECT_EQ(scene.supports.held(1, node), is_gripped || x.y() == 0);
      EXPECT_EQ(scene.supports.displacement.col(node),
                Eigen::Vector2d(is_gripped ? elongation : 0.0, 0.0));
    }
  }
}

// Beside a small hole the stress is three times that far off [Kirsch 1898]; the
// plate of finite width has 3.008 [Heywood]. The stress is read off how far the
// last chord of the hole is stretched: there is none across it.
TEST(PlateSceneTest, HasTheStressConcentrationOfAHole) {
  PlateOptions options;
  options.hole = 0.5;
  for (const ElementKind kind : {ElementKind::kQuad4, ElementKind::kTri3}) {
    options.kind = kind;
    options.cells = 120;
    Scene scene = PlateScene(options);
    Measure({210000, 0.3}, scene);
    const Eigen::Index top = Eigen::Index{121} * 120;  // At (0, R).
    const Eigen::Index next = top - 121;
    const Eigen::Vector2d chord =
        scene.mesh.nodes.col(next) - scene.mesh.nodes.col(top);
    const Eigen::MatrixXd& u = scene.load_cases[0].displacement;
    const double strain =
        (u.col(next) - u.col(top)).dot(chord) / chord.squaredNorm();
    const double far_stress =
        options.force / (options.size.y() * options.section.thickness);
    EXPECT_NEAR(210000 * strain / far_stress, 3.008, 0.03);
  }
}

TEST(PlateSceneTest, NamesTheOptionThatIsWrong) {
  const auto why = [](auto change) {
    return WhyInvalid([&] {
      PlateOptions options;
      change(options);
      PlateScene(options);
    });
  };
  EXPECT_EQ(why([](PlateOptions& o) { o.cells = 1; }),
            "cells=1; it must be from 2 to 1414");
  EXPECT_EQ(why([](PlateOptions& o) { o.cells = 1415; }),
            "cells=1415; it must be from 2 to 1414");
  EXPECT_EQ(why([](PlateOptions& o) { o.hole = 10; }),
            "hole=10; a plate of size 10,10 takes a hole of radius 0.0001 to "
            "9.9");
  EXPECT_EQ(
      why([](PlateOptions& o) { o.hole = 0; }),
      "hole=0; a plate of size 10,10 takes a hole of radius 0.0001 to 9.9");
  EXPECT_EQ(why([](PlateOptions& o) { o.size.x() = 1001; }),
            "size=1001,10; the plate is too slender; its longer edge must be "
            "at most 100 times the shorter");
  EXPECT_EQ(why([](PlateOptions& o) { o.size.y() = -1; }),
            "size=10,-1; each must be from 1e-50 to 1e+50");
  EXPECT_EQ(why([](PlateOptions& o) { o.force = kInfinity; }),
            "force=inf; the largest must be from 1e-50 to 1e+50, or all zero");
  EXPECT_EQ(why([](PlateOptions& o) { o.elongation = 0; }),
            "elongation=0; its magnitude must be from 1e-50 to 1e+50");
  EXPECT_EQ(why([](PlateOptions& o) { o.kind = ElementKind::kTet4; }),
            "elements=tet4; a plate is made of tri3 or quad4");
  EXPECT_EQ(
      why([](PlateOptions& o) { o.section.model = SectionModel::kSolid; }),
      "model=3d; a plate is in plane_stress or plane_strain");
  EXPECT_EQ(why([](PlateOptions& o) { o.section.thickness = 0; }),
            "thickness=0; it must be from 1e-50 to 1e+50");
}

Scene MakeOrganOf(int tetrahedra) {
  OrganOptions options;
  options.tetrahedra = tetrahedra;
  return OrganScene(options);
}

// Large ones take seconds, and are made once for all tests.
const Scene& OrganOf(int tetrahedra) {
  static std::map<int, Scene> made;
  const auto found = made.find(tetrahedra);
  return found != made.end()
             ? found->second
             : made.emplace(tetrahedra, MakeOrganOf(tetrahedra)).first->second;
}

TEST(CuboidSceneTest, DefaultHasTheTetrahedraOfThePaper) {
  const Scene scene = CuboidScene(CuboidOptions());
  EXPECT_EQ(scene.mesh.NumElements(), 250);
  EXPECT_EQ(scene.mesh.NumNodes(), 6 * 6 * 3);
}

class CuboidSceneShapes : public ::testing::TestWithParam<std::array<int, 3>> {
 protected:
  CuboidSceneShapes() {
    options_.cells = Eigen::Vector3i::Map(GetParam().data());
    options_.size = {0.3, 0.7, 1.1};
    options_.force = {1.0, -2.0, 3.0};
    scene_ = CuboidScene(options_);
  }
  CuboidOptions options_;
  Scene scene_;
};

TEST_P(CuboidSceneShapes, HasFiveTetrahedraPerCell) {
  EXPECT_EQ(scene_.mesh.NumElements(), 5 * options_.cells.prod());
  EXPECT_EQ(scene_.mesh.NumNodes(), (options_.cells.array() + 1).prod());
}

TEST_P(CuboidSceneShapes, IsAValidAndHeldScene) {
  EXPECT_NO_THROW(ValidateScene(scene_));
  EXPECT_EQ(WhyNotHeld(scene_.mesh, scene_.supports), "");
}

TEST_P(CuboidSceneShapes, FillsTheCuboid) {
  EXPECT_EQ(scene_.mesh.nodes.rowwise().minCoeff(), Eigen::Vector3d::Zero());
  EXPECT_EQ(scene_.mesh.nodes.rowwise().maxCoeff(), options_.size);
  EXPECT_NEAR(Volume(scene_.mesh), options_.size.prod(), 1e-14);
  EXPECT_GT(Determinants(scene_.mesh).minCoeff(), 0.0);
}

TEST_P(CuboidSceneShapes, HasNoSurfaceInside) {
  // Faces of neighbouring cells that are cut along different diagonals would
  // count as surface.
  const Eigen::Vector3d size = options_.size;
  const double area = AreaVectors(scene_.mesh, BoundaryFacets(scene_.mesh))
                          .colwise()
                          .norm()
                          .sum();
  EXPECT_NEAR(area,
              2.0 * (size[0] * size[1] + size[1] * size[2] + size[2] * size[0]),
              1e-13);
}

TEST_P(CuboidSceneShapes, IsHeldAtTheBottomAndLoadedElsewhere) {
  for (Eigen::Index node = 0; node < scene_.mesh.NumNodes(); ++node) {
    EXPECT_EQ(scene_.supports.held(0, node), scene_.mesh.nodes(2, node) == 0.0);
  }
  ExpectLoadedWhereFree(scene_, options_.force);
}

TEST_P(CuboidSceneShapes, IsNumberedAlongXThenYThenZ) {
  const Eigen::MatrixXd& nodes = scene_.mesh.nodes;
  for (Eigen::Index node = 1; node < nodes.cols(); ++node) {
    const Eigen::Vector3d before = nodes.col(node - 1).reverse();
    const Eigen::Vector3d after = nodes.col(node).reverse();
    EXPECT_TRUE(std::lexicographical_compare(before.begin(), before.end(),
                                             after.begin(), after.end()));
  }
}

INSTANTIATE_TEST_SUITE_P(Cells, CuboidSceneShapes,
                         ::testing::Values(std::array<int, 3>{1, 1, 1},
                                           std::array<int, 3>{1, 2, 3},
                                           std::array<int, 3>{4, 1, 5},
                                           std::array<int, 3>{7, 6, 5}));

TEST(CuboidSceneTest, NamesTheOptionOutOfRange) {
  const auto why = [](auto change) {
    CuboidOptions options;
    change(options);
    return WhyInvalid([&] { CuboidScene(options); });
  };
  EXPECT_EQ(why([](CuboidOptions& o) { o.cells.y() = 0; }),
            "cells=5,0,2; each must be at least 1");
  EXPECT_EQ(why([](CuboidOptions& o) {
              o.cells = {755, 755, 755};
            }),
            "cells=755,755,755; the product must be at most 2000000");
  EXPECT_EQ(why([](CuboidOptions& o) { o.cells.setConstant(2147483647); }),
            "cells=2147483647,2147483647,2147483647; the product must be at "
            "most 2000000");
  EXPECT_EQ(why([](CuboidOptions& o) { o.size.z() = 0.0; }),
            "size=1,1,0; each must be from 1e-50 to 1e+50");
  EXPECT_EQ(why([](CuboidOptions& o) { o.size.x() = kInfinity; }),
            "size=inf,1,0.4; each must be from 1e-50 to 1e+50");
  EXPECT_EQ(why([](CuboidOptions& o) { o.size.x() = 1e-9; }),
            "size=1e-09,1,0.4; a cell of 2e-10,0.2,0.2 is too flat; its "
            "longest edge must be at most 100000 times its shortest");
  EXPECT_EQ(why([](CuboidOptions& o) { o.force.x() = kInfinity; }),
            "force=inf,0,-30; the largest must be from 1e-50 to 1e+50, or all "
            "zero");
}

TEST(CuboidSceneTest, IsValidAtTheEndsOfTheRanges) {
  for (const double length : {1e-50, 1.0, 1e45}) {
    CuboidOptions options;
    options.size = length * Eigen::Vector3d(1e5, 1, 1);
    options.cells = {1, 1, 1};
    EXPECT_NO_THROW(ValidateScene(CuboidScene(options))) << length;
  }
}

void HasTheWantedNumberOfTetrahedra(const Scene& scene, int wanted) {
  EXPECT_NEAR(scene.mesh.NumElements(), wanted, 0.05 * wanted);
}

void IsAValidAndHeldScene(const Scene& scene) {
  EXPECT_NO_THROW(ValidateScene(scene));
  EXPECT_EQ(WhyNotHeld(scene.mesh, scene.supports), "");
  ExpectLoadedWhereFree(scene, OrganOptions().force);
}

void HasOneClosedSurfaceOfGenusZero(const Scene& scene) {
  const Eigen::MatrixXi facets = BoundaryFacets(scene.mesh);
  const auto edges = FacetsOfEdges(facets);
  for (const auto& [edge, sides] : edges) {
    EXPECT_EQ(sides.size(), 2U);
  }
  // Each closed surface of genus g adds 2 - 2 g.
  const auto count = [](const auto& set) {
    return static_cast<Eigen::Index>(set.size());
  };
  EXPECT_EQ(count(NodesOf(facets)) - count(edges) + facets.cols(), 2);
}

void HasItsSurfaceNodesOnTheOrgansSurface(const Scene& scene) {
  const std::set<int> surface = NodesOf(BoundaryFacets(scene.mesh));
  for (int node = 0; node < scene.mesh.NumNodes(); ++node) {
    const double radius =
        BallPoint(scene.mesh.nodes.col(node) / OrganOptions().length).norm();
    if (surface.count(node) == 1) {
      EXPECT_NEAR(radius, 1.0, 1e-12);
    } else {
      EXPECT_LT(radius, 1.0);
    }
  }
  EXPECT_LT(static_cast<int>(surface.size()), scene.mesh.NumNodes());
}

void HasNoSlivers(const Scene& scene) {
  EXPECT_GE(SmallestDihedralAngles(scene.mesh).minCoeff(), 15.0 * kDegree);
}

void IsHeldOverATenthOfItsSurface(const Scene& scene) {
  const Eigen::MatrixXi facets = BoundaryFacets(scene.mesh);
  const Eigen::VectorXd areas =
      AreaVectors(scene.mesh, facets).colwise().norm();
  double held_area = 0.0;
  for (Eigen::Index f = 0; f < facets.cols(); ++f) {
    for (const int node : facets.col(f)) {
      held_area += scene.supports.held(0, node) ? areas[f] / 3.0 : 0.0;
    }
  }
  EXPECT_NEAR(held_area / areas.sum(), 0.12, 0.025);
}

class OrganSceneSizes : public ::testing::TestWithParam<int> {};

// In one test, since a program that meshes runs for each.
TEST_P(OrganSceneSizes, IsThatOfAnOrgan) {
  const Scene& scene = OrganOf(GetParam());
  {
    SCOPED_TRACE("HasTheWantedNumberOfTetrahedra");
    HasTheWantedNumberOfTetrahedra(scene, GetParam());
  }
  {
    SCOPED_TRACE("IsAValidAndHeldScene");
    IsAValidAndHeldScene(scene);
  }
  {
    SCOPED_TRACE("HasOneClosedSurfaceOfGenusZero");
    HasOneClosedSurfaceOfGenusZero(scene);
  }
  {
    SCOPED_TRACE("HasItsSurfaceNodesOnTheOrgansSurface");
    HasItsSurfaceNodesOnTheOrgansSurface(scene);
  }
  {
    SCOPED_TRACE("HasNoSlivers");
    HasNoSlivers(scene);
  }
  {
    SCOPED_TRACE("IsHeldOverATenthOfItsSurface");
    IsHeldOverATenthOfItsSurface(scene);
  }
}

INSTANTIATE_TEST_SUITE_P(Tetrahedra, OrganSceneSizes,
                         ::testing::Values(200, 500, OrganOptions().tetrahedra,
                                           5000, 50000));

TEST(OrganSceneTest, HasTheLengthAlongX) {
  OrganOptions options;
  options.length = 3.0;
  const Eigen::RowVectorXd x = OrganScene(options).mesh.nodes.row(0);
  EXPECT_NEAR(x.minCoeff(), -1.5, 1e-12);
  EXPECT_NEAR(x.maxCoeff(), 1.5, 1e-12);
}

TEST(OrganSceneTest, HasManyNodesInside) {
  const Mesh mesh = OrganScene(OrganOptions()).mesh;
  const std::set<int> surface = NodesOf(BoundaryFacets(mesh));
  EXPECT_GT(mesh.NumNodes() - static_cast<Eigen::Index>(surface.size()),
            mesh.NumNodes() / 5);
}

TEST(OrganSceneTest, IsTheSameOnEveryCall) {
  const Scene first = OrganScene(OrganOptions());
  MakeOrganOf(500);  // What was made before must not matter.
  const Scene second = OrganScene(OrganOptions());
  EXPECT_EQ(first.mesh.nodes, second.mesh.nodes);
  EXPECT_EQ(first.mesh.elements, second.mesh.elements);
  EXPECT_TRUE((first.supports.held == second.supports.held).all());
}

TEST(OrganSceneTest, GetsSmootherAsItIsRefined) {
  double crease_before = 1e9;
  for (const int tetrahedra : {500, 5000, 50000}) {
    const double crease = LargestCrease(OrganOf(tetrahedra).mesh);
    EXPECT_LT(crease, 0.75 * crease_before) << tetrahedra;
    crease_before = crease;
  }
  EXPECT_LT(crease_before, 50.0 * kDegree);
}

TEST(OrganSceneTest, ApproachesTheVolumeOfTheOrgan) {
  // The map's Jacobian determinant is 1/2 Height(a) Depth(a, c), whose integral
  // over the unit ball this is.
  constexpr double kVolume = 0.11403666;
  const double cubed_length = std::pow(OrganOptions().length, 3);
  EXPECT_NEAR(Volume(OrganOf(5000).mesh) / cubed_length, kVolume,
              0.02 * kVolume);
  EXPECT_NEAR(Volume(OrganOf(50000).mesh) / cubed_length, kVolume,
              0.005 * kVolume);
}

TEST(OrganSceneTest, NamesTheOptionOutOfRange) {
  const auto why = [](auto change) {
    OrganOptions options;
    change(options);
    return WhyInvalid([&] { OrganScene(options); });
  };
  EXPECT_EQ(why([](OrganOptions& o) { o.tetrahedra = 199; }),
            "tetrahedra=199; it must be from 200 to 2000000");
  EXPECT_EQ(why([](OrganOptions& o) { o.tetrahedra = 2000001; }),
            "tetrahedra=2000001; it must be from 200 to 2000000");
  EXPECT_EQ(why([](OrganOptions& o) { o.length = -0.2; }),
            "length=-0.2; it must be from 1e-50 to 1e+50");
  EXPECT_EQ(why([](OrganOptions& o) { o.length = 1e200; }),
            "length=1e+200; it must be from 1e-50 to 1e+50");
  EXPECT_EQ(why([](OrganOptions& o) { o.length = std::nan(""); }),
            "length=nan; it must be from 1e-50 to 1e+50");
  EXPECT_EQ(
      why([](OrganOptions& o) { o.force.y() = kInfinity; }),
      "force=0,inf,-0.02; the largest must be from 1e-50 to 1e+50, or all "
      "zero");
}

}  // namespace
}  // namespace elastimate
