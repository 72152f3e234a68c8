#include "elastimate/core/solvers/cholesky.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>

#include "tests/core/random_values.h"
#include "tests/dense_reference.h"
#include "tests/scenes.h"

namespace elastimate {
namespace {

using testing::DenseStiffness;
using testing::HookeMatrix;
using testing::RandomMatrix;
using testing::SmallScene;

// A held and distorted mesh, its sparse and its dense stiffness.
class SparseCholesky : public ::testing::Test {
 protected:
  SparseCholesky()
      : scene_(SmallScene("organ")),
        dofs_(HoldSomeMore()),
        assembly_(scene_.mesh, dofs_),
        cholesky_(assembly_, dofs_) {}

  // Single components besides the bottom, so that nodes keep one or two.
  const Supports& HoldSomeMore() {
    scene_.supports.held =
        scene_.supports.held ||
        testing::RandomSupports(scene_.mesh.NumNodes(), 3).held;
    return scene_.supports;
  }

  // H + nu J, through Hooke's law for s = 1.
  Eigen::MatrixXd Dense(double nu) const {
    return DenseStiffness<double>(
        scene_.mesh, HookeMatrix<double>((1 + nu) * (1 - 2 * nu), nu))(
        dofs_.free, dofs_.free);
  }

  // The backward error of a solution is a small multiple of the rounding unit;
  // the condition number makes of it the error of the solution.
  void ExpectSolves(double nu, double scale) {
    const Eigen::MatrixXd dense = Dense(nu);
    const Eigen::VectorXd eigenvalues = testing::SymmetricEigenvalues(dense);
    const double condition =
        eigenvalues(eigenvalues.size() - 1) / eigenvalues(0);
    const Eigen::MatrixXd b = RandomMatrix(dofs_.NumFree(), 4, 1);
    const Eigen::MatrixXd expected = testing::SolveDensely(dense, b) / scale;
    const Eigen::MatrixXd solution = *cholesky_.Solve(b, 0, {});
    EXPECT_LT((solution - expected).norm(),
              1e-15 * condition * 10 * expected.norm())
        << "nu " << nu << ", condition " << condition;
    EXPECT_LT((*cholesky_.Solve(b.col(2), 0, {}) - solution.col(2)).norm(),
              1e-15 * condition * 10 * solution.col(2).norm());
  }

  Scene scene_;
  DegreesOfFreedom dofs_;
  StiffnessAssembly assembly_;
  Cholesky cholesky_;
};

TEST_F(SparseCholesky, SolvesLikeADenseFactorisation) {
  for (const double nu : {-0.9, 0.0, 0.3, 0.49, 0.4999}) {
    ASSERT_TRUE(cholesky_.Factorize(assembly_.Combine(nu))) << nu;
    ExpectSolves(nu, 1);
  }
}

TEST_F(SparseCholesky, DoesNotDependOnUnits) {
  for (const double scale : {1e-130, 1e-12, 1e12, 1e130}) {
    ASSERT_TRUE(cholesky_.Factorize(scale * assembly_.Combine(0.3))) << scale;
    ExpectSolves(0.3, scale);
  }
}

TEST_F(SparseCholesky, SolvesForNoRightHandSide) {
  ASSERT_TRUE(cholesky_.Factorize(assembly_.Combine(0.3)));
  const Eigen::MatrixXd none =
      *cholesky_.Solve(Eigen::MatrixXd(dofs_.NumFree(), 0), 0, {});
  EXPECT_EQ(none.rows(), dofs_.NumFree());
  EXPECT_EQ(none.cols(), 0);
}

TEST_F(SparseCholesky, GivesTheSameBitsAgain) {
  const Eigen::MatrixXd b = RandomMatrix(dofs_.NumFree(), 1, 2);
  ASSERT_TRUE(cholesky_.Factorize(assembly_.Combine(0.3)));
  const Eigen::MatrixXd first = *cholesky_.Solve(b, 0, {});
  ASSERT_TRUE(cholesky_.Factorize(assembly_.Combine(0.4)));
  ASSERT_TRUE(cholesky_.Factorize(assembly_.Combine(0.3)));
  EXPECT_EQ(*cholesky_.Solve(b, 0, {}), first);
}

TEST_F(SparseCholesky, RefusesWhatIsNotPositiveDefiniteAndRecovers) {
  const Eigen::VectorXd good = assembly_.Combine(0.3);
  // Beyond 1/2 the shear modulus is negative.
  for (const Eigen::VectorXd& bad :
       {assembly_.Combine(0.7), assembly_.Combine(2.0), Eigen::VectorXd(-good),
        Eigen::VectorXd(0 * good)}) {
    EXPECT_FALSE(cholesky_.Factorize(bad));
    ASSERT_TRUE(cholesky_.Factorize(good));
    ExpectSolves(0.3, 1);
  }
}

TEST_F(SparseCholesky, RefusesValuesThatAreNotFiniteAndRecovers) {
  const Eigen::VectorXd good = assembly_.Combine(0.3);
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(),
                           std::numeric_limits<double>::infinity()}) {
    for (const Eigen::Index place : {Eigen::Index{0}, good.size() - 1}) {
      Eigen::VectorXd values = good;
      values(place) = bad;
      EXPECT_FALSE(cholesky_.Factorize(values));
      ASSERT_TRUE(cholesky_.Factorize(good));
      ExpectSolves(0.3, 1);
    }
  }
}

// At nu = 1/2, H + nu J resists no change of shape.
TEST_F(SparseCholesky, RefusesWhatIsSingularToWorkingPrecision) {
  EXPECT_FALSE(cholesky_.Factorize(assembly_.Combine(0.5)));
  EXPECT_FALSE(cholesky_.Factorize(assembly_.Combine(std::nextafter(0.5, 0))));
}

TEST_F(SparseCholesky, FactorHoldsAtLeastTheMatrix) {
  EXPECT_GE(cholesky_.FactorValues(),
            static_cast<double>(assembly_.Pattern().row.size()));
}

TEST(Cholesky, OfASingleDegreeOfFreedom) {
  const Scene scene = SmallScene("cuboid");
  Supports supports = scene.supports;
  supports.held.setConstant(true);
  supports.held(1, 20) = false;
  const DegreesOfFreedom dofs(supports);
  const StiffnessAssembly assembly(scene.mesh, dofs);
  Cholesky cholesky(assembly, dofs);
  ASSERT_TRUE(cholesky.Factorize(assembly.H()));
  const Eigen::MatrixXd b = Eigen::MatrixXd::Constant(1, 1, 3.0);
  EXPECT_NEAR((*cholesky.Solve(b, 0, {}))(0), 3 / assembly.H()(0), 1e-14);
}

}  // namespace
}  // namespace elastimate
