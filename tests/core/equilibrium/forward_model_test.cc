#include "elastimate/core/equilibrium/forward_model.h"

#include <ceres/jet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <string>
#include <tuple>
#include <vector>

#include "elastimate/core/scene/loads.h"
#include "elastimate/core/scene/rigid_motion.h"
#include "tests/core/plane_waves.h"
#include "tests/core/random_values.h"
#include "tests/dense_reference.h"
#include "tests/quadratic_reference.h"
#include "tests/scenes.h"
#include "tests/throws.h"

namespace elastimate {
namespace {

using testing::BoxMesh;
using testing::DenseStiffness;
using testing::Distorted;
using testing::ForEachGaussPoint;
using testing::HookeMatrix;
using testing::kNan;
using testing::PlaneWaves;
using testing::RandomMatrix;
using testing::SmallScene;
using testing::WithBothOrientations;
using testing::WithThreeForces;

constexpr double kYoungs = 2.5e4;

Supports FreeSupports(const Mesh& mesh) {
  return {ComponentMask::Constant(3, mesh.NumNodes(), false),
          Eigen::MatrixXd::Zero(3, mesh.NumNodes())};
}

// Returns the condition number, from the eigenvalues of the dense stiffness.
double Condition(const Eigen::MatrixXd& stiffness) {
  const Eigen::VectorXd eigenvalues = testing::SymmetricEigenvalues(stiffness);
  return eigenvalues(eigenvalues.size() - 1) / eigenvalues(0);
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
  Eigen::MatrixXd force;

  // Pulls at one end, or at both.
  void Pull(bool both_ends) {
    const Eigen::MatrixXi facets = BoundaryFacets(mesh);
    std::vector<Load> loads;
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
    force = AssembleLoads(mesh, loads).reshaped();
  }

  // Rounding times a condition number of 1e4 / (1 - 2 nu) is below 1e-10.
  void ExpectExact(double nu) const {
    ForwardModel model(mesh, supports, force);
    ASSERT_TRUE(model.SetPoissonRatio(nu));
    const Eigen::Vector3d strain =
        kTension / kYoungs * Eigen::Vector3d(-nu, -nu, 1);
    const Eigen::MatrixXd exact = (strain.asDiagonal() * mesh.nodes).reshaped();
    EXPECT_LT(RelativeError(model.Displacement(kYoungs), exact), 1e-10);
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
// This patch test uses the support response v alone, for any E.
TEST_P(ForNu, PrescribedLinearFieldContinuesInside) {
  const Mesh box = BoxMesh({3, 3, 4}, {1, 0.8, 1.2});
  const Mesh mesh = WithBothOrientations(Distorted(box));
  Eigen::Matrix3d gradient;
  gradient << 0.01, 0.02, -0.03, 0.04, -0.05, 0.06, 0.07, 0.08, 0.09;
  const Eigen::MatrixXd exact =
      (gradient * mesh.nodes).colwise() + Eigen::Vector3d(0.1, -0.2, 0.3);
  Supports supports = FreeSupports(mesh);
  supports.displacement.setConstant(kNan);
  const Eigen::MatrixXi facets = BoundaryFacets(mesh);
  for (const int node : facets.reshaped()) {
    supports.held.col(node).setConstant(true);
    supports.displacement.col(node) = exact.col(node);
  }
  ASSERT_EQ(DegreesOfFreedom(supports).NumFree(), 3 * 2 * 2 * 3);
  ForwardModel model(mesh, supports,
                     Eigen::MatrixXd::Zero(3 * mesh.NumNodes(), 1));
  ASSERT_TRUE(model.SetPoissonRatio(GetParam()));
  const Eigen::MatrixXd expected = exact.reshaped();
  // The tolerance is rounding times a condition number of 1e2 / (1 - 2 nu).
  EXPECT_LT(RelativeError(model.SupportResponse(), expected), 1e-12);
  EXPECT_TRUE(model.UnitLoadResponse().isZero(0));
  EXPECT_LT(RelativeError(model.Displacement(1), expected), 1e-12);
  EXPECT_LT(RelativeError(model.Displacement(1e6), expected), 1e-12);
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
  ForwardModel model(bar.mesh, bar.supports,
                     Eigen::MatrixXd::Zero(3 * bar.mesh.NumNodes(), 1));
  ASSERT_TRUE(model.SetPoissonRatio(GetParam()));
  const Eigen::Vector3d strain =
      shortening * Eigen::Vector3d(GetParam(), GetParam(), -1);
  const Eigen::MatrixXd exact =
      (strain.asDiagonal() * bar.mesh.nodes).reshaped();
  EXPECT_LT(RelativeError(model.Displacement(kYoungs), exact), 1e-10);
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

  ForwardModel model(mesh, supports, force.reshaped());
  EXPECT_TRUE(model.SetPoissonRatio(elasticity.poisson_ratio));
  const Eigen::MatrixXd solution =
      model.Displacement(elasticity.youngs_modulus);
  double square_error = 0;
  for (Eigen::Index e = 0; e < mesh.NumElements(); ++e) {
    const Eigen::Matrix<double, 3, 4> x = corners(e);
    Eigen::Matrix<double, 3, 4> u;
    for (int i = 0; i < 4; ++i) {
      const Eigen::Index node = mesh.elements(i, e);
      u.col(i) = solution.middleRows<3>(3 * node);
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
// A dense reference: K from Hooke's law and B^T D B, its solution by
// elimination, and derivatives of all of it by automatic differentiation.

template <typename T>
using DenseMatrix = Eigen::Matrix<T, Eigen::Dynamic, Eigen::Dynamic>;

// Gauss-Jordan elimination, which needs no pivots when `a` is positive
// definite; `b` becomes the solution.  (Eigen's decompositions take minutes to
// compile for numbers with derivatives under the sanitizers.)
template <typename T>
void Eliminate(DenseMatrix<T>& a, DenseMatrix<T>& b) {
  for (Eigen::Index pivot = 0; pivot < a.rows(); ++pivot) {
    for (Eigen::Index i = 0; i < a.rows(); ++i) {
      if (i == pivot) {
        continue;
      }
      const T factor = a(i, pivot) / a(pivot, pivot);
      for (Eigen::Index j = pivot; j < a.cols(); ++j) {
        a(i, j) -= factor * a(pivot, j);
      }
      for (Eigen::Index j = 0; j < b.cols(); ++j) {
        b(i, j) -= factor * b(pivot, j);
      }
    }
  }
  for (Eigen::Index i = 0; i < a.rows(); ++i) {
    for (Eigen::Index j = 0; j < b.cols(); ++j) {
      b(i, j) /= a(i, i);
    }
  }
}

// A small mesh with per-component supports, several load cases and, if asked
// for, prescribed displacements.
struct DenseScene {
  Mesh mesh = WithBothOrientations(Distorted(BoxMesh({1, 2, 2}, {1, 1, 1})));
  Supports supports = FreeSupports(mesh);
  Eigen::MatrixXd force;

  DenseScene(int num_load_cases, bool prescribed)
      : force(RandomMatrix(3 * mesh.NumNodes(), num_load_cases, 1)) {
    supports.held.leftCols(4).setConstant(true);
    supports.held(1, 9) = true;
    supports.held(2, 17) = true;
    if (prescribed) {
      supports.displacement = 1e-4 * RandomMatrix(3, mesh.NumNodes(), 2);
    }
  }

  // K is linear in Hooke's law, K = lambda K_lambda + mu K_mu: only the two
  // factors carry derivatives.
  template <typename T>
  DenseMatrix<T> Displacement(const T& log_youngs, const T& nu) const {
    using std::exp;
    const Eigen::Matrix<T, 6, 6> hooke = HookeMatrix<T>(exp(log_youngs), nu);
    const T& lambda = hooke(0, 1);
    const T& mu = hooke(3, 3);
    Eigen::Matrix<double, 6, 6> d_lambda = Eigen::Matrix<double, 6, 6>::Zero();
    d_lambda.topLeftCorner<3, 3>().setOnes();
    Eigen::Matrix<double, 6, 1> d_mu;
    d_mu << 2, 2, 2, 1, 1, 1;
    const Eigen::MatrixXd k_lambda = DenseStiffness<double>(mesh, d_lambda);
    const Eigen::MatrixXd k_mu = DenseStiffness<double>(
        mesh, Eigen::Matrix<double, 6, 6>(d_mu.asDiagonal()));

    Eigen::VectorXd held = Eigen::VectorXd::Zero(force.rows());
    std::vector<Eigen::Index> free;
    for (Eigen::Index dof = 0; dof < force.rows(); ++dof) {
      if (supports.held.reshaped()(dof)) {
        held(dof) = supports.displacement.reshaped()(dof);
      } else {
        free.push_back(dof);
      }
    }
    const Eigen::Index size = static_cast<Eigen::Index>(free.size());
    const Eigen::VectorXd held_lambda = k_lambda * held;
    const Eigen::VectorXd held_mu = k_mu * held;
    DenseMatrix<T> stiffness(size, size);
    DenseMatrix<T> solution(size, force.cols());
    for (Eigen::Index i = 0; i < size; ++i) {
      for (Eigen::Index j = 0; j < size; ++j) {
        stiffness(i, j) =
            lambda * k_lambda(free[i], free[j]) + mu * k_mu(free[i], free[j]);
      }
      for (Eigen::Index j = 0; j < force.cols(); ++j) {
        solution(i, j) = force(free[i], j) - lambda * held_lambda(free[i]) -
                         mu * held_mu(free[i]);
      }
    }
    Eliminate(stiffness, solution);

    DenseMatrix<T> u(force.rows(), force.cols());
    for (Eigen::Index j = 0; j < force.cols(); ++j) {
      for (Eigen::Index dof = 0; dof < force.rows(); ++dof) {
        u(dof, j) = T(held(dof));
      }
      for (Eigen::Index i = 0; i < size; ++i) {
        u(free[i], j) = solution(i, j);
      }
    }
    return u;
  }

  // Rounding times the condition number of the free stiffness.
  double Tolerance(double nu) const {
    const std::vector<Eigen::Index> free = DegreesOfFreedom(supports).free;
    return 1e-14 * Condition(DenseStiffness<double>(
                       mesh, HookeMatrix<double>(1, nu))(free, free));
  }
};

class AgainstDense
    : public ::testing::TestWithParam<std::tuple<double, int, bool>> {
 protected:
  AgainstDense()
      : nu_(std::get<0>(GetParam())),
        scene_(std::get<1>(GetParam()), std::get<2>(GetParam())),
        model_(scene_.mesh, scene_.supports, scene_.force) {}

  double nu_;
  DenseScene scene_;
  ForwardModel model_;
};

INSTANTIATE_TEST_SUITE_P(
    NuLoadCasesPrescribed, AgainstDense,
    ::testing::Combine(::testing::Values(-0.5, 0.0, 0.3, 0.49),
                       ::testing::Values(1, 3), ::testing::Bool()));

TEST_P(AgainstDense, Displacement) {
  ASSERT_TRUE(model_.SetPoissonRatio(nu_));
  EXPECT_LT(RelativeError(model_.Displacement(kYoungs),
                          scene_.Displacement<double>(std::log(kYoungs), nu_)),
            scene_.Tolerance(nu_));
}

TEST_P(AgainstDense, SensitivitiesByAutomaticDifferentiation) {
  using Jet = ceres::Jet<double, 2>;
  const DenseMatrix<Jet> expected =
      scene_.Displacement<Jet>(Jet(std::log(kYoungs), 0), Jet(nu_, 1));
  ASSERT_TRUE(model_.SetPoissonRatio(nu_));
  const DisplacementSensitivities actual = model_.Sensitivities(kYoungs);
  const auto derivative = [&](int parameter) {
    Eigen::MatrixXd values(expected.rows(), expected.cols());
    for (Eigen::Index i = 0; i < values.size(); ++i) {
      values.data()[i] = expected.data()[i].v(parameter);
    }
    return values;
  };
  // A derivative multiplies by the inverse twice, so its rounding is larger.
  const double tolerance = 10 * scene_.Tolerance(nu_);
  EXPECT_LT(RelativeError(actual.log_youngs_modulus, derivative(0)), tolerance);
  EXPECT_LT(RelativeError(actual.poisson_ratio, derivative(1)), tolerance);
}

TEST_P(AgainstDense, SensitivitiesByCentralDifferences) {
  // The truncation error is h^2 u''' / 6, with derivatives that grow like 1 /
  // (1/2 - nu).  The rounding error is 1e-16 condition / h.
  const double step = 1e-4 * (0.5 - nu_);
  ASSERT_TRUE(model_.SetPoissonRatio(nu_));
  const DisplacementSensitivities actual = model_.Sensitivities(kYoungs);
  const Eigen::MatrixXd by_youngs =
      (model_.Displacement(kYoungs * std::exp(1e-4)) -
       model_.Displacement(kYoungs * std::exp(-1e-4))) /
      2e-4;
  ASSERT_TRUE(model_.SetPoissonRatio(nu_ + step));
  const Eigen::MatrixXd above = model_.Displacement(kYoungs);
  ASSERT_TRUE(model_.SetPoissonRatio(nu_ - step));
  const Eigen::MatrixXd by_nu =
      (above - model_.Displacement(kYoungs)) / (2 * step);
  EXPECT_LT(RelativeError(actual.log_youngs_modulus, by_youngs), 1e-7);
  EXPECT_LT(RelativeError(actual.poisson_ratio, by_nu), 1e-6);
}

// ---------------------------------------------------------------------------
// Properties.

TEST(ForwardModel, IsLinearInTheForce) {
  const Scene scene = SmallScene("organ");
  const Eigen::Index rows = 3 * scene.mesh.NumNodes();
  Eigen::MatrixXd force(rows, 3);
  force.leftCols(2) = RandomMatrix(rows, 2, 5);
  force.col(2) = 2 * force.col(0) - 3 * force.col(1);
  ForwardModel model(scene.mesh, scene.supports, force);
  ASSERT_TRUE(model.SetPoissonRatio(0.3));
  const Eigen::MatrixXd u = model.Displacement(kYoungs);
  // The tolerance is rounding times a condition number of some hundreds.
  EXPECT_LT(RelativeError(u.col(2), 2 * u.col(0) - 3 * u.col(1)), 1e-12);
  EXPECT_LT(RelativeError(model.Displacement(kYoungs / 4), 4 * u), 1e-15);
}

TEST(ForwardModel, IgnoresForcesOnHeldDegreesOfFreedom) {
  const Scene scene = SmallScene("cuboid");
  const Eigen::MatrixXd force = AssembleLoadCases(scene);
  const DegreesOfFreedom dofs(scene.supports);
  Eigen::MatrixXd more = Eigen::MatrixXd::Constant(force.rows(), 1, 1e6);
  more(dofs.free, Eigen::all) = force(dofs.free, Eigen::all);
  ForwardModel model(scene.mesh, scene.supports, force);
  ForwardModel model_of_more(scene.mesh, scene.supports, more);
  ASSERT_TRUE(model.SetPoissonRatio(0.3));
  ASSERT_TRUE(model_of_more.SetPoissonRatio(0.3));
  EXPECT_EQ(model.Displacement(1), model_of_more.Displacement(1));
}

TEST(ForwardModel, HoldsTheHeldDegreesOfFreedomExactly) {
  const DenseScene scene(2, /*prescribed=*/true);
  ForwardModel model(scene.mesh, scene.supports, scene.force);
  ASSERT_TRUE(model.SetPoissonRatio(0.3));
  const Eigen::MatrixXd u = model.Displacement(kYoungs);
  const DisplacementSensitivities sensitivities = model.Sensitivities(kYoungs);
  for (Eigen::Index dof = 0; dof < u.rows(); ++dof) {
    if (!scene.supports.held.reshaped()(dof)) {
      continue;
    }
    for (Eigen::Index i = 0; i < u.cols(); ++i) {
      EXPECT_EQ(u(dof, i), scene.supports.displacement.reshaped()(dof));
      EXPECT_EQ(sensitivities.log_youngs_modulus(dof, i), 0);
      EXPECT_EQ(sensitivities.poisson_ratio(dof, i), 0);
    }
  }
}

TEST(ForwardModel, OfThreeLoadCasesIsThatOfEach) {
  const Scene scene = WithThreeForces(SmallScene("bar"));
  const Eigen::MatrixXd force = AssembleLoadCases(scene);
  ForwardModel all(scene.mesh, scene.supports, force);
  ASSERT_TRUE(all.SetPoissonRatio(0.4));
  for (Eigen::Index i = 0; i < 3; ++i) {
    ForwardModel one(scene.mesh, scene.supports, force.col(i));
    ASSERT_TRUE(one.SetPoissonRatio(0.4));
    // A slender bar: a condition number of some 1e4.
    EXPECT_LT(RelativeError(all.Displacement(1).col(i), one.Displacement(1)),
              1e-11);
  }
}

TEST(ForwardModel, WithoutLoadCasesHasNoColumns) {
  const Scene scene = SmallScene("cuboid");
  ForwardModel model(scene.mesh, scene.supports,
                     Eigen::MatrixXd(3 * scene.mesh.NumNodes(), 0));
  ASSERT_TRUE(model.SetPoissonRatio(0.3));
  EXPECT_EQ(model.Displacement(1).cols(), 0);
  EXPECT_EQ(model.Sensitivities(1).poisson_ratio.cols(), 0);
}

void ExpectWork(const ForwardModel& model, int passes, int factorizations,
                int solves) {
  EXPECT_EQ(model.WorkDone().element_passes, passes);
  EXPECT_EQ(model.WorkDone().factorizations, factorizations);
  EXPECT_EQ(model.WorkDone().solves, solves);
}

TEST(ForwardModel, CountsItsWork) {
  const DenseScene scene(3, /*prescribed=*/false);
  ForwardModel model(scene.mesh, scene.supports, scene.force);
  ExpectWork(model, 1, 0, 0);
  ASSERT_TRUE(model.SetPoissonRatio(0.3));
  ExpectWork(model, 1, 1, 3);
  model.Displacement(1);
  ASSERT_TRUE(model.SetPoissonRatio(0.3));
  ExpectWork(model, 1, 1, 3);
  model.Sensitivities(1);
  ExpectWork(model, 2, 1, 6);
  model.Sensitivities(5);
  ExpectWork(model, 2, 1, 6);
  ASSERT_TRUE(model.SetPoissonRatio(0.4));
  ExpectWork(model, 2, 2, 9);
  model.Sensitivities(1);
  ExpectWork(model, 3, 2, 12);
}

TEST(ForwardModel, CountsTheWorkOfPrescribedDisplacements) {
  const DenseScene scene(3, /*prescribed=*/true);
  ForwardModel model(scene.mesh, scene.supports, scene.force);
  ExpectWork(model, 2, 0, 0);
  ASSERT_TRUE(model.SetPoissonRatio(0.3));
  ExpectWork(model, 2, 1, 4);
  model.Sensitivities(1);
  ExpectWork(model, 3, 1, 8);
}

TEST(ForwardModel, RefusesNuOutsideItsRangeAndRecovers) {
  const DenseScene scene(1, /*prescribed=*/true);
  ForwardModel model(scene.mesh, scene.supports, scene.force);
  EXPECT_TRUE(std::isnan(model.PoissonRatio()));
  ASSERT_TRUE(model.SetPoissonRatio(0.3));
  EXPECT_EQ(model.PoissonRatio(), 0.3);
  const Eigen::MatrixXd u = model.Displacement(1);
  const Eigen::MatrixXd by_nu = model.Sensitivities(1).poisson_ratio;
  for (const double bad :
       {0.5, -1.0, 0.7, -2.0, kNan, std::numeric_limits<double>::infinity(),
        std::nextafter(0.5, 0.0)}) {
    EXPECT_FALSE(model.SetPoissonRatio(bad)) << bad;
    EXPECT_TRUE(std::isnan(model.PoissonRatio()));
    ASSERT_TRUE(model.SetPoissonRatio(0.3));
    EXPECT_EQ(model.Displacement(1), u);
    EXPECT_EQ(model.Sensitivities(1).poisson_ratio, by_nu);
  }
}

TEST(ForwardModel, DoesNotCountAFactorisationItDidNotTry) {
  const DenseScene scene(1, /*prescribed=*/false);
  ForwardModel model(scene.mesh, scene.supports, scene.force);
  EXPECT_FALSE(model.SetPoissonRatio(0.5));
  EXPECT_FALSE(model.SetPoissonRatio(kNan));
  ExpectWork(model, 1, 0, 0);
}

TEST(ForwardModel, SaysWhyTheSupportsDoNotHold) {
  const Scene scene = SmallScene("cuboid");
  const Eigen::MatrixXd force = AssembleLoadCases(scene);
  Supports supports = scene.supports;
  supports.held.row(0).setConstant(false);
  const std::string why = WhyNotHeld(scene.mesh, supports);
  EXPECT_THAT(why, ::testing::HasSubstr("move along x"));
  EXPECT_THAT([&] { ForwardModel(scene.mesh, supports, force); },
              ::testing::ThrowsMessage<std::invalid_argument>(why));
}

}  // namespace
}  // namespace elastimate
