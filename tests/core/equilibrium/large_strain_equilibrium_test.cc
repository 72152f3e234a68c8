// Tests of equilibrium at large strains against published values and closed
// forms.

#include "elastimate/core/equilibrium/large_strain_equilibrium.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <string>
#include <variant>
#include <vector>

#include "elastimate/core/equilibrium/equilibrium.h"
#include "elastimate/core/mechanics/follower_pressure.h"
#include "elastimate/core/mesh/facets.h"
#include "elastimate/core/scene/loads.h"
#include "elastimate/core/scene/quadratic_scene.h"
#include "elastimate/core/scene/scene_builder.h"
#include "tests/element_kinds.h"
#include "tests/scenes.h"

namespace elastimate {
namespace {

using ::testing::HasSubstr;
using testing::HoldPlane;

// A grid of cells over the unit square or cube, moved by a map.
Mesh GridMesh(
    const Eigen::VectorXi& cells,
    const std::function<Eigen::VectorXd(const Eigen::VectorXd&)>& map) {
  const Eigen::Index d = cells.size();
  Mesh mesh;
  mesh.kind = d == 2 ? ElementKind::kQuad4 : ElementKind::kHex8;
  mesh.section.model =
      d == 2 ? SectionModel::kPlaneStrain : SectionModel::kSolid;
  const int nx = cells(0) + 1;
  const int ny = cells(1) + 1;
  const int nz = d == 3 ? cells(2) + 1 : 1;
  mesh.nodes.resize(d, Eigen::Index(nx) * ny * nz);
  for (Eigen::Index node = 0; node < mesh.NumNodes(); ++node) {
    const Eigen::Vector3d at(double(node % nx) / (nx - 1),
                             double(node / nx % ny) / (ny - 1),
                             nz == 1 ? 0 : double(node / (nx * ny)) / (nz - 1));
    mesh.nodes.col(node) = map(at.head(d));
  }
  mesh.elements.resize(d == 2 ? 4 : 8, cells.prod());
  for (Eigen::Index e = 0; e < mesh.NumElements(); ++e) {
    const int i = int(e) % cells(0);
    const int j = int(e) / cells(0) % cells(1);
    const int k = int(e) / (cells(0) * cells(1));
    const int first = i + nx * (j + ny * k);
    for (int corner = 0; corner < mesh.elements.rows(); ++corner) {
      const int layer = corner / 4;
      const int in_layer = corner % 4;
      mesh.elements(corner, e) = first + (in_layer == 1 || in_layer == 2) +
                                 nx * (in_layer / 2) + nx * ny * layer;
    }
  }
  return mesh;
}

Mesh BoxGrid(const Eigen::VectorXi& cells, const Eigen::VectorXd& size) {
  return GridMesh(cells, [&](const Eigen::VectorXd& at) {
    return Eigen::VectorXd(at.cwiseProduct(size));
  });
}

Scene SceneOf(const Mesh& mesh, const std::string& law) {
  Scene scene = UnsupportedScene(mesh);
  scene.materials.resize(1);
  scene.materials[0].law = law;
  scene.load_cases.resize(1);
  return scene;
}

LargeStrainState SolveOf(const Scene& scene, const Eigen::VectorXd& parameters,
                         Dilatation dilatation = Dilatation::kMeanOfElement) {
  LargeStrainEquilibrium model(scene, dilatation);
  return model.Solve(model.Forces().Parameters().Moduli(parameters), 0);
}

// Cook's membrane in plane strain: 48 mm long, 44 and 16 mm high, 1 mm thick,
// sheared by 1 N.
Scene CooksMembrane(int cells) {
  const Mesh mesh =
      GridMesh(Eigen::Vector2i(cells, cells), [](const Eigen::VectorXd& at) {
        const double low = 44 * at(0);
        const double high = 44 + 16 * at(0);
        return Eigen::VectorXd(
            Eigen::Vector2d(48 * at(0), low + (high - low) * at(1)));
      });
  Scene scene = SceneOf(mesh, "mooney_rivlin");
  HoldInBox(Eigen::Vector2d(0, 0), Eigen::Vector2d(0, 44), scene);
  scene.load_cases[0].loads = {TractionInBox(mesh, Eigen::Vector2d(48, 44),
                                             Eigen::Vector2d(48, 60),
                                             Eigen::Vector2d(0, 1.0 / 16))};
  return scene;
}

// Returns u_y of the node at this place.
double RiseAt(const Eigen::Vector2d& place, const Mesh& mesh,
              const Eigen::VectorXd& displacement) {
  Eigen::Index node = 0;
  const double distance =
      (mesh.nodes.colwise() - place).colwise().squaredNorm().minCoeff(&node);
  EXPECT_LT(distance, 1e-18);
  return displacement(2 * node + 1);
}

// The membrane of mu = 422.5 kPa and nu = 0.3 by bilinear elements, and by
// biquadratic ones [deal.II code gallery, quasi-static finite-strain
// compressible elasticity].  The law there has another energy of the volume,
// which makes a difference of a thousandth.
TEST(LargeStrainEquilibrium, BendsCooksMembraneAsPublished) {
  const double mu = 0.4225;
  const double nu = 0.3;
  const Eigen::Vector3d parameters(mu / 2, 0,
                                   2 * mu * (1 + nu) / (3 * (1 - 2 * nu)));
  const auto expect = [&](const Scene& scene, double published) {
    const LargeStrainState state =
        SolveOf(scene, parameters, Dilatation::kOfPoints);
    ASSERT_EQ(state.status, EquilibriumStatus::kDone);
    EXPECT_LE(state.num_tangents, 25);
    const double tip =
        RiseAt(Eigen::Vector2d(48, 52), scene.mesh, state.displacement);
    EXPECT_NEAR(tip / published, 1, 2e-3);
  };
  for (const auto& [cells, published] :
       {std::pair(2, 8.638), std::pair(4, 12.07), std::pair(8, 13.86),
        std::pair(16, 14.49), std::pair(32, 14.67)}) {
    expect(CooksMembrane(cells), published);
  }
  for (const auto& [cells, published] :
       {std::pair(2, 14.30), std::pair(4, 14.65), std::pair(8, 14.71),
        std::pair(16, 14.73)}) {
    expect(QuadraticScene(CooksMembrane(cells)), published);
  }
}

// The membrane at small strains, of E = 70 MPa and nu = 1/3 under a traction of
// 6.25 MPa: CalculiX, Code_Aster and Elmer find between 32.20 and 32.28 mm by
// quadratic elements on fine meshes [CoFEA, Cook's membrane].
TEST(CooksMembraneOfSmallStrains, RisesAsPublished) {
  Scene scene = CooksMembrane(40);
  scene.materials.clear();
  scene.load_cases[0].loads = {Scaled(scene.load_cases[0].loads[0], 100.0)};
  const Scene quadratic = QuadraticScene(scene);
  const Eigen::MatrixXd displacement =
      DisplacementsAt(quadratic, Eigen::Vector2d(70, 1.0 / 3));
  const double corner =
      RiseAt(Eigen::Vector2d(48, 60), quadratic.mesh, displacement.col(0));
  EXPECT_GT(corner, 32.20);
  EXPECT_LT(corner, 32.28);
}

// Two blocks in a row, each of them a cube of 1 with E = 1000 and nu = 0.3,
// with four springs of the force exp(50 x) - 1 between them.  The blocks are
// clamped at their outer ends, which are pulled apart by 1 in all.  FEBio's
// force is 377.7 [febiosoftware/TestSuite, Verify/oi05.feb, op05.feb].
TEST(LargeStrainEquilibrium, PullsTheBlocksOfFebioAsPublished) {
  const double published = 377.7;
  const Mesh mesh = BoxGrid(Eigen::Vector3i(1, 1, 1), Eigen::Vector3d::Ones());
  Scene scene = SceneOf(mesh, "neo_hookean");
  HoldInBox(Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(0, 1, 1), scene);
  Eigen::MatrixXd forces = Eigen::MatrixXd::Zero(3, 8);
  for (int node = 0; node < 8; ++node) {
    forces(0, node) = mesh.nodes(0, node) * published / 4;
  }
  scene.load_cases[0].loads = {NodalForces{forces}};
  const LargeStrainState state =
      SolveOf(scene, Eigen::Vector2d(1000, 0.3), Dilatation::kOfPoints);
  ASSERT_EQ(state.status, EquilibriumStatus::kDone);
  const double of_block = state.displacement.reshaped(3, 8).row(0).maxCoeff();
  const double of_springs = std::log1p(published / 4) / 50;
  // The published force has four digits.
  EXPECT_NEAR(2 * of_block + of_springs, 1, 2e-4);
}

// Cook's membrane of a bulk modulus of 10^4 shear moduli.  Bilinear elements of
// a constant dilatation converge from below; biquadratic ones of a linear
// dilatation are as good on a mesh that is eight times as coarse, and without
// it they lock.
TEST(LargeStrainEquilibrium, DoesNotLockWithQuadraticElements) {
  const double mu = 0.4225;
  const Eigen::Vector3d parameters(mu / 2, 0, 1e4 * mu);
  const auto corner = [&](int cells, int order, Dilatation dilatation) {
    const Scene linear = CooksMembrane(cells);
    const Scene scene = order == 2 ? QuadraticScene(linear) : linear;
    const LargeStrainState state = SolveOf(scene, parameters, dilatation);
    EXPECT_EQ(state.status, EquilibriumStatus::kDone);
    return state.displacement(2 * (linear.mesh.NumNodes() - 1) + 1);
  };
  const double fine = corner(16, 1, Dilatation::kMeanOfElement);
  EXPECT_NEAR(corner(2, 2, Dilatation::kMeanOfElement) / fine, 1, 0.02);
  // Rounding of the large bulk modulus is most of the residual here.
  EXPECT_NEAR(corner(8, 2, Dilatation::kMeanOfElement) / fine, 1, 0.02);
  EXPECT_LT(corner(2, 2, Dilatation::kOfPoints) / fine, 0.75);
}

// A cube that is stretched to twice its length, with lambda / mu = 10^4.
TEST(LargeStrainEquilibrium, KeepsTheVolumeOfANearlyIncompressibleCube) {
  const double lambda = 1e4;
  const Eigen::Vector2d parameters((3 * lambda + 2) / (lambda + 1),
                                   lambda / (2 * (lambda + 1)));
  const Mesh mesh = BoxGrid(Eigen::Vector3i(2, 2, 2), Eigen::Vector3d::Ones());
  Scene scene = SceneOf(mesh, "neo_hookean");
  for (int axis = 0; axis < 3; ++axis) {
    HoldPlane(axis, 0, 0, scene);
  }
  HoldPlane(2, 1, 1, scene);
  const LargeStrainState state = SolveOf(scene, parameters);
  ASSERT_EQ(state.status, EquilibriumStatus::kDone);
  const Eigen::Vector3d corner =
      mesh.nodes.rightCols(1) + state.displacement.tail(3);
  const double volume = corner.prod();
  EXPECT_NEAR(corner(2), 2, 1e-12);
  EXPECT_NEAR(volume, 1, 1e-4);
  // sigma = mu B / J + p.
  EXPECT_NEAR((lambda * std::log(volume) - 1) / volume, -0.5, 1e-8);
}

// An eighth of a thick sphere, 1 < r < 2, by three patches of hexahedra.
Mesh SphereMesh(int cells, int layers) {
  Mesh mesh;
  std::map<std::array<long, 3>, int> found;
  std::vector<Eigen::Vector3d> nodes;
  std::vector<std::array<int, 8>> elements;
  const auto node_at = [&](int face, int i, int j, int layer) {
    const double quarter = std::acos(0.0) / 2;
    Eigen::Vector3d direction;
    direction(face) = 1;
    direction((face + 1) % 3) = std::tan(quarter * i / cells);
    direction((face + 2) % 3) = std::tan(quarter * j / cells);
    const Eigen::Vector3d x =
        direction.normalized() * std::pow(2.0, double(layer) / layers);
    const std::array<long, 3> key = {std::lround(1e6 * x(0)),
                                     std::lround(1e6 * x(1)),
                                     std::lround(1e6 * x(2))};
    const auto [at, is_new] = found.emplace(key, int(nodes.size()));
    if (is_new) {
      nodes.push_back(x);
    }
    return at->second;
  };
  for (int face = 0; face < 3; ++face) {
    for (int j = 0; j < cells; ++j) {
      for (int i = 0; i < cells; ++i) {
        for (int layer = 0; layer < layers; ++layer) {
          elements.push_back(
              {node_at(face, i, j, layer), node_at(face, i + 1, j, layer),
               node_at(face, i + 1, j + 1, layer),
               node_at(face, i, j + 1, layer), node_at(face, i, j, layer + 1),
               node_at(face, i + 1, j, layer + 1),
               node_at(face, i + 1, j + 1, layer + 1),
               node_at(face, i, j + 1, layer + 1)});
        }
      }
    }
  }
  mesh.kind = ElementKind::kHex8;
  mesh.nodes.resize(3, Eigen::Index(nodes.size()));
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    mesh.nodes.col(Eigen::Index(i)) = nodes[i];
  }
  mesh.elements.resize(8, Eigen::Index(elements.size()));
  for (std::size_t e = 0; e < elements.size(); ++e) {
    for (int i = 0; i < 8; ++i) {
      mesh.elements(i, Eigen::Index(e)) = elements[e][i];
    }
  }
  return mesh;
}

// The pressure in a thick sphere of incompressible neo-Hookean material whose
// inner radius grows by la: P / mu = (4 / lb + 1 / lb^4 - 4 / la - 1 / la^4) /
// 2 with lb^3 = 1 + (la^3 - 1) / 8.
TEST(LargeStrainEquilibrium, InflatesASphereAsTheClosedForm) {
  const double lambda = 1e4;
  const Eigen::Vector2d parameters((3 * lambda + 2) / (lambda + 1),
                                   lambda / (2 * (lambda + 1)));
  const Mesh mesh = SphereMesh(4, 6);
  for (const auto& [stretch, published] :
       {std::pair(1.2, 0.480160), std::pair(1.5, 0.755433),
        std::pair(2.0, 0.806927)}) {
    Scene scene = SceneOf(mesh, "neo_hookean");
    for (Eigen::Index node = 0; node < mesh.NumNodes(); ++node) {
      const Eigen::Vector3d x = mesh.nodes.col(node);
      const bool is_inner = x.norm() < 1 + 1e-9;
      for (int i = 0; i < 3; ++i) {
        scene.supports.held(i, node) = is_inner || std::abs(x(i)) < 1e-9;
        scene.supports.displacement(i, node) =
            is_inner ? (stretch - 1) * x(i) : 0;
      }
    }
    LargeStrainEquilibrium model(scene);
    const Eigen::VectorXd moduli =
        model.Forces().Parameters().Moduli(parameters);
    const LargeStrainState state = model.Solve(moduli, 0);
    ASSERT_EQ(state.status, EquilibriumStatus::kDone) << stretch;
    const Eigen::VectorXd forces =
        model.Forces().Forces(moduli, state.displacement);
    // The work of the pressure where the inner surface grows by 1.
    double work = 0;
    for (Eigen::Index node = 0; node < mesh.NumNodes(); ++node) {
      const Eigen::Vector3d x = mesh.nodes.col(node);
      if (x.norm() < 1 + 1e-9) {
        work += forces.segment<3>(3 * node).dot(x.normalized());
      }
    }
    const double area = 2 * std::acos(0.0) / 2 * stretch * stretch;
    // The error decreases with the square of the size of the elements.
    EXPECT_NEAR(work / area / published, 1, 0.03) << stretch;
  }
}

// The volume within the inner surface of an eighth of a sphere over that at
// rest, for facets whose area vectors point inwards.
double InnerGrowth(const Mesh& mesh, const Eigen::MatrixXi& facets,
                   const Eigen::VectorXd& u) {
  // A pressure of 1 on each x does the work 3 V.
  const FollowerPressure pressure(mesh, {Pressure{facets, 1, true}});
  const auto volume = [&](const Eigen::VectorXd& at) {
    return pressure.Forces(at).dot(mesh.nodes.reshaped() + at);
  };
  return volume(u) / volume(Eigen::VectorXd::Zero(u.size()));
}

// The pressure of the closed form at an inner stretch.
double PressureOfSphere(double la) {
  const double lb = std::cbrt(1 + (la * la * la - 1) / 8);
  return (4 / lb + std::pow(lb, -4) - 4 / la - std::pow(la, -4)) / 2;
}

// The sphere of the test above, inflated by a pressure on the deformed surface.
// The pressure at the stretch 2 is beyond its maximum, which is at 1.83, so
// that the stable state at that pressure has another stretch of the closed
// form.
TEST(LargeStrainEquilibrium, InflatesASphereByPressureThatFollows) {
  const double lambda = 1e3;
  const Eigen::Vector2d parameters((3 * lambda + 2) / (lambda + 1),
                                   lambda / (2 * (lambda + 1)));
  Scene linear = SceneOf(SphereMesh(2, 2), "neo_hookean");
  for (int axis = 0; axis < 3; ++axis) {
    HoldPlane(axis, 0, 0, linear);
  }
  const Eigen::MatrixXi facets = BoundaryFacetsWhere(
      linear.mesh,
      [&](int node) { return linear.mesh.nodes.col(node).norm() < 1 + 1e-9; });
  for (const auto& [stretch, published] :
       {std::pair(1.2, 0.480160), std::pair(1.5, 0.755433),
        std::pair(1.682, 0.806927)}) {
    linear.load_cases[0].loads = {Pressure{facets, published, true}};
    const Scene scene = QuadraticScene(linear);
    LargeStrainEquilibrium model(scene);
    const LargeStrainState state =
        model.Solve(model.Forces().Parameters().Moduli(parameters), 0);
    ASSERT_EQ(state.status, EquilibriumStatus::kDone) << stretch;
    const auto& inner = std::get<Pressure>(scene.load_cases[0].loads[0]);
    const double reached =
        std::cbrt(InnerGrowth(scene.mesh, inner.facets, state.displacement));
    EXPECT_NEAR(published / PressureOfSphere(reached), 1, 1e-3);
    EXPECT_NEAR(reached, stretch, 2e-3);
  }
  double largest = 0;
  for (double la = 1.5; la < 2.5; la += 0.01) {
    largest = std::max(largest, PressureOfSphere(la));
  }
  linear.load_cases[0].loads = {Pressure{facets, 1.0, true}};
  const Scene scene = QuadraticScene(linear);
  LargeStrainEquilibrium model(scene);
  const LargeStrainState state =
      model.Solve(model.Forces().Parameters().Moduli(parameters), 0);
  EXPECT_NE(state.status, EquilibriumStatus::kDone);
  EXPECT_NEAR(state.load_share, largest, 3e-3);
}

// A cylinder of incompressible neo-Hookean material, twisted by t a length,
// bears the moment pi mu t R^4 / 2, and pushes its ends apart by
// pi mu t^2 R^4 / 4 [Rivlin, Phil. Trans. R. Soc. A 242 (1949) 173].
TEST(LargeStrainEquilibrium, TwistsACylinderAsTheClosedForm) {
  const double lambda = 1e4;
  const double twist = 0.6;
  const double length = 0.25;
  const Eigen::Vector2d parameters((3 * lambda + 2) / (lambda + 1),
                                   lambda / (2 * (lambda + 1)));
  const Mesh mesh =
      GridMesh(Eigen::Vector3i(8, 8, 6), [&](const Eigen::VectorXd& at) {
        // A square becomes a disk.
        const double u = 2 * at(0) - 1;
        const double v = 2 * at(1) - 1;
        return Eigen::VectorXd(Eigen::Vector3d(u * std::sqrt(1 - v * v / 2),
                                               v * std::sqrt(1 - u * u / 2),
                                               length * at(2)));
      });
  Scene scene = SceneOf(mesh, "neo_hookean");
  for (Eigen::Index node = 0; node < mesh.NumNodes(); ++node) {
    const Eigen::Vector3d x = mesh.nodes.col(node);
    if (x(2) < 1e-9 || x(2) > length - 1e-9) {
      scene.supports.held.col(node).setConstant(true);
      scene.supports.displacement.col(node) =
          Eigen::AngleAxisd(twist * x(2), Eigen::Vector3d::UnitZ()) * x - x;
    }
  }
  LargeStrainEquilibrium model(scene);
  const Eigen::VectorXd moduli = model.Forces().Parameters().Moduli(parameters);
  const LargeStrainState state = model.Solve(moduli, 0);
  ASSERT_EQ(state.status, EquilibriumStatus::kDone);
  const Eigen::VectorXd forces =
      model.Forces().Forces(moduli, state.displacement);
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
  double push = 0;
  for (Eigen::Index node = 0; node < mesh.NumNodes(); ++node) {
    const Eigen::Vector3d x = mesh.nodes.col(node);
    if (x(2) > length - 1e-9) {
      const Eigen::Vector3d force = forces.segment<3>(3 * node);
      moment += (x + state.displacement.segment<3>(3 * node)).cross(force);
      push -= force(2);
    }
  }
  const double pi = 2 * std::acos(0.0);
  // A polygon of 32 sides has a polar moment that is 1.3 % smaller.
  EXPECT_NEAR(moment(2) / (pi * twist / 2), 1, 0.02);
  EXPECT_NEAR(push / (pi * twist * twist / 4), 1, 0.02);
}

// A column of slenderness 20 that is clamped below and loaded above buckles at
// pi^2 E I / (4 L^2).
TEST(LargeStrainEquilibrium, SaysThatAColumnBuckles) {
  const double pi = 2 * std::acos(0.0);
  const double critical = pi * pi / 12 / (4 * 400);
  Mesh mesh = BoxGrid(Eigen::Vector2i(4, 80), Eigen::Vector2d(1, 20));
  mesh.section.model = SectionModel::kPlaneStress;
  Scene scene = SceneOf(mesh, "corotated");
  HoldInBox(Eigen::Vector2d(0, 0), Eigen::Vector2d(1, 0), scene);
  const auto solve = [&](double load) {
    scene.load_cases[0].loads = {TractionInBox(mesh, Eigen::Vector2d(0, 20),
                                               Eigen::Vector2d(1, 20),
                                               Eigen::Vector2d(0, -load))};
    return SolveOf(scene, Eigen::Vector2d(1, 0.0));
  };
  EXPECT_EQ(solve(0.9 * critical).status, EquilibriumStatus::kDone);
  const LargeStrainState state = solve(2 * critical);
  EXPECT_EQ(state.status, EquilibriumStatus::kUnstable);
  // Bilinear elements are too stiff by some per cent.
  EXPECT_NEAR(state.load_share, 0.5, 0.04);
  EXPECT_THAT(WhyNotInEquilibrium(state), HasSubstr("unstable"));
  // It gives way sideways at its upper end, and is pressed most at its foot.
  EXPECT_GE(state.element, mesh.NumElements() - 4);
}

// Returns a cube that is pressed by 0.3 E.  St. Venant and Kirchhoff's law
// bears up to E / sqrt(27), at a stretch of 1 / sqrt(3).
Scene CubePressedTooFar() {
  const Mesh mesh = BoxGrid(Eigen::Vector3i(1, 1, 1), Eigen::Vector3d::Ones());
  Scene scene = SceneOf(mesh, "st_venant_kirchhoff");
  for (int axis = 0; axis < 3; ++axis) {
    HoldPlane(axis, 0, 0, scene);
  }
  scene.load_cases[0].loads = {TractionInBox(mesh, Eigen::Vector3d(0, 0, 1),
                                             Eigen::Vector3d(1, 1, 1),
                                             Eigen::Vector3d(0, 0, -0.3))};
  return scene;
}

TEST(LargeStrainEquilibrium, SaysAtWhichLoadTheMaterialGivesWay) {
  const Scene scene = CubePressedTooFar();
  const LargeStrainState state = SolveOf(scene, Eigen::Vector2d(1, 0.0));
  // Newton's method ends in elements that are inside out, but at the last
  // equilibrium none is nearly flat.
  EXPECT_EQ(state.status, EquilibriumStatus::kNoEquilibrium);
  EXPECT_NEAR(state.load_share, 1 / std::sqrt(27.0) / 0.3, 2e-3);
  EXPECT_THAT(WhyNotInEquilibrium(state), HasSubstr("% of the load"));
}

TEST(LargeStrainEquilibrium, ShowsHowFarItsSearchIs) {
  const Scene scene = CubePressedTooFar();
  LargeStrainEquilibrium model(scene);
  std::vector<std::string> shown;
  const LargeStrainSolution solution = SolveLoadCases(
      model.Forces().Parameters().Moduli(Eigen::Vector2d(1, 0)), model,
      [&](const std::string& text) { shown.push_back(text); });
  EXPECT_THAT(solution.why_not, HasSubstr("load case 1: beyond 64 %"));
  ASSERT_GE(shown.size(), 3U);
  EXPECT_EQ(shown.front(), "load case 1");
  EXPECT_EQ(shown[1], "load case 1, 0 % of the load reached");
  EXPECT_THAT(shown.back(), HasSubstr("load case 1, 64"));
}

TEST(LargeStrainEquilibrium, NamesTheElementThatIsTurnedInsideOut) {
  const Mesh mesh = BoxGrid(Eigen::Vector3i(1, 1, 2), Eigen::Vector3d(1, 1, 2));
  Scene scene = SceneOf(mesh, "corotated");
  for (int axis = 0; axis < 3; ++axis) {
    HoldPlane(axis, 0, 0, scene);
  }
  HoldPlane(2, 2, -3, scene);
  // The lower element is stiffer, and gives way later.
  scene.mesh.regions = Eigen::Vector2i(1, 2);
  scene.materials.resize(2, scene.materials[0]);
  scene.materials[0].regions = {1};
  scene.materials[1].regions = {2};
  const LargeStrainState state = SolveOf(scene, Eigen::Vector4d(2, 0, 1, 0));
  EXPECT_EQ(state.status, EquilibriumStatus::kInverted);
  // Springs of 2 and 1: the upper one takes two thirds of the displacement.
  EXPECT_NEAR(state.load_share, 0.5, 0.01);
  EXPECT_THAT(WhyNotInEquilibrium(state), HasSubstr("element 1 is turned"));
}

// Forces and supports so small that strains are small.
TEST(LargeStrainEquilibrium, IsTheLinearEquilibriumOfSmallLoads) {
  for (const ElementKind kind :
       {ElementKind::kTet4, ElementKind::kHex8, ElementKind::kTri6}) {
    Scene scene = testing::SceneOfKind(
        {kind, DimensionOf(kind) == 3 ? SectionModel::kSolid
                                      : SectionModel::kPlaneStress});
    scene.load_cases[0].loads = {Scaled(scene.load_cases[0].loads[0], 1e-6)};
    const Eigen::Vector2d parameters(2, 0.3);
    const Eigen::MatrixXd linear = DisplacementsAt(scene, parameters);
    scene.materials.resize(1);
    scene.materials[0].law = "neo_hookean";
    const LargeStrainState state =
        SolveOf(scene, parameters, Dilatation::kOfPoints);
    ASSERT_EQ(state.status, EquilibriumStatus::kDone);
    EXPECT_LT((state.displacement - linear).norm(), 1e-4 * linear.norm());
  }
}

TEST(LargeStrainEquilibrium, BeginsWhereItIsTold) {
  const Mesh mesh = BoxGrid(Eigen::Vector3i(2, 2, 6), Eigen::Vector3d(1, 1, 6));
  Scene scene = SceneOf(mesh, "neo_hookean");
  HoldInBox(Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(1, 1, 0), scene);
  scene.load_cases[0].loads = {TractionInBox(mesh, Eigen::Vector3d(0, 0, 6),
                                             Eigen::Vector3d(1, 1, 6),
                                             Eigen::Vector3d(0.005, 0, 0))};
  LargeStrainEquilibrium model(scene);
  const Eigen::Vector2d moduli =
      model.Forces().Parameters().Moduli(Eigen::Vector2d(1, 0.3));
  const LargeStrainState first = model.Solve(moduli, 0);
  ASSERT_EQ(first.status, EquilibriumStatus::kDone);
  // The tip moves by nearly half of the length.
  EXPECT_GT(first.displacement.maxCoeff(), 2.5);
  const LargeStrainState again = model.SolveFrom(first.displacement, moduli, 0);
  EXPECT_EQ(again.num_tangents, 1);
  const LargeStrainState nearby =
      model.SolveFrom(first.displacement, 1.01 * moduli, 0);
  EXPECT_EQ(nearby.status, EquilibriumStatus::kDone);
  EXPECT_LE(nearby.num_tangents, 5);
}

}  // namespace
}  // namespace elastimate
