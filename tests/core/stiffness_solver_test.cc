#include "elastimate/core/stiffness_solver.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/core/random_values.h"
#include "tests/dense_reference.h"
#include "tests/scenes.h"
#include "tests/throws.h"

namespace elastimate {
namespace {

using testing::DenseDH;
using testing::DenseDJ;
using testing::DenseStiffness;
using testing::RandomMatrix;
using testing::SmallScene;

TEST(StiffnessSolver, SolvesOnTheFreeDegreesOfFreedom) {
  const Scene scene = SmallScene("organ");
  StiffnessSolver solver(scene.mesh, scene.supports);
  const auto& free = solver.Dofs().free;
  const Eigen::MatrixXd forces = RandomMatrix(3 * scene.mesh.NumNodes(), 3, 1);
  for (const double nu : {-0.5, 0.3, 0.45}) {
    ASSERT_TRUE(solver.Factorize(nu));
    EXPECT_EQ(solver.PoissonRatio(), nu);
    const Eigen::MatrixXd dense =
        DenseStiffness<double>(scene.mesh, DenseDH() + nu * DenseDJ());
    Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(forces.rows(), 3);
    const Eigen::MatrixXd free_forces = forces(free, Eigen::all);
    const Eigen::MatrixXd solution =
        dense(free, free).ldlt().solve(free_forces);
    expected(free, Eigen::all) = solution;
    EXPECT_LE((solver.Solve(forces) - expected).norm(),
              1e-10 * expected.norm());
  }
}

TEST(StiffnessSolver, CountsItsWorkAndDoesNoneTwice) {
  const Scene scene = SmallScene("cuboid");
  StiffnessSolver solver(scene.mesh, scene.supports);
  EXPECT_TRUE(std::isnan(solver.PoissonRatio()));
  EXPECT_EQ(solver.WorkDone().element_passes, 1);
  EXPECT_EQ(solver.WorkDone().factorizations, 0);
  ASSERT_TRUE(solver.Factorize(0.3));
  ASSERT_TRUE(solver.Factorize(0.3));
  solver.Solve(Eigen::MatrixXd::Ones(3 * scene.mesh.NumNodes(), 4));
  EXPECT_EQ(solver.WorkDone().element_passes, 1);
  EXPECT_EQ(solver.WorkDone().factorizations, 1);
  EXPECT_EQ(solver.WorkDone().solves, 4);
}

TEST(StiffnessSolver, SaysWhereTheStiffnessIsSingular) {
  const Scene scene = SmallScene("cuboid");
  StiffnessSolver solver(scene.mesh, scene.supports);
  ASSERT_TRUE(solver.Factorize(0.3));
  EXPECT_FALSE(solver.Factorize(-1));
  EXPECT_TRUE(std::isnan(solver.PoissonRatio()));
  EXPECT_TRUE(solver.Factorize(0.3));
}

TEST(StiffnessSolver, ThrowsWhereNothingHoldsTheSpecimen) {
  Scene scene = SmallScene("cuboid");
  scene.supports.held.setConstant(false);
  EXPECT_THROWS_WITH(StiffnessSolver(scene.mesh, scene.supports), "hold");
}

}  // namespace
}  // namespace elastimate
