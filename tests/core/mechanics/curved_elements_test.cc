// Tests of curved quadratic elements of round bodies against their formulas:
// quarters of rings and tubes and octants of hollow balls, of radii 1 and 2.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <vector>

#include "elastimate/core/equilibrium/equilibrium.h"
#include "elastimate/core/mechanics/stiffness_product.h"
#include "elastimate/core/mesh/facets.h"
#include "elastimate/core/mesh/finer_nodes.h"
#include "elastimate/core/mesh/middle_nodes.h"
#include "elastimate/core/scene/finer_scene.h"
#include "elastimate/core/scene/loads.h"
#include "elastimate/core/scene/quadratic_scene.h"
#include "tests/core/mechanics/strain_energy.h"
#include "tests/core/random_values.h"
#include "tests/scenes.h"
#include "tests/throws.h"

namespace elastimate {
namespace {

using testing::StrainEnergyDensity;

constexpr double kQuarter = M_PI / 2;

enum class Round { kRing, kTube, kBall };

std::string NameOfRound(Round round) {
  return round == Round::kRing   ? "ring"
         : round == Round::kTube ? "tube"
                                 : "ball";
}

// A radius is the norm of the first coordinates of a position, of which this is
// the number.
Eigen::Index NumRoundAxes(Round round) { return round == Round::kBall ? 3 : 2; }

double RadiusAt(Round round, const Eigen::VectorXd& x) {
  return x.head(NumRoundAxes(round)).norm();
}

Mesh Ring(int cells) {
  Mesh mesh;
  mesh.kind = ElementKind::kTri3;
  mesh.section = {SectionModel::kPlaneStrain, 0.5};
  const int n = cells + 1;
  mesh.nodes.resize(2, n * n);
  for (int i = 0; i < n * n; ++i) {
    const double radius = 1 + double(i % n) / cells;
    const double angle = kQuarter * (i / n) / cells;
    mesh.nodes.col(i) << radius * std::cos(angle), radius * std::sin(angle);
  }
  mesh.elements.resize(3, 2 * cells * cells);
  for (int e = 0; e < cells * cells; ++e) {
    const int a = e % cells + n * (e / cells);
    mesh.elements.col(2 * e) << a, a + 1, a + n + 1;
    mesh.elements.col(2 * e + 1) << a, a + n + 1, a + n;
  }
  return mesh;
}

Mesh Tube(int cells) {
  Mesh mesh = testing::BoxMesh({cells, cells, 1}, {1, kQuarter, 0.5});
  for (auto x : mesh.nodes.colwise()) {
    const double radius = 1 + x(0);
    x.head<2>() =
        radius * Eigen::Vector2d(std::cos(x(1)), std::sin(x(1))).eval();
  }
  return mesh;
}

// Three blocks around the diagonal meet in an octant of a ball.
Mesh Ball(int cells) {
  const Mesh block = testing::BoxMesh({cells, cells, cells}, {1, 1, 1});
  Mesh mesh;
  std::vector<Eigen::Vector3d> nodes;
  mesh.elements.resize(4, 0);
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<int> place;
    for (const auto& y : block.nodes.colwise()) {
      const Eigen::Vector3d along = Eigen::Vector3d(1, y(1), y(2)).normalized();
      Eigen::Vector3d x;
      for (int i = 0; i < 3; ++i) {
        x((axis + i) % 3) = (1 + y(0)) * along(i);
      }
      const auto same = std::find_if(nodes.begin(), nodes.end(), [&](auto& z) {
        return (z - x).norm() < 1e-9;
      });
      place.push_back(int(same - nodes.begin()));
      if (same == nodes.end()) {
        nodes.push_back(x);
      }
    }
    Eigen::MatrixXi elements =
        block.elements.unaryExpr([&](int node) { return place[node]; });
    mesh.elements.conservativeResize(4, mesh.elements.cols() + elements.cols());
    mesh.elements.rightCols(elements.cols()) = elements;
  }
  mesh.nodes.resize(3, Eigen::Index(nodes.size()));
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    mesh.nodes.col(Eigen::Index(i)) = nodes[i];
  }
  return mesh;
}

Mesh LinearMesh(Round round, int cells) {
  return round == Round::kRing   ? Ring(cells)
         : round == Round::kTube ? Tube(cells)
                                 : Ball(cells);
}

// Moves the nodes of edges to the mean radius of the ends.
void Bend(Round round, Mesh& mesh) {
  const MiddleNodes nodes(mesh);
  const Eigen::Index n = NumRoundAxes(round);
  for (Eigen::Index i = 0; i < nodes.Vertices().Size(); ++i) {
    const Eigen::VectorXd a = mesh.nodes.col(nodes.Vertices()[i](0)).head(n);
    const Eigen::VectorXd b = mesh.nodes.col(nodes.Vertices()[i](1)).head(n);
    mesh.nodes.col(nodes.NumVertices() + i).head(n) =
        (a.norm() + b.norm()) / 2 *
        (a.normalized() + b.normalized()).normalized();
  }
  mesh.kind = CurvedKind(mesh.kind);
}

// Planes of symmetry cut the body out, and a pressure of 1 acts inside.
Scene UnderPressure(Round round, int cells, bool is_curved) {
  Scene scene;
  scene.mesh = LinearMesh(round, cells);
  const int dimension = scene.mesh.Dimension();
  scene.supports.held =
      ComponentMask::Constant(dimension, scene.mesh.NumNodes(), false);
  scene.supports.displacement.setZero(dimension, scene.mesh.NumNodes());
  scene.load_cases.resize(1);
  scene = QuadraticScene(scene);
  scene.load_cases[0].observed.resize(0, 0);
  if (is_curved) {
    Bend(round, scene.mesh);
  }
  scene.supports.held = scene.mesh.nodes.array().abs() < 1e-12;
  if (round == Round::kTube) {  // In plane strain.
    scene.supports.held.row(2).setConstant(true);
  }
  const Eigen::MatrixXi facets = BoundaryFacets(scene.mesh);
  std::vector<Eigen::Index> inside;
  for (Eigen::Index i = 0; i < facets.cols(); ++i) {
    bool is_inside = true;
    for (int k = 0; k < dimension; ++k) {  // The vertices.
      is_inside =
          is_inside &&
          RadiusAt(round, scene.mesh.nodes.col(facets(k, i))) < 1 + 1e-9;
    }
    if (is_inside) {
      inside.push_back(i);
    }
  }
  scene.load_cases[0].loads = {Pressure{facets(Eigen::all, inside), 1}};
  return scene;
}

class RoundBodies : public ::testing::TestWithParam<Round> {
 protected:
  Mesh MeshOf(int cells) const {
    return UnderPressure(GetParam(), cells, true).mesh;
  }
  // The tube and the ring have the length 0.5.
  double Volume() const {
    return GetParam() == Round::kBall ? M_PI / 6 * 7 : 0.5 * M_PI / 4 * 3;
  }
  double InnerArea() const {
    return GetParam() == Round::kBall ? M_PI / 2 : 0.5 * kQuarter;
  }

  // Returns the radial displacement at the inner radius 1 under a pressure of 1
  // inside, where the outer radius is 2 [Timoshenko & Goodier, Theory of
  // Elasticity].
  static double Lame(Round round, const IsotropicElasticity& elasticity) {
    const double e = elasticity.youngs_modulus;
    const double nu = elasticity.poisson_ratio;
    return round == Round::kBall
               ? (2 * (1 - 2 * nu) + 8 * (1 + nu)) / (2 * e * 7)
               : (1 + nu) / e * ((1 - 2 * nu) + 4) / 3;
  }

  // Returns the largest relative error of the radial displacement over the
  // vertices inside.
  double ErrorOfDisplacement(int cells, bool is_curved) const {
    const IsotropicElasticity elasticity = {3, 0.3};
    const Scene scene = UnderPressure(GetParam(), cells, is_curved);
    const Eigen::MatrixXd u =
        DisplacementsAt(scene, elasticity.Parameters())
            .reshaped(scene.mesh.Dimension(), scene.mesh.NumNodes());
    const double exact = Lame(GetParam(), elasticity);
    double error = 0;
    for (Eigen::Index i = 0; i < scene.mesh.NumVertices(); ++i) {
      const Eigen::VectorXd x =
          scene.mesh.nodes.col(i).head(NumRoundAxes(GetParam()));
      if (x.norm() < 1 + 1e-9) {
        error = std::max(
            error,
            std::abs(x.normalized().dot(u.col(i).head(x.size())) / exact - 1));
      }
    }
    return error;
  }
};

TEST_P(RoundBodies, HaveTheirVolumeByTheFourthOrder) {
  const auto error = [&](int cells) {
    const Mesh mesh = MeshOf(cells);
    ValidateMesh(mesh);
    return std::abs(ElementVolumes(mesh).sum() / Volume() - 1);
  };
  EXPECT_LT(error(4), 2e-4);
  EXPECT_GT(error(2) / error(4), 12);
}

TEST_P(RoundBodies, HaveTheirInnerAreaByTheFourthOrder) {
  const auto error = [&](int cells) {
    const Scene scene = UnderPressure(GetParam(), cells, true);
    const auto& load = std::get<Pressure>(scene.load_cases[0].loads[0]);
    return std::abs(FacetArea(scene.mesh, load.facets) / InnerArea() - 1);
  };
  EXPECT_LT(error(4), 2e-4);
  EXPECT_GT(error(2) / error(4), 12);
}

// By Gauss's theorem, the integral of n x^T over a closed surface is V I.  The
// facets of curved elements have it exactly.
TEST_P(RoundBodies, AreClosed) {
  const Mesh mesh = MeshOf(2);
  Eigen::MatrixXd moment =
      Eigen::MatrixXd::Zero(mesh.Dimension(), mesh.Dimension());
  const Eigen::MatrixXi facets = BoundaryFacets(mesh);
  for (const auto& facet : facets.colwise()) {
    moment += WeightsOfFacet(mesh, facet).area_vector *
              mesh.nodes(Eigen::all, facet).transpose();
  }
  const Eigen::MatrixXd expected =
      ElementVolumes(mesh).sum() *
      Eigen::MatrixXd::Identity(mesh.Dimension(), mesh.Dimension());
  EXPECT_TRUE(moment.isApprox(expected, 1e-13));
}

TEST_P(RoundBodies, WidenAsLameSaysAndBetterThanStraightOnes) {
  const double error = ErrorOfDisplacement(4, true);
  EXPECT_LT(error, 0.01);
  EXPECT_LT(error, 0.5 * ErrorOfDisplacement(4, false));
  EXPECT_LT(error, 0.3 * ErrorOfDisplacement(2, true));
}

TEST_P(RoundBodies, DoNotResistRigidMotions) {
  const Mesh mesh = MeshOf(2);
  const int d = mesh.Dimension();
  Eigen::MatrixXd turn = Eigen::MatrixXd::Zero(d, d);
  turn(0, 1) = 1;
  turn(1, 0) = -1;
  Eigen::MatrixXd u = turn * mesh.nodes;
  u.row(0).array() += 0.3;
  const StiffnessProducts products = MultiplyStiffnessBasis(mesh, u.reshaped());
  EXPECT_LT(products.h.cwiseAbs().maxCoeff(), 1e-14);
  EXPECT_LT(products.j.cwiseAbs().maxCoeff(), 1e-14);
  EXPECT_LT(StrainEnergyDensity(mesh, {1, 0.3}, u).maxCoeff(), 1e-28);
}

// Curved elements represent a uniform strain exactly, and the energy density of
// each element is exact too.
TEST_P(RoundBodies, HaveAUniformStrain) {
  const Mesh mesh = MeshOf(2);
  const int d = mesh.Dimension();
  const Eigen::MatrixXd gradient = testing::RandomMatrix(d, d, 1);
  const Eigen::MatrixXd strain = (gradient + gradient.transpose()) / 2;
  const IsotropicElasticity elasticity = {2, 0.25};
  const double mu = 2 / (2 * 1.25);
  const double lambda = 2 * 0.25 / (1.25 * 0.5);
  const double expected =
      mu * strain.squaredNorm() + lambda / 2 * strain.trace() * strain.trace();
  const Eigen::VectorXd density =
      StrainEnergyDensity(mesh, elasticity, gradient * mesh.nodes);
  EXPECT_NEAR(density.minCoeff() / expected, 1, 1e-12);
  EXPECT_NEAR(density.maxCoeff() / expected, 1, 1e-12);
}

// The finer elements fill the same body and carry the same loads.  They can
// take every displacement that these elements can.
TEST_P(RoundBodies, AreTheSameOfFinerElements) {
  Scene scene = UnderPressure(GetParam(), 2, true);
  const Eigen::MatrixXd nodal =
      AssembleLoads(scene.mesh, scene.load_cases[0].loads);
  scene.load_cases.resize(2);
  scene.load_cases[1].loads = {
      NodalForces{nodal},
      BodyForce{Eigen::VectorXd::Ones(scene.mesh.Dimension())}};
  const Scene finer = FinerScene(scene);
  ValidateScene(finer);
  EXPECT_NEAR(
      ElementVolumes(finer.mesh).sum() / ElementVolumes(scene.mesh).sum(), 1,
      1e-13);
  const FinerNodes nodes(scene.mesh, finer.mesh);
  const Eigen::MatrixXd forces = AssembleLoadCases(scene);
  EXPECT_TRUE(nodes.Restrict(AssembleLoadCases(finer)).isApprox(forces, 1e-12));
  const Eigen::MatrixXd u = testing::RandomMatrix(scene.mesh.NumDofs(), 1, 2);
  const auto energy = [](const Mesh& mesh, const Eigen::MatrixXd& field) {
    return StrainEnergyDensity(
               mesh, {1, 0.3},
               field.reshaped(mesh.Dimension(), mesh.NumNodes()))
        .dot(ElementVolumes(mesh));
  };
  // The integrands are quotients of polynomials, which the integration rule
  // does not integrate exactly.
  EXPECT_NEAR(energy(finer.mesh, nodes.Interpolate(u)) / energy(scene.mesh, u),
              1, 1e-2);
}

INSTANTIATE_TEST_SUITE_P(All, RoundBodies,
                         ::testing::Values(Round::kRing, Round::kTube,
                                           Round::kBall),
                         [](const auto& info) {
                           return NameOfRound(info.param);
                         });

Mesh OneTriangle() {
  Mesh mesh;
  mesh.kind = ElementKind::kCurvedTri6;
  mesh.section.model = SectionModel::kPlaneStress;
  mesh.nodes.resize(2, 6);
  mesh.nodes << 0, 1, 0, 0.5, 0.5, 0,  //
      0, 0, 1, 0, 0.5, 0.5;
  mesh.elements = Eigen::VectorXi::LinSpaced(6, 0, 5);
  return mesh;
}

TEST(CurvedElements, MayNotFoldOntoThemselves) {
  Mesh mesh = OneTriangle();
  mesh.nodes.col(3) << 0.5, 0.2;
  EXPECT_NO_THROW(ValidateMesh(mesh));
  mesh.nodes.col(3) << 0.5, 0.8;
  EXPECT_THROWS_WITH(
      ValidateMesh(mesh),
      "triangle 0 \\(nodes 0 1 2\\) is bent so far that it folds");
  mesh = OneTriangle();
  mesh.elements.col(0) << 0, 1, 2, 4, 3, 5;
  EXPECT_THROWS_WITH(ValidateMesh(mesh), "order its nodes as VTK does");
}

// Such elements are used at the tip of a crack: the map is singular at a
// vertex, and only there.
TEST(CurvedElements, MayHaveNodesAtTheQuarterOfEdges) {
  Mesh mesh = OneTriangle();
  mesh.nodes.col(3) << 0.25, 0;
  mesh.nodes.col(5) << 0, 0.25;
  ValidateMesh(mesh);
  EXPECT_NEAR(ElementVolumes(mesh)(0), 0.5, 1e-14);
  const Eigen::MatrixXd u = mesh.nodes.array().square();
  EXPECT_TRUE(StrainEnergyDensity(mesh, {1, 0.3}, u).allFinite());
}

TEST(CurvedElements, AreNamedWhereTheKindIsStraight) {
  Mesh mesh = OneTriangle();
  mesh.nodes(1, 3) = 0.1;
  mesh.kind = ElementKind::kTri6;
  EXPECT_THROWS_WITH(ValidateMesh(mesh),
                     "not in the middle between 0 and 1.*kind curved_tri6");
}

}  // namespace
}  // namespace elastimate
