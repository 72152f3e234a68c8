#include "elastimate/core/equilibrium/equilibrium.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <string>

#include "elastimate/core/scene/degrees_of_freedom.h"
#include "elastimate/core/scene/loads.h"
#include "elastimate/core/scene/rigid_motion.h"
#include "tests/regions.h"

namespace elastimate {
namespace {

using testing::KindOfSection;

class EquilibriumOfKinds : public ::testing::TestWithParam<KindOfSection> {
 protected:
  EquilibriumOfKinds() {
    // Two load cases, and a support that moves.
    scene_.load_cases.push_back(scene_.load_cases[0]);
    BodyForce weight;
    weight.force_density =
        Eigen::VectorXd::LinSpaced(scene_.mesh.Dimension(), -0.3, 0.5);
    scene_.load_cases[1].loads = {weight};
    testing::DisplaceSupports(scene_);
  }

  Scene scene_ = testing::TwoRegionScene(GetParam());
  Eigen::Vector4d parameters_{2, 0.1, 5, 0.4};
};

TEST_P(EquilibriumOfKinds, IsThatOfTheTextbook) {
  const Eigen::MatrixXd expected =
      testing::SolveByTextbook(scene_, {{2, 0.1}, {5, 0.4}});
  Equilibrium equilibrium(scene_, SolverKind::kCholesky);
  const MaterialParameters& chart = equilibrium.Forces().Parameters();
  ASSERT_TRUE(equilibrium.Solve(chart.Moduli(parameters_)));
  EXPECT_LT((equilibrium.Displacement() - expected).norm(),
            1e-10 * expected.norm());
}

TEST_P(EquilibriumOfKinds, HasItsSensitivities) {
  Equilibrium equilibrium(scene_, SolverKind::kCholesky);
  const MaterialParameters& chart = equilibrium.Forces().Parameters();
  ASSERT_TRUE(equilibrium.Solve(chart.Moduli(parameters_)));
  const Eigen::MatrixXd sensitivities =
      equilibrium.Sensitivities(chart.ModuliJacobian(parameters_));
  for (Eigen::Index i = 0; i < 4; ++i) {
    const double step = 1e-6 * parameters_(i);
    Eigen::Vector4d changed = parameters_;
    changed(i) += step;
    ASSERT_TRUE(equilibrium.Solve(chart.Moduli(changed)));
    Eigen::MatrixXd slope = equilibrium.Displacement();
    changed(i) -= 2 * step;
    ASSERT_TRUE(equilibrium.Solve(chart.Moduli(changed)));
    slope = (slope - equilibrium.Displacement()) / (2 * step);
    for (Eigen::Index k = 0; k < 2; ++k) {
      EXPECT_LT((slope.col(k) - sensitivities.col(4 * k + i)).norm(),
                1e-6 * slope.norm());
    }
  }
}

// The second load case is held at one more node; the third is held where the
// first is, but moved otherwise.
TEST_P(EquilibriumOfKinds, HasTheSupportsOfEachLoadCase) {
  scene_.load_cases.push_back(scene_.load_cases[0]);
  Supports other = scene_.supports;
  const Eigen::Index last = scene_.mesh.NumNodes() - 1;
  other.held.col(last).setConstant(true);
  other.displacement.col(last).setConstant(0.01);
  scene_.load_cases[1].supports = other;
  other = scene_.supports;
  other.displacement *= -2;
  scene_.load_cases[2].supports = other;
  scene_.is_rigid_motion_free = true;
  Equilibrium equilibrium(scene_, SolverKind::kCholesky);
  const MaterialParameters& chart = equilibrium.Forces().Parameters();
  const Eigen::VectorXd moduli = chart.Moduli(parameters_);
  ASSERT_TRUE(equilibrium.Solve(moduli));
  EXPECT_EQ(equilibrium.WorkDone().factorizations, 2);
  const Eigen::MatrixXd directions = chart.ModuliJacobian(parameters_);
  const Eigen::MatrixXd slopes = equilibrium.Sensitivities(directions);
  const Eigen::MatrixXd values =
      Eigen::MatrixXd::Random(scene_.mesh.NumDofs(), 3);
  const Eigen::MatrixXd extended = equilibrium.Extend(OfHeld(scene_, values));
  for (Eigen::Index k = 0; k < 3; ++k) {
    Scene alone = scene_;
    alone.supports = SupportsOf(scene_, k);
    alone.load_cases = {scene_.load_cases[k]};
    alone.load_cases[0].supports.reset();
    Equilibrium of_case(alone, SolverKind::kCholesky);
    ASSERT_TRUE(of_case.Solve(moduli));
    const double scale = of_case.Displacement().norm();
    EXPECT_LT((equilibrium.Displacement().col(k) -
               testing::SolveByTextbook(alone, {{2, 0.1}, {5, 0.4}}))
                  .norm(),
              1e-10 * scale);
    EXPECT_LT(
        (equilibrium.SupportForces().col(k) - of_case.SupportForces()).norm(),
        1e-10 * of_case.SupportForces().norm());
    const Eigen::MatrixXd expected = of_case.Sensitivities(directions);
    EXPECT_LT((slopes.middleCols(4 * k, 4) - expected).norm(),
              1e-10 * expected.norm());
    const Eigen::MatrixXd held = OfHeld(alone, values.col(k));
    EXPECT_LT((extended.col(k) - of_case.Extend(held)).norm(),
              1e-10 * held.norm());
    EXPECT_LT((equilibrium.ExtendInCase(k, held) - of_case.Extend(held)).norm(),
              1e-10 * held.norm());
  }
}

// Returns random values in held rows, and zeros in free rows.
Eigen::MatrixXd RandomOfHeld(const Scene& scene, Eigen::Index columns) {
  Eigen::MatrixXd values =
      Eigen::MatrixXd::Random(scene.mesh.NumDofs(), columns);
  for (Eigen::Index dof = 0; dof < values.rows(); ++dof) {
    if (!scene.supports.held.reshaped()(dof)) {
      values.row(dof).setZero();
    }
  }
  return values;
}

TEST_P(EquilibriumOfKinds, ExtendsMotionsOfItsSupports) {
  scene_.supports.unknown = scene_.supports.held;
  Equilibrium equilibrium(scene_, SolverKind::kCholesky);
  ASSERT_TRUE(
      equilibrium.Solve(equilibrium.Forces().Parameters().Moduli(parameters_)));
  const Eigen::MatrixXd held = RandomOfHeld(scene_, 2);
  Scene moved = scene_;
  for (LoadCase& load_case : moved.load_cases) {
    load_case.loads.clear();
  }
  moved.supports.displacement =
      held.col(0).reshaped(moved.mesh.Dimension(), moved.mesh.NumNodes());
  const Eigen::VectorXd expected =
      testing::SolveByTextbook(moved, {{2, 0.1}, {5, 0.4}}).col(0);
  const Eigen::MatrixXd extended = equilibrium.Extend(held);
  EXPECT_LT((extended.col(0) - expected).norm(), 1e-10 * expected.norm());
  const Eigen::MatrixXd values =
      Eigen::MatrixXd::Random(held.rows(), held.cols());
  const Eigen::MatrixXd transposed = equilibrium.ExtendTransposed(values);
  EXPECT_NEAR((extended.transpose() * values)(0, 1),
              (held.transpose() * transposed)(0, 1), 1e-10 * held.norm());
  EXPECT_NEAR(
      (equilibrium.HeldForces(values).transpose() * held)(0, 1),
      (values.transpose() * equilibrium.HeldForcesTransposed(held))(0, 1),
      1e-10 * held.norm());
}

TEST_P(EquilibriumOfKinds, HasForcesOfSupportsThatBalanceTheLoads) {
  scene_.supports.unknown = scene_.supports.held;
  Equilibrium equilibrium(scene_, SolverKind::kCholesky);
  const MaterialParameters& chart = equilibrium.Forces().Parameters();
  ASSERT_TRUE(equilibrium.Solve(chart.Moduli(parameters_)));
  ASSERT_TRUE(equilibrium.MoveSupports(1e-3 * RandomOfHeld(scene_, 2)));
  const Eigen::MatrixXd forces = equilibrium.SupportForces();
  const Eigen::MatrixXd loads = AssembleLoadCases(scene_);
  const int dimension = scene_.mesh.Dimension();
  for (Eigen::Index k = 0; k < 2; ++k) {
    const Eigen::VectorXd sum = (forces + loads)
                                    .col(k)
                                    .reshaped(dimension, scene_.mesh.NumNodes())
                                    .rowwise()
                                    .sum();
    EXPECT_LT(sum.norm(), 1e-9 * (loads.col(k).norm() + forces.norm()));
  }
  const Eigen::MatrixXd directions = chart.ModuliJacobian(parameters_);
  const Eigen::MatrixXd slopes = equilibrium.SupportForceSensitivities(
      directions, equilibrium.Sensitivities(directions));
  // Along all parameters at once: moduli that grow alike scale the forces
  // of motions, and leave those of loads.
  const Eigen::VectorXd growth = Eigen::Vector4d(2, 0, 5, 0);
  Scene without_loads = scene_;
  for (LoadCase& load_case : without_loads.load_cases) {
    load_case.loads.clear();
  }
  Equilibrium of_motion(without_loads, SolverKind::kCholesky);
  ASSERT_TRUE(of_motion.Solve(chart.Moduli(parameters_)));
  ASSERT_TRUE(
      of_motion.MoveSupports(OfHeld(scene_, equilibrium.Displacement()) -
                             equilibrium.HeldDisplacement()));
  const Eigen::MatrixXd expected = of_motion.SupportForces();
  for (Eigen::Index k = 0; k < 2; ++k) {
    const Eigen::VectorXd slope = slopes.middleCols(4 * k, 4) * growth;
    EXPECT_LT((slope - expected.col(k)).norm(), 1e-7 * forces.norm());
  }
}

TEST_P(EquilibriumOfKinds, RefusesAStiffnessThatIsNotPositive) {
  Equilibrium equilibrium(scene_, SolverKind::kCholesky);
  const MaterialParameters& chart = equilibrium.Forces().Parameters();
  for (const Eigen::Vector4d& bad :
       {Eigen::Vector4d(2, 0.1, -5, 0.4), Eigen::Vector4d(2, 0.1, 5, -1.5),
        Eigen::Vector4d(2, 0.1, 5, 1.5), Eigen::Vector4d(2, 0.1, 5, NAN),
        Eigen::Vector4d(2, 0.1, INFINITY, 0.4)}) {
    EXPECT_FALSE(equilibrium.Solve(chart.Moduli(bad))) << bad.transpose();
    EXPECT_TRUE(equilibrium.Solve(chart.Moduli(parameters_)));
  }
}

TEST_P(EquilibriumOfKinds, HoldsTheHeldDegreesOfFreedomExactly) {
  Equilibrium equilibrium(scene_, SolverKind::kCholesky);
  const MaterialParameters& chart = equilibrium.Forces().Parameters();
  ASSERT_TRUE(equilibrium.Solve(chart.Moduli(parameters_)));
  EXPECT_EQ(OfHeld(scene_, equilibrium.Displacement()),
            equilibrium.HeldDisplacement());
  const Eigen::MatrixXd slopes =
      equilibrium.Sensitivities(chart.ModuliJacobian(parameters_));
  EXPECT_TRUE(OfHeld(scene_, slopes(Eigen::all, {0, 4})).isZero(0));
}

void ExpectWork(const Equilibrium& model, int passes, int factorizations,
                int solves) {
  EXPECT_EQ(model.WorkDone().element_passes, passes);
  EXPECT_EQ(model.WorkDone().factorizations, factorizations);
  EXPECT_EQ(model.WorkDone().solves, solves);
}

// One pass is for the displaced supports, another one for the pattern.
TEST_P(EquilibriumOfKinds, CountsItsWork) {
  Equilibrium equilibrium(scene_, SolverKind::kCholesky);
  const MaterialParameters& chart = equilibrium.Forces().Parameters();
  ASSERT_TRUE(equilibrium.Solve(chart.Moduli(parameters_)));
  ExpectWork(equilibrium, 3, 1, 3);
  (void)equilibrium.Sensitivities(chart.ModuliJacobian(parameters_));
  ExpectWork(equilibrium, 5, 1, 3 + 2 * 4);
}

// To ask again costs no solve, and other directions, moduli or supports never
// get the kept sensitivities.
TEST_P(EquilibriumOfKinds, SolvesForSensitivitiesOnce) {
  scene_.supports.unknown = scene_.supports.held;
  Equilibrium equilibrium(scene_, SolverKind::kCholesky);
  const MaterialParameters& chart = equilibrium.Forces().Parameters();
  const Eigen::MatrixXd directions = chart.ModuliJacobian(parameters_);
  const Eigen::VectorXd moduli = chart.Moduli(parameters_);
  ASSERT_TRUE(equilibrium.Solve(moduli));
  const Eigen::MatrixXd first = equilibrium.Sensitivities(directions);
  const int solves = equilibrium.WorkDone().solves;
  EXPECT_EQ(equilibrium.Sensitivities(directions), first);
  EXPECT_EQ(equilibrium.WorkDone().solves, solves);
  const auto expect_those_of_another_model = [&](const Eigen::MatrixXd& of,
                                                 const Eigen::VectorXd& at,
                                                 const Eigen::MatrixXd& held) {
    Equilibrium other(scene_, SolverKind::kCholesky);
    ASSERT_TRUE(other.Solve(at) && other.MoveSupports(held));
    const Eigen::MatrixXd expected = other.Sensitivities(of);
    EXPECT_GT((expected - first).norm(), 1e-3 * expected.norm());
    EXPECT_LT((equilibrium.Sensitivities(of) - expected).norm(),
              1e-10 * expected.norm());
  };
  Eigen::MatrixXd held = Eigen::MatrixXd::Zero(first.rows(), 2);
  expect_those_of_another_model(2 * directions, moduli, held);
  ASSERT_EQ(equilibrium.Sensitivities(directions), first);
  EXPECT_EQ(equilibrium.Sensitivities(directions.leftCols(2)).cols(),
            2 * Eigen::Index(scene_.load_cases.size()));
  EXPECT_EQ(equilibrium.Sensitivities(directions).cols(), first.cols());
  ASSERT_TRUE(equilibrium.Solve(3 * moduli));
  expect_those_of_another_model(directions, 3 * moduli, held);
  held = RandomOfHeld(scene_, 2);
  ASSERT_TRUE(equilibrium.MoveSupports(held));
  expect_those_of_another_model(directions, 3 * moduli, held);
}

TEST(Equilibrium, SaysWhyTheSupportsDoNotHold) {
  Scene scene =
      testing::SceneOfKind({ElementKind::kTet4, SectionModel::kSolid});
  scene.supports.held.row(0).setConstant(false);
  const std::string why = WhyNotHeld(scene.mesh, scene.supports);
  EXPECT_THAT(why, ::testing::HasSubstr("move along x"));
  EXPECT_THAT([&] { (void)DisplacementsAt(scene, Eigen::Vector2d(1, 0.3)); },
              ::testing::ThrowsMessage<std::invalid_argument>(why));
}

INSTANTIATE_TEST_SUITE_P(Kinds, EquilibriumOfKinds,
                         ::testing::ValuesIn(testing::AllKindsOfSections()),
                         testing::KindTestName);

}  // namespace
}  // namespace elastimate
