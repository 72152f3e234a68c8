// Boundary value problems with known solutions, solved with quadratic
// tetrahedra.

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "elastimate/core/equilibrium/forward_model.h"
#include "elastimate/core/mesh/mesh.h"
#include "elastimate/core/scene/loads.h"
#include "elastimate/core/scene/quadratic_scene.h"
#include "tests/core/plane_waves.h"
#include "tests/core/random_values.h"
#include "tests/quadratic_reference.h"
#include "tests/scenes.h"

namespace elastimate {
namespace {

using testing::BoxMesh;
using testing::Distorted;
using testing::ForEachGaussPoint;
using testing::PlaneWaves;
using testing::QuadraticField;
using testing::QuadraticShapeFunctions;
using testing::WithBothOrientations;
using testing::WithMidEdgeNodes;

double RelativeNormOfError(const Eigen::MatrixXd& values,
                           const Eigen::MatrixXd& exact) {
  return (values - exact).norm() / exact.norm();
}

// Holds every node of the surface at this displacement.
Supports HeldAllAround(const Mesh& mesh, const Eigen::MatrixXd& displacement) {
  Supports supports{ComponentMask::Constant(3, mesh.NumNodes(), false),
                    displacement};
  const Eigen::MatrixXi facets = BoundaryFacets(mesh);
  for (const int node : facets.reshaped()) {
    supports.held.col(node).setConstant(true);
  }
  return supports;
}

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
  ForwardModel model(mesh, supports, AssembleLoads(mesh, {load}).reshaped());
  ASSERT_TRUE(model.SetPoissonRatio(elasticity.poisson_ratio));
  EXPECT_LT(RelativeNormOfError(model.Displacement(elasticity.youngs_modulus),
                                exact.reshaped()),
            1e-13 / (1 - 2 * GetParam()));
}

TEST_P(QuadraticForNu, ALinearFieldIsReproduced) {
  const Mesh mesh = WithMidEdgeNodes(
      WithBothOrientations(Distorted(BoxMesh({2, 3, 3}, {1, 0.8, 1.2}))));
  const Eigen::MatrixXd exact = QuadraticField().gradient * mesh.nodes;
  ForwardModel model(mesh, HeldAllAround(mesh, exact),
                     Eigen::MatrixXd::Zero(3 * mesh.NumNodes(), 1));
  ASSERT_TRUE(model.SetPoissonRatio(GetParam()));
  EXPECT_LT(RelativeNormOfError(model.Displacement(1), exact.reshaped()),
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
  ForwardModel model(quadratic.mesh, quadratic.supports,
                     AssembleLoadCases(quadratic));
  ASSERT_TRUE(model.SetPoissonRatio(GetParam()));
  const double youngs = 100;
  const Eigen::Vector3d strain =
      5 / youngs * Eigen::Vector3d(-GetParam(), -GetParam(), 1);
  const Eigen::MatrixXd exact =
      (strain.asDiagonal() * quadratic.mesh.nodes).reshaped();
  EXPECT_LT(RelativeNormOfError(model.Displacement(youngs), exact),
            1e-12 / (1 - 2 * GetParam()));
}

// The derivatives of the quadratic model, against central differences of it.
TEST(QuadraticForwardModel, SensitivitiesAreDerivatives) {
  const Scene scene = QuadraticScene(testing::SmallScene("organ"));
  ForwardModel model(scene.mesh, scene.supports, AssembleLoadCases(scene));
  const auto displacement = [&](double youngs, double nu) {
    EXPECT_TRUE(model.SetPoissonRatio(nu));
    return model.Displacement(youngs);
  };
  const double step = 1e-5;
  const Eigen::MatrixXd by_nu =
      (displacement(1e3, 0.3 + step) - displacement(1e3, 0.3 - step)) /
      (2 * step);
  ASSERT_TRUE(model.SetPoissonRatio(0.3));
  const DisplacementSensitivities sensitivities = model.Sensitivities(1e3);
  // The square of the step, and rounding over the step.
  EXPECT_LT(RelativeNormOfError(sensitivities.poisson_ratio, by_nu), 1e-8);
  EXPECT_LT(RelativeNormOfError(sensitivities.log_youngs_modulus,
                                -model.Displacement(1e3)),
            1e-14);
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
  ForwardModel model(mesh, HeldAllAround(mesh, exact), force.reshaped());
  EXPECT_TRUE(model.SetPoissonRatio(elasticity.poisson_ratio));
  const Eigen::MatrixXd solution =
      model.Displacement(elasticity.youngs_modulus);
  double square_error = 0;
  for (Eigen::Index e = 0; e < mesh.NumElements(); ++e) {
    const QuadraticShapeFunctions shape(mesh, e);
    Eigen::Matrix<double, 3, 10> u;
    for (int i = 0; i < 10; ++i) {
      const Eigen::Index node = mesh.elements(i, e);
      u.col(i) = solution.middleRows<3>(3 * node);
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
