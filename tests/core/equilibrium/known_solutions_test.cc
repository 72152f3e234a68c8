// Boundary value problems with known solutions, solved with linear and with
// quadratic tetrahedra.

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <utility>
#include <vector>

#include "elastimate/core/equilibrium/equilibrium.h"
#include "elastimate/core/mesh/mesh.h"
#include "elastimate/core/scene/degrees_of_freedom.h"
#include "elastimate/core/scene/loads.h"
#include "elastimate/core/scene/quadratic_scene.h"
#include "tests/core/plane_waves.h"
#include "tests/quadratic_reference.h"
#include "tests/scenes.h"

namespace elastimate {
namespace {

using testing::BoxMesh;
using testing::Distorted;
using testing::ForEachGaussPoint;
using testing::kNan;
using testing::PlaneWaves;
using testing::QuadraticField;
using testing::QuadraticShapeFunctions;
using testing::WithBothOrientations;
using testing::WithMidEdgeNodes;

constexpr double kYoungs = 2.5e4;

Supports FreeSupports(const Mesh& mesh) {
  return {ComponentMask::Constant(3, mesh.NumNodes(), false),
          Eigen::MatrixXd::Zero(3, mesh.NumNodes())};
}

// Holds every node of the surface at this displacement, and gives none to the
// others.
Supports HeldAllAround(const Mesh& mesh, const Eigen::MatrixXd& displacement) {
  Supports supports = FreeSupports(mesh);
  supports.displacement.setConstant(kNan);
  const Eigen::MatrixXi facets = BoundaryFacets(mesh);
  for (const int node : facets.reshaped()) {
    supports.held.col(node).setConstant(true);
    supports.displacement.col(node) = displacement.col(node);
  }
  return supports;
}

Eigen::VectorXd Solution(const Mesh& mesh, const Supports& supports,
                         std::vector<Load> loads,
                         const IsotropicElasticity& elasticity) {
  Scene scene = {mesh, {}, supports, {LoadCase()}};
  scene.load_cases[0].loads = std::move(loads);
  return DisplacementsAt(scene, elasticity.Parameters());
}

// Returns the largest error, relative to the largest expected value.
double RelativeError(const Eigen::MatrixXd& actual,
                     const Eigen::MatrixXd& expected) {
  return (actual - expected).cwiseAbs().maxCoeff() /
         expected.cwiseAbs().maxCoeff();
}

// ---------------------------------------------------------------------------
// Closed-form solutions.

class ForNu : public ::testing::TestWithParam<double> {};

INSTANTIATE_TEST_SUITE_P(PoissonRatios, ForNu,
                         ::testing::Values(-0.9, -0.5, 0.0, 0.3, 0.49));

// A bar under uniform tension: u = p / E (-nu x, -nu y, z).
struct Bar {
  static constexpr double kTension = 300;
  Mesh mesh = WithBothOrientations(BoxMesh({2, 2, 8}, {0.2, 0.3, 1}));
  Supports supports = FreeSupports(mesh);
  std::vector<Load> loads;

  // Pulls at one end, or at both.
  void Pull(bool both_ends) {
    const Eigen::MatrixXi facets = BoundaryFacets(mesh);
    for (Eigen::Index i = 0; i < facets.cols(); ++i) {
      const Eigen::Vector3d heights(mesh.nodes(2, facets(0, i)),
                                    mesh.nodes(2, facets(1, i)),
                                    mesh.nodes(2, facets(2, i)));
      if ((heights.array() == 1).all()) {
        loads.emplace_back(
            Traction{facets.col(i), Eigen::Vector3d(0, 0, kTension)});
      } else if ((heights.array() == 0).all() && both_ends) {
        loads.emplace_back(
            Traction{facets.col(i), Eigen::Vector3d(0, 0, -kTension)});
      }
    }
  }

  // Rounding times a condition number of 1e4 / (1 - 2 nu) is below 1e-10.
  void ExpectExact(double nu) const {
    const Eigen::Vector3d strain =
        kTension / kYoungs * Eigen::Vector3d(-nu, -nu, 1);
    const Eigen::MatrixXd exact = (strain.asDiagonal() * mesh.nodes).reshaped();
    EXPECT_LT(
        RelativeError(Solution(mesh, supports, loads, {kYoungs, nu}), exact),
        1e-10);
  }
};

// Planes of symmetry hold the bar and let its sides contract.
TEST_P(ForNu, TensionOfABarOnRollers) {
  Bar bar;
  for (int axis = 0; axis < 3; ++axis) {
    bar.supports.held.row(axis) = bar.mesh.nodes.row(axis).array() == 0;
  }
  bar.Pull(/*both_ends=*/false);
  bar.ExpectExact(GetParam());
}

TEST_P(ForNu, TensionOfABarOnAStaticallyDeterminateSupport) {
  Bar bar;
  bar.supports.held.col(0).setConstant(true);
  bar.supports.held.col(2) << false, true, true;   // (0.2, 0, 0)
  bar.supports.held.col(6) << false, false, true;  // (0, 0.3, 0)
  bar.Pull(/*both_ends=*/true);
  bar.ExpectExact(GetParam());
}

// A linear displacement is prescribed all around and must continue inside.
// This patch test has no loads, so that the displacement is the same for any E.
TEST_P(ForNu, PrescribedLinearFieldContinuesInside) {
  const Mesh box = BoxMesh({3, 3, 4}, {1, 0.8, 1.2});
  const Mesh mesh = WithBothOrientations(Distorted(box));
  Eigen::Matrix3d gradient;
  gradient << 0.01, 0.02, -0.03, 0.04, -0.05, 0.06, 0.07, 0.08, 0.09;
  const Eigen::MatrixXd exact =
      (gradient * mesh.nodes).colwise() + Eigen::Vector3d(0.1, -0.2, 0.3);
  const Supports supports = HeldAllAround(mesh, exact);
  ASSERT_EQ(DegreesOfFreedom(supports).NumFree(), 3 * 2 * 2 * 3);
  // The tolerance is rounding times a condition number of 1e2 / (1 - 2 nu).
  for (const double youngs : {1.0, 1e6}) {
    EXPECT_LT(RelativeError(Solution(mesh, supports, {}, {youngs, GetParam()}),
                            exact.reshaped()),
              1e-12);
  }
}

// One face is pushed in between rollers, and the sides give way.
TEST_P(ForNu, PrescribedFaceCompressesABar) {
  Bar bar;
  for (int axis = 0; axis < 3; ++axis) {
    bar.supports.held.row(axis) = bar.mesh.nodes.row(axis).array() == 0;
  }
  const double shortening = 0.01;
  for (Eigen::Index node = 0; node < bar.mesh.NumNodes(); ++node) {
    if (bar.mesh.nodes(2, node) == 1) {
      bar.supports.held(2, node) = true;
      bar.supports.displacement(2, node) = -shortening;
    }
  }
  const Eigen::Vector3d strain =
      shortening * Eigen::Vector3d(GetParam(), GetParam(), -1);
  const Eigen::MatrixXd exact =
      (strain.asDiagonal() * bar.mesh.nodes).reshaped();
  EXPECT_LT(
      RelativeError(Solution(bar.mesh, bar.supports, {}, {kYoungs, GetParam()}),
                    exact),
      1e-10);
}

// ---------------------------------------------------------------------------
// Convergence to a manufactured solution.

// Returns the L2 norm of the error on a distorted box of n^3 cubes.
double ManufacturedError(const IsotropicElasticity& elasticity, int n) {
  const PlaneWaves waves;
  const Mesh box = BoxMesh({n, n, n}, {1, 1, 1});
  const Mesh mesh = Distorted(box);
  Supports supports = FreeSupports(mesh);
  for (Eigen::Index node = 0; node < mesh.NumNodes(); ++node) {
    if ((box.nodes.col(node).array() == 0 || box.nodes.col(node).array() == 1)
            .any()) {
      supports.held.col(node).setConstant(true);
      supports.displacement.col(node) =
          waves.Displacement(mesh.nodes.col(node));
    }
  }
  const auto corners = [&](Eigen::Index e) {
    Eigen::Matrix<double, 3, 4> x;
    for (int i = 0; i < 4; ++i) {
      x.col(i) = mesh.nodes.col(mesh.elements(i, e));
    }
    return x;
  };
  const auto volume = [](const Eigen::Matrix<double, 3, 4>& x) {
    return std::abs((x.rightCols<3>().colwise() - x.col(0)).determinant()) / 6;
  };

  Eigen::MatrixXd force = Eigen::MatrixXd::Zero(3, mesh.NumNodes());
  for (Eigen::Index e = 0; e < mesh.NumElements(); ++e) {
    const Eigen::Matrix<double, 3, 4> x = corners(e);
    ForEachGaussPoint([&](const Eigen::Vector4d& shape, double weight) {
      const Eigen::Vector3d density = waves.BodyForce(elasticity, x * shape);
      for (int i = 0; i < 4; ++i) {
        force.col(mesh.elements(i, e)) +=
            volume(x) * weight * shape(i) * density;
      }
    });
  }

  const Eigen::VectorXd solution =
      Solution(mesh, supports, {NodalForces{force}}, elasticity);
  double square_error = 0;
  for (Eigen::Index e = 0; e < mesh.NumElements(); ++e) {
    const Eigen::Matrix<double, 3, 4> x = corners(e);
    Eigen::Matrix<double, 3, 4> u;
    for (int i = 0; i < 4; ++i) {
      const Eigen::Index node = mesh.elements(i, e);
      u.col(i) = solution.segment<3>(3 * node);
    }
    ForEachGaussPoint([&](const Eigen::Vector4d& shape, double weight) {
      square_error += volume(x) * weight *
                      (u * shape - waves.Displacement(x * shape)).squaredNorm();
    });
  }
  return std::sqrt(square_error);
}

class Convergence : public ::testing::TestWithParam<double> {};

// Linear elements: the error falls with the square of the mesh width.
TEST_P(Convergence, IsOfSecondOrder) {
  const IsotropicElasticity elasticity{2.5, GetParam()};
  const double coarse = ManufacturedError(elasticity, 4);
  const double medium = ManufacturedError(elasticity, 8);
  const double fine = ManufacturedError(elasticity, 12);
  EXPECT_GT(std::log(coarse / medium) / std::log(2), 1.8);
  EXPECT_LT(std::log(coarse / medium) / std::log(2), 2.3);
  EXPECT_GT(std::log(medium / fine) / std::log(1.5), 1.8);
  EXPECT_LT(std::log(medium / fine) / std::log(1.5), 2.3);
}

INSTANTIATE_TEST_SUITE_P(PoissonRatios, Convergence,
                         ::testing::Values(-0.5, 0.3));

// ---------------------------------------------------------------------------
// Quadratic elements.

class QuadraticForNu : public ::testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(PoissonRatios, QuadraticForNu,
                         ::testing::Values(-0.5, 0.0, 0.3, 0.49));

// The patch test of quadratic elements: a field of degree 2 and its uniform
// body force, on distorted elements, up to rounding times a condition number of
// 1e3 / (1 - 2 nu).
TEST_P(QuadraticForNu, AQuadraticFieldIsReproduced) {
  const Mesh mesh = WithMidEdgeNodes(
      WithBothOrientations(Distorted(BoxMesh({2, 3, 3}, {1, 0.8, 1.2}))));
  const IsotropicElasticity elasticity{2.5, GetParam()};
  const QuadraticField field;
  const Eigen::MatrixXd exact = field.Displacements(mesh.nodes);
  const BodyForce load{
      field.BodyForce(elasticity.LameLambda(), elasticity.ShearModulus())};
  const Supports supports = HeldAllAround(mesh, exact);
  ASSERT_EQ(DegreesOfFreedom(supports).NumFree(), 3 * 3 * 5 * 5);
  EXPECT_LT(RelativeError(Solution(mesh, supports, {load}, elasticity),
                          exact.reshaped()),
            1e-13 / (1 - 2 * GetParam()));
}

TEST_P(QuadraticForNu, ALinearFieldIsReproduced) {
  const Mesh mesh = WithMidEdgeNodes(
      WithBothOrientations(Distorted(BoxMesh({2, 3, 3}, {1, 0.8, 1.2}))));
  const Eigen::MatrixXd exact = QuadraticField().gradient * mesh.nodes;
  EXPECT_LT(RelativeError(
                Solution(mesh, HeldAllAround(mesh, exact), {}, {1, GetParam()}),
                exact.reshaped()),
            1e-13 / (1 - 2 * GetParam()));
}

// Tension on rollers by a traction, through QuadraticScene: its supports and
// its facets are those of the bar.
TEST_P(QuadraticForNu, TensionOfABarOnRollers) {
  Scene scene;
  scene.mesh = BoxMesh({2, 2, 3}, {0.4, 0.6, 1});
  scene.supports.held =
      scene.mesh.nodes.array() == 0;  // x = 0 holds x, and so on.
  scene.supports.displacement = Eigen::MatrixXd::Zero(3, 36);
  const Eigen::MatrixXi facets = BoundaryFacets(scene.mesh);
  std::vector<Eigen::Index> top;
  for (Eigen::Index i = 0; i < facets.cols(); ++i) {
    const Eigen::VectorXd z = scene.mesh.nodes(2, facets.col(i));
    if ((z.array() == 1).all()) {
      top.push_back(i);
    }
  }
  scene.load_cases.resize(1);
  scene.load_cases[0].loads = {
      Traction{facets(Eigen::all, top), Eigen::Vector3d(0, 0, 5)}};

  const Scene quadratic = QuadraticScene(scene);
  const double youngs = 100;
  const Eigen::Vector3d strain =
      5 / youngs * Eigen::Vector3d(-GetParam(), -GetParam(), 1);
  const Eigen::MatrixXd exact =
      (strain.asDiagonal() * quadratic.mesh.nodes).reshaped();
  EXPECT_LT(RelativeError(
                DisplacementsAt(quadratic, Eigen::Vector2d(youngs, GetParam())),
                exact),
            1e-12 / (1 - 2 * GetParam()));
}

// The L2 norm of the error on a distorted box of n^3 cubes.
double QuadraticManufacturedError(const IsotropicElasticity& elasticity,
                                  int n) {
  const PlaneWaves waves;
  const Mesh mesh = WithMidEdgeNodes(Distorted(BoxMesh({n, n, n}, {1, 1, 1})));
  Eigen::MatrixXd exact(3, mesh.NumNodes());
  for (Eigen::Index node = 0; node < mesh.NumNodes(); ++node) {
    exact.col(node) = waves.Displacement(mesh.nodes.col(node));
  }
  Eigen::MatrixXd force = Eigen::MatrixXd::Zero(3, mesh.NumNodes());
  for (Eigen::Index e = 0; e < mesh.NumElements(); ++e) {
    const QuadraticShapeFunctions shape(mesh, e);
    ForEachGaussPoint([&](const Eigen::Vector4d& point, double weight) {
      const Eigen::Vector3d x = shape.Position(point);
      const Eigen::Vector3d density = waves.BodyForce(elasticity, x);
      const Eigen::Matrix<double, 10, 1> values = shape.Values(x);
      for (int i = 0; i < 10; ++i) {
        force.col(mesh.elements(i, e)) +=
            shape.Volume() * weight * values(i) * density;
      }
    });
  }
  const Eigen::VectorXd solution = Solution(mesh, HeldAllAround(mesh, exact),
                                            {NodalForces{force}}, elasticity);
  double square_error = 0;
  for (Eigen::Index e = 0; e < mesh.NumElements(); ++e) {
    const QuadraticShapeFunctions shape(mesh, e);
    Eigen::Matrix<double, 3, 10> u;
    for (int i = 0; i < 10; ++i) {
      const Eigen::Index node = mesh.elements(i, e);
      u.col(i) = solution.segment<3>(3 * node);
    }
    ForEachGaussPoint([&](const Eigen::Vector4d& point, double weight) {
      const Eigen::Vector3d x = shape.Position(point);
      square_error +=
          shape.Volume() * weight *
          (u * shape.Values(x) - waves.Displacement(x)).squaredNorm();
    });
  }
  return std::sqrt(square_error);
}

class QuadraticConvergence : public ::testing::TestWithParam<double> {};

// The error falls with the cube of the mesh width.
TEST_P(QuadraticConvergence, IsOfThirdOrder) {
  const IsotropicElasticity elasticity{2.5, GetParam()};
  const double coarse = QuadraticManufacturedError(elasticity, 2);
  const double medium = QuadraticManufacturedError(elasticity, 4);
  const double fine = QuadraticManufacturedError(elasticity, 6);
  EXPECT_GT(std::log(coarse / medium) / std::log(2), 2.7);
  EXPECT_LT(std::log(coarse / medium) / std::log(2), 3.3);
  EXPECT_GT(std::log(medium / fine) / std::log(1.5), 2.8);
  EXPECT_LT(std::log(medium / fine) / std::log(1.5), 3.2);
}

INSTANTIATE_TEST_SUITE_P(PoissonRatios, QuadraticConvergence,
                         ::testing::Values(-0.5, 0.3));

}  // namespace
}  // namespace elastimate
