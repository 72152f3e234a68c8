#include "elastimate/core/solvers/stiffness_solver.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "elastimate/core/mechanics/internal_forces.h"
#include "elastimate/core/scene/loads.h"
#include "elastimate/core/scene/quadratic_scene.h"
#include "tests/core/random_values.h"
#include "tests/dense_reference.h"
#include "tests/scenes.h"
#include "tests/throws.h"

namespace elastimate {
namespace {

using testing::BoxMesh;
using testing::DenseDH;
using testing::DenseDJ;
using testing::DenseStiffness;
using ::testing::HasSubstr;
using testing::HeldAtBottom;
using testing::RandomMatrix;
using testing::SmallScene;

std::vector<SolverKind> KindsThereAre() {
  return HasMultigrid() ? std::vector<SolverKind>{SolverKind::kCholesky,
                                                  SolverKind::kMultigrid}
                        : std::vector<SolverKind>{SolverKind::kCholesky};
}

TEST(StiffnessSolver, SolvesOnTheFreeDegreesOfFreedom) {
  const Scene scene = SmallScene("organ");
  StiffnessSolver solver(scene.mesh, scene.supports, SolverKind::kCholesky);
  const auto& free = solver.Dofs().free;
  const Eigen::MatrixXd forces = RandomMatrix(3 * scene.mesh.NumNodes(), 3, 1);
  for (const double nu : {-0.5, 0.3, 0.45}) {
    ASSERT_TRUE(solver.Factorize(nu));
    EXPECT_EQ(solver.PoissonRatio(), nu);
    const Eigen::MatrixXd dense =
        DenseStiffness<double>(scene.mesh, DenseDH() + nu * DenseDJ());
    Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(forces.rows(), 3);
    expected(free, Eigen::all) =
        testing::SolveDensely(dense(free, free), forces(free, Eigen::all));
    EXPECT_LE((solver.Solve(forces) - expected).norm(),
              1e-10 * expected.norm());
  }
}

TEST(StiffnessSolver, CountsItsWorkAndDoesNoneTwice) {
  const Scene scene = SmallScene("cuboid");
  StiffnessSolver solver(scene.mesh, scene.supports, SolverKind::kCholesky);
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

TEST(StiffnessSolver, SharesMemoryInTurns) {
  const Scene scene = SmallScene("organ");
  const Eigen::MatrixXd forces = RandomMatrix(3 * scene.mesh.NumNodes(), 2, 1);
  for (const SolverKind kind : KindsThereAre()) {
    StiffnessSolver first(scene.mesh, scene.supports, kind);
    StiffnessSolver second = first.Sharing();
    const InternalForces of_mesh(scene.mesh, {});
    const auto make_blocks = [&] {
      return of_mesh.Blocks(
          of_mesh.Parameters().Moduli(Eigen::Vector2d(3, 0.4)), second.Graph());
    };
    StiffnessSolver alone(scene.mesh, scene.supports, kind);
    ASSERT_TRUE(alone.Factorize(0.1));
    const Eigen::MatrixXd of_first = alone.Solve(forces);
    ASSERT_TRUE(alone.FactorizeBlocks(make_blocks()));
    const Eigen::MatrixXd of_second = alone.Solve(forces);
    ASSERT_FALSE(of_first.isApprox(of_second, 0.1));

    ASSERT_TRUE(first.Factorize(0.1));
    ASSERT_TRUE(second.FactorizeBlocks(make_blocks));
    for (int turn = 0; turn < 2; ++turn) {
      EXPECT_TRUE(first.Solve(forces).isApprox(of_first, 1e-6));
      EXPECT_EQ(first.PoissonRatio(), 0.1);
      EXPECT_TRUE(second.Solve(forces).isApprox(of_second, 1e-6));
    }
    ASSERT_TRUE(second.Factorize(0.1));
    EXPECT_TRUE(second.Solve(forces).isApprox(of_first, 1e-6));
    EXPECT_EQ(first.WorkDone().solves, 4);
    EXPECT_EQ(second.WorkDone().solves, 6);
    if (kind == SolverKind::kCholesky) {
      EXPECT_EQ(first.WorkDone().factorizations, 3);
      EXPECT_EQ(second.WorkDone().factorizations, 4);
    } else {
      EXPECT_EQ(second.WorkDone().multigrid_set_ups, 0);
    }
  }
}

TEST(StiffnessSolver, SolvesAgainAfterItKeptThePreconditionerAlone) {
  const Scene scene = SmallScene("organ");
  const Eigen::MatrixXd forces = RandomMatrix(3 * scene.mesh.NumNodes(), 2, 1);
  for (const SolverKind kind : KindsThereAre()) {
    StiffnessSolver solver(scene.mesh, scene.supports, kind);
    ASSERT_TRUE(solver.Factorize(0.3));
    const Eigen::MatrixXd solution = solver.Solve(forces);
    const Eigen::MatrixXd cycle = solver.Precondition(forces);
    solver.KeepPreconditioner();
    EXPECT_TRUE(solver.Precondition(forces).isApprox(cycle, 1e-12));
    EXPECT_TRUE(solver.Solve(forces).isApprox(solution, 1e-6));
    solver.KeepPreconditioner();
    solver.Renew();
    EXPECT_TRUE(solver.Solve(forces).isApprox(solution, 1e-6));
  }
}

TEST(StiffnessSolver, TellsWhatItHolds) {
  const Scene scene = SmallScene("organ");
  const StiffnessSolver solver(scene.mesh, scene.supports,
                               SolverKind::kCholesky);
  EXPECT_TRUE(solver.Holds(scene.supports));
  Supports others = scene.supports;
  others.held(0, 0) = !others.held(0, 0);
  EXPECT_FALSE(solver.Holds(others));
}

TEST(StiffnessSolver, SaysWhereTheStiffnessIsSingular) {
  const Scene scene = SmallScene("cuboid");
  StiffnessSolver solver(scene.mesh, scene.supports, SolverKind::kCholesky);
  ASSERT_TRUE(solver.Factorize(0.3));
  EXPECT_FALSE(solver.Factorize(-1));
  EXPECT_TRUE(std::isnan(solver.PoissonRatio()));
  EXPECT_TRUE(solver.Factorize(0.3));
}

TEST(StiffnessSolver, FactorisesWhatAFactorisationIsBestFor) {
  const Mesh plate = BoxMesh({80, 80, 1}, {1, 1, 0.1});
  const Scene scene = HeldAtBottom(plate, plate, Eigen::Vector3d::Zero());
  const StiffnessSolver solver(scene.mesh, scene.supports,
                               SolverKind::kAutomatic);
  EXPECT_FALSE(solver.UsesMultigrid());
  EXPECT_EQ(solver.Notice(), "");
}

TEST(StiffnessSolver, ChoosesMultigridForALargeBodyOrSaysWhyNot) {
  const Mesh cube = BoxMesh({40, 40, 40}, {1, 1, 1});
  const Scene scene = HeldAtBottom(cube, cube, Eigen::Vector3d::Zero());
  const StiffnessSolver solver(scene.mesh, scene.supports,
                               SolverKind::kAutomatic);
  EXPECT_EQ(solver.UsesMultigrid(), HasMultigrid());
  EXPECT_THAT(solver.Notice(), HasSubstr(HasMultigrid() ? "" : "PETSc"));
  EXPECT_EQ(solver.Notice().empty(), HasMultigrid());
  EXPECT_FALSE(
      StiffnessSolver(scene.mesh, scene.supports, SolverKind::kCholesky)
          .UsesMultigrid());
}

// The number of iterations grows with 1 / (1 - 2 nu).
TEST(StiffnessSolver, FactorisesWhereMultigridDoesNotConverge) {
  if (!HasMultigrid()) {
    GTEST_SKIP() << "built without PETSc";
  }
  const Mesh cube = BoxMesh({6, 6, 6}, {1, 1, 1});
  const Scene scene = HeldAtBottom(cube, cube, {0, 0, 1});
  const Eigen::MatrixXd force = AssembleLoadCases(scene);
  StiffnessSolver direct(scene.mesh, scene.supports, SolverKind::kCholesky);
  StiffnessSolver solver(scene.mesh, scene.supports, SolverKind::kMultigrid);
  ASSERT_TRUE(solver.Factorize(0.3));
  solver.Solve(force);
  EXPECT_TRUE(solver.UsesMultigrid());
  EXPECT_EQ(solver.Notice(), "");
  EXPECT_EQ(solver.WorkDone().factorizations, 0);
  EXPECT_EQ(solver.WorkDone().multigrid_set_ups, 1);

  constexpr double kNearlyIncompressible = 0.49999999;
  ASSERT_TRUE(direct.Factorize(kNearlyIncompressible));
  ASSERT_TRUE(solver.Factorize(kNearlyIncompressible));
  // One assembles A(nu) from its bases, the other at once; that nu makes of
  // their rounding about this.
  constexpr double kRounding = 1e-6;
  EXPECT_TRUE(solver.Solve(force).isApprox(direct.Solve(force), kRounding));
  EXPECT_EQ(solver.PoissonRatio(), kNearlyIncompressible);
  EXPECT_FALSE(solver.UsesMultigrid());
  EXPECT_THAT(solver.Notice(),
              HasSubstr("did not converge at nu = 0.49999999"));
  EXPECT_EQ(solver.WorkDone().factorizations, 1);
  ASSERT_TRUE(solver.Factorize(0.4));
  EXPECT_EQ(solver.WorkDone().factorizations, 2);
  EXPECT_EQ(solver.WorkDone().multigrid_set_ups, 2);
}

// Two tetrahedra of random shape, the first of which is held, that share an
// edge and turn about it, or a node.  Rounding decides what the elimination
// leaves of the last pivot; it must not decide here.
TEST(StiffnessSolver, ThrowsForAMechanismOfAnyShape) {
  constexpr int kSeeds = 500;
  Mesh hinged;
  hinged.nodes.resize(3, 6);
  hinged.nodes << 0, 0, 1, 0, -1, 0.1,  //
      0, 0, 0.2, 1, 0.3, -1,            //
      0, 1, 0.3, 0.4, 0.5, 0.6;
  hinged.elements.resize(4, 2);
  hinged.elements << 0, 0, 1, 1, 2, 4, 3, 5;
  Mesh pinned = hinged;
  pinned.nodes.conservativeResize(3, 7);
  pinned.nodes.col(6) << -0.2, 0.1, -1;
  pinned.elements(1, 1) = 6;
  for (const Mesh& shape : {hinged, pinned}) {
    Supports supports{ComponentMask::Constant(3, shape.NumNodes(), false),
                      Eigen::MatrixXd::Zero(3, shape.NumNodes())};
    supports.held.leftCols(4).setConstant(true);
    for (int seed = 0; seed < kSeeds; ++seed) {
      SCOPED_TRACE(seed);
      Mesh mesh = shape;
      mesh.nodes += 0.3 * RandomMatrix(3, mesh.NumNodes(), seed);
      EXPECT_THROWS_WITH(StiffnessSolver(mesh, supports, SolverKind::kCholesky),
                         "rotate about .* without strain");
      Supports enough = supports;
      enough.held.leftCols(mesh.NumNodes() - 1).setConstant(true);
      EXPECT_TRUE(
          StiffnessSolver(mesh, enough, SolverKind::kCholesky).Factorize(0.3));
    }
  }
}

// Plates a thousandth as thick as wide, held at one edge: ill-conditioned and
// well posed.
TEST(StiffnessSolver, FactorisesThinPlatesNextToIncompressibility) {
  for (const int cells : {6, 12}) {
    const Mesh plate = BoxMesh({cells, cells, 1}, {1, 1, 1e-3});
    Scene scene = HeldAtBottom(plate, plate, Eigen::Vector3d::Zero());
    scene.supports.held = (plate.nodes.row(0).array() == 0).replicate<3, 1>();
    for (const int order : {1, 2}) {
      const Scene modelled = order == 1 ? scene : QuadraticScene(scene);
      StiffnessSolver solver(modelled.mesh, modelled.supports,
                             SolverKind::kCholesky);
      for (const double nu : {-0.9, 0.0, 0.3, 0.49, 0.4999}) {
        EXPECT_TRUE(solver.Factorize(nu))
            << cells << " cells, order " << order << ", nu " << nu;
      }
    }
  }
}

TEST(StiffnessSolver, ThrowsWhereNothingHoldsTheSpecimen) {
  Scene scene = SmallScene("cuboid");
  scene.supports.held.setConstant(false);
  EXPECT_THROWS_WITH(
      StiffnessSolver(scene.mesh, scene.supports, SolverKind::kAutomatic),
      "hold");
}

}  // namespace
}  // namespace elastimate
