#include "elastimate/estimators/reduced_model/reduced_equilibrium.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "elastimate/core/equilibrium/equilibrium.h"
#include "elastimate/core/scene/observed_displacements.h"
#include "elastimate/estimators/reduced_model/nearby_solve.h"
#include "tests/regions.h"
#include "tests/scenes.h"

namespace elastimate {
namespace {

// The scene has two regions, displaced supports, three load cases and noise.
class ReducedEquilibriumTest : public ::testing::Test {
 protected:
  static Scene MakeScene() {
    Scene scene = testing::WithThreeForces(
        testing::TwoRegionScene({ElementKind::kTet4, SectionModel::kSolid}));
    testing::DisplaceSupports(scene);
    testing::MeasureByTextbook({{2e3, 0.2}, {5e3, 0.4}}, scene);
    testing::AddNoise(0.1, 1, scene);
    return scene;
  }

  Eigen::VectorXd ModuliOf(const Eigen::Vector4d& parameters) const {
    return full_.Forces().Parameters().Moduli(parameters);
  }

  // Returns u and du/dp of the full model at these parameters, from which a
  // basis is made.
  Eigen::MatrixXd Pole(const Eigen::Vector4d& parameters) {
    EXPECT_TRUE(full_.Solve(ModuliOf(parameters)));
    const Eigen::MatrixXd sensitivities = full_.Sensitivities(
        full_.Forces().Parameters().ModuliJacobian(parameters));
    const Eigen::MatrixXd u = full_.Displacement() - full_.HeldDisplacement();
    Eigen::MatrixXd vectors(u.rows(), 5 * u.cols());
    for (Eigen::Index k = 0; k < u.cols(); ++k) {
      vectors.col(5 * k) = u.col(k);
      vectors.middleCols(5 * k + 1, 4) = sensitivities.middleCols(4 * k, 4);
    }
    return vectors;
  }

  Eigen::VectorXd FullResidual() const {
    return observed_.Restrict(full_.Displacement()) - observed_.Measured();
  }

  Scene scene_ = MakeScene();
  Equilibrium full_ = Equilibrium(scene_, SolverKind::kCholesky);
  ObservedDisplacements observed_ = ObservedDisplacements(scene_);
  ReducedEquilibrium reduced_ = ReducedEquilibrium(full_, observed_);
  const Eigen::Vector4d pole_ = Eigen::Vector4d(2.5e3, 0.25, 4e3, 0.35);
};

TEST_F(ReducedEquilibriumTest, IsExactAtThePoleWithItsDerivatives) {
  const Eigen::MatrixXd vectors = Pole(pole_);
  const Eigen::MatrixXd directions =
      full_.Forces().Parameters().ModuliJacobian(pole_);
  reduced_.Extend(ModuliOf(pole_), vectors);
  ASSERT_TRUE(reduced_.Solve(ModuliOf(pole_)));
  const Eigen::MatrixXd u = full_.Displacement();
  EXPECT_LT((reduced_.Displacement() - u).norm(), 1e-10 * u.norm());
  const Eigen::MatrixXd s = full_.Sensitivities(directions);
  EXPECT_LT((reduced_.DisplacementSensitivities(directions) - s).norm(),
            1e-9 * s.norm());
  // The few rows of the reduced model have the inner products of all rows.
  Eigen::MatrixXd rows(observed_.Size(), 4);
  for (Eigen::Index i = 0; i < 4; ++i) {
    rows.col(i) =
        observed_.Restrict(s(Eigen::all, Eigen::seq(i, Eigen::last, 4)));
  }
  const Eigen::VectorXd residual = FullResidual();
  const Eigen::MatrixXd few = reduced_.Sensitivities(directions);
  EXPECT_LT(few.rows(), 20);
  EXPECT_NEAR(reduced_.Residual().norm() / residual.norm(), 1, 1e-9);
  EXPECT_LT((few.transpose() * few - rows.transpose() * rows).norm(),
            1e-9 * (rows.transpose() * rows).norm());
  EXPECT_LT(
      (few.transpose() * reduced_.Residual() - rows.transpose() * residual)
          .norm(),
      1e-9 * rows.norm() * residual.norm());
}

// The error of Galerkin's displacements grows with the square of the distance
// from the pole.
TEST_F(ReducedEquilibriumTest, MissesTheSquareOfTheDistance) {
  reduced_.Extend(ModuliOf(pole_), Pole(pole_));
  const Eigen::Vector4d direction(5e2, 0.05, -1e3, 0.05);
  const auto error_at = [&](double distance) {
    const Eigen::VectorXd moduli = ModuliOf(pole_ + distance * direction);
    EXPECT_TRUE(full_.Solve(moduli));
    EXPECT_TRUE(reduced_.Solve(moduli));
    return (reduced_.Displacement() - full_.Displacement()).norm() /
           full_.Displacement().norm();
  };
  const double far = error_at(0.2);
  const double near = error_at(0.02);
  EXPECT_GT(far, 1e-7);
  EXPECT_LT(near, far / 30);
}

// The reduced model has u and the adjoint of its residual at these parameters,
// but no derivatives.
TEST_F(ReducedEquilibriumTest, HasTheGradientOfTheFullModelByItsAdjoint) {
  reduced_.Extend(ModuliOf(pole_), Pole(pole_));
  const Eigen::Vector4d other(2e3, 0.1, 6e3, 0.42);
  const Eigen::MatrixXd directions =
      full_.Forces().Parameters().ModuliJacobian(other);
  ASSERT_TRUE(full_.Solve(ModuliOf(other)));
  const Eigen::MatrixXd s = full_.Sensitivities(directions);
  Eigen::Vector4d expected;
  const Eigen::VectorXd residual = FullResidual();
  for (Eigen::Index i = 0; i < 4; ++i) {
    expected(i) =
        observed_.Restrict(s(Eigen::all, Eigen::seq(i, Eigen::last, 4)))
            .dot(residual);
  }
  const auto gradient = [&] {
    EXPECT_TRUE(reduced_.Solve(ModuliOf(other)));
    return Eigen::Vector4d(reduced_.Sensitivities(directions).transpose() *
                           reduced_.Residual());
  };
  EXPECT_GT((gradient() - expected).norm(), 1e-5 * expected.norm());
  const Eigen::MatrixXd u = full_.Displacement() - full_.HeldDisplacement();
  const Eigen::MatrixXd adjoint =
      full_.SolveFor(observed_.RestrictTransposed(residual));
  Eigen::MatrixXd vectors(u.rows(), 2 * u.cols());
  for (Eigen::Index k = 0; k < u.cols(); ++k) {
    vectors.col(2 * k) = u.col(k);
    vectors.col(2 * k + 1) = adjoint.col(k);
  }
  reduced_.Extend(ModuliOf(other), vectors);
  EXPECT_LT((gradient() - expected).norm(), 1e-8 * expected.norm());
  EXPECT_LT((reduced_.Adjoint() - adjoint).norm(), 1e-8 * adjoint.norm());
  EXPECT_NEAR(reduced_.Residual().norm() / residual.norm(), 1, 1e-9);
}

TEST_F(ReducedEquilibriumTest, TakesTheSameVectorsAgain) {
  const Eigen::MatrixXd vectors = Pole(pole_);
  reduced_.Extend(ModuliOf(pole_), vectors);
  const Eigen::Index rows = reduced_.NumRows();
  reduced_.Extend(ModuliOf(pole_), 3 * vectors);
  EXPECT_EQ(reduced_.NumRows(), rows);
  EXPECT_TRUE(reduced_.Solve(ModuliOf(pole_)));
}

TEST_F(ReducedEquilibriumTest, SolvesNearbyByTheFactorAtHand) {
  const Eigen::VectorXd near = ModuliOf({2e3, 0.3, 5e3, 0.3});
  ASSERT_TRUE(full_.Solve(near));
  const Eigen::MatrixXd expected = full_.Displacement();
  ASSERT_TRUE(full_.Solve(ModuliOf(pole_)));
  // The tolerance is in the energy norm of each load case.
  const Eigen::MatrixXd products = full_.Forces().Multiply(near, expected);
  const Eigen::VectorXd energies =
      expected.cwiseProduct(products).colwise().sum().cwiseSqrt().transpose();
  for (const double tolerance : {1e-2, 1e-5, 1e-8}) {
    Eigen::MatrixXd x = full_.HeldDisplacement();
    const std::optional<int> iterations =
        SolveNearby(near, full_.Load(), tolerance * energies, 30, full_, x);
    ASSERT_TRUE(iterations.has_value());
    const Eigen::MatrixXd error = x - expected;
    const Eigen::VectorXd errors =
        error.cwiseProduct(full_.Forces().Multiply(near, error))
            .colwise()
            .sum()
            .cwiseSqrt();
    for (Eigen::Index k = 0; k < errors.size(); ++k) {
      EXPECT_LE(errors(k), tolerance * energies(k)) << tolerance;
    }
  }
  Eigen::MatrixXd x = full_.HeldDisplacement();
  EXPECT_FALSE(SolveNearby(ModuliOf({2e-3, 0.3, 5e3, 0.3}), full_.Load(),
                           1e-8 * energies, 3, full_, x)
                   .has_value());
}

TEST_F(ReducedEquilibriumTest, SolvesNearbyWithOtherRowsHeldAsWell) {
  const Eigen::VectorXd near = ModuliOf({2e3, 0.3, 5e3, 0.3});
  ASSERT_TRUE(full_.Solve(near));
  Eigen::MatrixXd x = full_.Displacement();
  ASSERT_TRUE(full_.Solve(ModuliOf(pole_)));
  const Eigen::MatrixXd forces = full_.Load();
  const Eigen::VectorXd energies =
      x.cwiseProduct(full_.Forces().Multiply(near, x)).colwise().sum();
  // These rows are free, as their neighbours are.
  const int last = static_cast<int>(x.rows()) - 1;
  const std::vector<int> held = {last, last - 4};
  const Eigen::MatrixXd before = x;
  for (const int row : held) {
    ASSERT_GT(x.row(row).norm(), 0);
    x.row(row).setZero();
  }
  ASSERT_TRUE(SolveNearby(near, forces, 1e-9 * energies.cwiseSqrt(), 100, full_,
                          x, held)
                  .has_value());
  EXPECT_GT((x - before).norm(), 1e-3 * before.norm());
  Eigen::MatrixXd rest = forces - full_.Forces().Multiply(near, x);
  for (const int row : held) {
    EXPECT_EQ(x.row(row).norm(), 0);
    EXPECT_GT(rest.row(row).norm(), 1e-3 * forces.norm());
    rest.row(row).setZero();
  }
  for (Eigen::Index row = 0; row < rest.rows(); ++row) {
    if ((before.row(row).array() != full_.HeldDisplacement().row(row).array())
            .any()) {
      EXPECT_LT(rest.row(row).norm(), 1e-6 * forces.norm()) << row;
    }
  }
}

}  // namespace
}  // namespace elastimate
