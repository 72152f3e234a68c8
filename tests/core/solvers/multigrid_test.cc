#include "elastimate/core/solvers/multigrid.h"

#include <gtest/gtest.h>
#include <malloc.h>

#include <cmath>
#include <limits>
#include <memory>

#include "elastimate/core/scene/quadratic_scene.h"
#include "elastimate/core/solvers/cholesky.h"
#include "tests/core/random_values.h"
#include "tests/scenes.h"

namespace elastimate {
namespace {

using testing::RandomMatrix;
using testing::SmallScene;

// A distorted mesh of which some nodes keep one or two free components, solved
// by both solvers.
class SolvedTwice : public ::testing::TestWithParam<int> {
 protected:
  SolvedTwice()
      : scene_(HeldScene(GetParam())),
        dofs_(scene_.supports),
        assembly_(scene_.mesh, dofs_),
        cholesky_(assembly_, dofs_),
        multigrid_(HasMultigrid() ? MakeMultigrid(scene_.mesh, assembly_, dofs_)
                                  : nullptr) {}

  void SetUp() override {
    if (multigrid_ == nullptr) {
      GTEST_SKIP() << "built without PETSc";
    }
  }

  static Scene HeldScene(int order) {
    Scene scene = SmallScene("organ");
    scene.supports.held =
        scene.supports.held ||
        testing::RandomSupports(scene.mesh.NumNodes(), 3).held;
    return order == 2 ? QuadraticScene(scene) : scene;
  }

  // |x|_A^2 = x^T A x for the lower triangle of A.
  double Energy(const Eigen::VectorXd& values, const Eigen::VectorXd& x) const {
    const SymmetricPattern& pattern = assembly_.Pattern();
    double energy = 0;
    for (Eigen::Index j = 0; j < x.size(); ++j) {
      for (auto k = pattern.column_start[j]; k < pattern.column_start[j + 1];
           ++k) {
        const std::int64_t i = pattern.row[k];
        energy += (i == j ? 1 : 2) * x(i) * values(k) * x(j);
      }
    }
    return energy;
  }

  Scene scene_;
  DegreesOfFreedom dofs_;
  StiffnessAssembly assembly_;
  Cholesky cholesky_;
  std::unique_ptr<LinearSolver> multigrid_;
};

INSTANTIATE_TEST_SUITE_P(Order, SolvedTwice, ::testing::Values(1, 2),
                         ::testing::PrintToStringParamName());

TEST_P(SolvedTwice, AgreesInEnergyToTheTolerance) {
  const Eigen::MatrixXd b = RandomMatrix(dofs_.NumFree(), 2, 1);
  for (const double nu : {-0.5, 0.3, 0.45}) {
    const Eigen::VectorXd values = assembly_.Combine(nu);
    ASSERT_TRUE(cholesky_.Factorize(values));
    ASSERT_TRUE(multigrid_->Factorize(values));
    const Eigen::MatrixXd exact = *cholesky_.Solve(b, 0, {});
    for (const double tolerance : {1e-3, 1e-8}) {
      const int before = multigrid_->NumIterations();
      const std::optional<Eigen::MatrixXd> solution =
          multigrid_->Solve(b, tolerance, {});
      ASSERT_TRUE(solution) << "nu " << nu << ", tolerance " << tolerance;
      EXPECT_LE(multigrid_->NumIterations() - before, 2 * 100);
      for (int k = 0; k < 2; ++k) {
        EXPECT_LE(Energy(values, solution->col(k) - exact.col(k)),
                  std::pow(tolerance, 2) * Energy(values, exact.col(k)))
            << "nu " << nu << ", tolerance " << tolerance;
      }
    }
  }
}

TEST_P(SolvedTwice, PreconditionsByASymmetricMatrixNearTheInverse) {
  const Eigen::VectorXd values = assembly_.Combine(0.3);
  ASSERT_TRUE(cholesky_.Factorize(values));
  ASSERT_TRUE(multigrid_->Factorize(values));
  const Eigen::MatrixXd b = RandomMatrix(dofs_.NumFree(), 5, 1);
  const Eigen::MatrixXd of_cycle = multigrid_->Precondition(b);
  const Eigen::MatrixXd products = b.transpose() * of_cycle;
  EXPECT_LE((products - products.transpose()).norm(), 1e-6 * products.norm());
  // Rough forces meet the eigenvalues of M A, which are near 1.
  const Eigen::MatrixXd exact = *cholesky_.Solve(b, 0, {});
  EXPECT_TRUE(cholesky_.Precondition(b).isApprox(exact, 1e-12));
  for (int k = 0; k < b.cols(); ++k) {
    const double ratio =
        b.col(k).dot(of_cycle.col(k)) / b.col(k).dot(exact.col(k));
    EXPECT_GT(ratio, 0.3);
    EXPECT_LT(ratio, 1.5);
  }
  EXPECT_EQ(multigrid_->Precondition(Eigen::MatrixXd(b.rows(), 0)).cols(), 0);
}

TEST_P(SolvedTwice, RenewsSpacesOfAnotherMatrixOnce) {
  ASSERT_TRUE(multigrid_->Factorize(assembly_.Combine(0.3)));
  EXPECT_FALSE(multigrid_->Renew());
  const Eigen::VectorXd values = assembly_.Combine(0.4999);
  ASSERT_TRUE(multigrid_->Factorize(values));
  EXPECT_EQ(multigrid_->NumSetUps(), 1);
  EXPECT_TRUE(multigrid_->Renew());
  EXPECT_EQ(multigrid_->NumSetUps(), 2);
  EXPECT_FALSE(multigrid_->Renew());
  EXPECT_FALSE(cholesky_.Factorize(values) && cholesky_.Renew());
}

// The spaces of a matrix serve another one, whatever its scale, and new ones
// are set up where they no longer do.
TEST_P(SolvedTwice, KeepsItsSpacesWhileTheyServe) {
  const Eigen::MatrixXd b = RandomMatrix(dofs_.NumFree(), 1, 4);
  const auto error_of_solution = [&](const Eigen::VectorXd& values) {
    EXPECT_TRUE(cholesky_.Factorize(values));
    EXPECT_TRUE(multigrid_->Factorize(values));
    const Eigen::VectorXd exact = *cholesky_.Solve(b, 0, {});
    const std::optional<Eigen::MatrixXd> solution =
        multigrid_->Solve(b, 1e-6, {});
    return solution ? std::sqrt(Energy(values, solution->col(0) - exact) /
                                Energy(values, exact))
                    : std::numeric_limits<double>::infinity();
  };
  EXPECT_LE(error_of_solution(assembly_.Combine(0.3)), 1e-6);
  EXPECT_LE(error_of_solution(7 * assembly_.Combine(0.32)), 1e-6);
  EXPECT_EQ(multigrid_->NumSetUps(), 1);
  for (int i = 0; i < 2; ++i) {
    EXPECT_LE(error_of_solution(assembly_.Combine(0.4999)), 1e-6);
  }
  EXPECT_EQ(multigrid_->NumSetUps(), 2);
}

TEST_P(SolvedTwice, BeginsWithAGuessOfAnyScaleAndQuality) {
  const Eigen::MatrixXd b = RandomMatrix(dofs_.NumFree(), 2, 5);
  const Eigen::VectorXd values = assembly_.Combine(0.3);
  ASSERT_TRUE(cholesky_.Factorize(values));
  ASSERT_TRUE(multigrid_->Factorize(values));
  const Eigen::MatrixXd exact = *cholesky_.Solve(b, 0, {});
  const auto iterations_from = [&](const Eigen::MatrixXd& start) {
    const int before = multigrid_->NumIterations();
    const Eigen::MatrixXd solution = *multigrid_->Solve(b, 1e-8, start);
    for (Eigen::Index k = 0; k < b.cols(); ++k) {
      EXPECT_LE(Energy(values, solution.col(k) - exact.col(k)),
                1e-16 * Energy(values, exact.col(k)));
    }
    return multigrid_->NumIterations() - before;
  };
  const int from_zero = iterations_from({});
  const Eigen::MatrixXd near =
      1e5 * (exact + 1e-5 * exact.cwiseAbs().maxCoeff() *
                         RandomMatrix(exact.rows(), exact.cols(), 6));
  EXPECT_LT(iterations_from(near), 0.8 * from_zero);
  EXPECT_LE(iterations_from(RandomMatrix(exact.rows(), exact.cols(), 7)),
            1.5 * from_zero);
}

TEST_P(SolvedTwice, RunsTwiceAlike) {
  const Eigen::MatrixXd b = RandomMatrix(dofs_.NumFree(), 1, 2);
  const Eigen::VectorXd values = assembly_.Combine(0.3);
  ASSERT_TRUE(multigrid_->Factorize(values));
  const Eigen::MatrixXd first = *multigrid_->Solve(b, 1e-6, {});
  ASSERT_TRUE(multigrid_->Factorize(values));
  EXPECT_EQ(*multigrid_->Solve(b, 1e-6, {}), first);
  const std::unique_ptr<LinearSolver> other =
      MakeMultigrid(scene_.mesh, assembly_, dofs_);
  ASSERT_TRUE(other->Factorize(values));
  EXPECT_EQ(*other->Solve(b, 1e-6, {}), first);
}

TEST_P(SolvedTwice, SolvesForZeroAndForNothing) {
  const Eigen::VectorXd values = assembly_.Combine(0.3);
  ASSERT_TRUE(multigrid_->Factorize(values));
  const Eigen::Index n = dofs_.NumFree();
  EXPECT_EQ(*multigrid_->Solve(Eigen::VectorXd::Zero(n), 1e-6, {}),
            Eigen::MatrixXd(Eigen::VectorXd::Zero(n)));
  EXPECT_EQ(multigrid_->Solve(Eigen::MatrixXd(n, 0), 1e-6, {})->cols(), 0);
}

TEST_P(SolvedTwice, RefusesValuesThatAreNotFinite) {
  Eigen::VectorXd values = assembly_.Combine(0.3);
  values(values.size() / 2) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(multigrid_->Factorize(values));
}

TEST_P(SolvedTwice, SaysWhenItDoesNotConverge) {
  const Eigen::MatrixXd b = RandomMatrix(dofs_.NumFree(), 1, 3);
  // Not positive definite.
  const Eigen::VectorXd bad = assembly_.Combine(1.5);
  if (multigrid_->Factorize(bad)) {
    EXPECT_FALSE(multigrid_->Solve(b, 1e-6, {}));
  }
  const Eigen::VectorXd good = assembly_.Combine(0.3);
  ASSERT_TRUE(multigrid_->Factorize(good));
  EXPECT_TRUE(multigrid_->Solve(b, 1e-6, {}));
}

// Whatever was in the memory that it gets: bytes of all ones, as here, are not
// a number.
TEST_P(SolvedTwice, EndsForAMatrixThatIsNotPositive) {
  mallopt(M_PERTURB, 0x100);
  for (const double nu : {0.7, 1.5, 4.0}) {
    const Eigen::VectorXd values = assembly_.Combine(nu);
    if (multigrid_->Factorize(values)) {
      EXPECT_FALSE(
          multigrid_->Solve(RandomMatrix(dofs_.NumFree(), 1, 3), 1e-6, {}));
    }
  }
  mallopt(M_PERTURB, 0);
}

// Fewer nodes than a coarse space has rigid motions.
TEST(Multigrid, SolvesForOneTetrahedron) {
  Mesh mesh;
  mesh.nodes = Eigen::MatrixXd::Zero(3, 4);
  mesh.nodes.rightCols<3>().setIdentity();
  mesh.elements = Eigen::Vector4i(0, 1, 2, 3);
  Supports supports = {ComponentMask::Constant(3, 4, false),
                       Eigen::MatrixXd::Zero(3, 4)};
  supports.held.leftCols<3>().setConstant(true);
  const DegreesOfFreedom dofs(supports);
  const StiffnessAssembly assembly(mesh, dofs);
  Cholesky cholesky(assembly, dofs);
  if (!HasMultigrid()) {
    GTEST_SKIP() << "built without PETSc";
  }
  const std::unique_ptr<LinearSolver> multigrid =
      MakeMultigrid(mesh, assembly, dofs);
  const Eigen::VectorXd values = assembly.Combine(0.3);
  ASSERT_TRUE(cholesky.Factorize(values));
  ASSERT_TRUE(multigrid->Factorize(values));
  const Eigen::MatrixXd b = Eigen::Vector3d(1, -2, 3);
  EXPECT_TRUE(multigrid->Solve(b, 1e-10, {})
                  ->isApprox(*cholesky.Solve(b, 0, {}), 1e-10));
}

}  // namespace
}  // namespace elastimate
