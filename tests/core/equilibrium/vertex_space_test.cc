#include "elastimate/core/equilibrium/vertex_space.h"

#include <gtest/gtest.h>

#include <vector>

#include "elastimate/core/equilibrium/equilibrium.h"
#include "elastimate/core/scene/finer_scene.h"
#include "elastimate/core/solvers/multigrid.h"
#include "tests/core/random_values.h"
#include "tests/regions.h"
#include "tests/scenes.h"

namespace elastimate {
namespace {

using testing::KindOfSection;

class VertexSpaceOfKinds : public ::testing::TestWithParam<KindOfSection> {
 protected:
  VertexSpaceOfKinds() {
    Scene linear = testing::TwoRegionScene(GetParam(), 2);
    linear.load_cases.push_back(linear.load_cases[0]);
    testing::DisplaceSupports(linear);
    Supports other = linear.supports;
    other.held.rightCols<1>().setConstant(true);
    linear.load_cases[1].supports = other;
    scene_ = FinerScene(linear);
  }

  Scene scene_;
};

TEST_P(VertexSpaceOfKinds, HasTheSpecimenWithLinearElements) {
  if (!HasMultigrid()) {
    GTEST_SKIP() << "built without PETSc";
  }
  const auto space = VertexSpaceToSolveBy(scene_, SolverKind::kMultigrid);
  ASSERT_TRUE(space);
  ValidateScene(space->scene);
  EXPECT_EQ(space->scene.mesh.Order(), 1);
  EXPECT_EQ(space->scene.mesh.NumNodes(), scene_.mesh.NumVertices());
  EXPECT_EQ(space->scene.mesh.regions, scene_.mesh.regions);
  EXPECT_TRUE(space->solver.UsesMultigrid());
}

TEST_P(VertexSpaceOfKinds, SolvesForWhatAFactorSolvesFor) {
  if (!HasMultigrid()) {
    GTEST_SKIP() << "built without PETSc";
  }
  Equilibrium iterated(scene_, SolverKind::kMultigrid);
  Equilibrium direct(scene_, SolverKind::kCholesky);
  EXPECT_TRUE(iterated.IsRefined());
  EXPECT_FALSE(direct.IsRefined());
  const MaterialParameters& chart = direct.Forces().Parameters();
  const Eigen::Vector4d parameters(2, 0.1, 5, 0.4);
  ASSERT_TRUE(iterated.Solve(chart.Moduli(parameters)));
  ASSERT_TRUE(direct.Solve(chart.Moduli(parameters)));
  EXPECT_EQ(iterated.WorkDone().factorizations, 0);
  EXPECT_TRUE(iterated.Displacement().isApprox(direct.Displacement(), 1e-6));
  const Eigen::MatrixXd directions = chart.ModuliJacobian(parameters);
  EXPECT_TRUE(iterated.Sensitivities(directions)
                  .isApprox(direct.Sensitivities(directions), 1e-6));
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, VertexSpaceOfKinds,
    ::testing::Values(
        KindOfSection{ElementKind::kTet4, SectionModel::kSolid},
        KindOfSection{ElementKind::kHex8, SectionModel::kSolid},
        KindOfSection{ElementKind::kTri3, SectionModel::kPlaneStress},
        KindOfSection{ElementKind::kQuad4, SectionModel::kPlaneStrain}),
    [](const auto& info) { return testing::NameOf(info.param); });

class VertexSpaceOfTetrahedra : public ::testing::Test {
 protected:
  VertexSpaceOfTetrahedra()
      : linear_(testing::TwoRegionScene(
            {ElementKind::kTet4, SectionModel::kSolid}, 2)),
        quadratic_(FinerScene(linear_)) {}

  Scene linear_;
  Scene quadratic_;
};

TEST_F(VertexSpaceOfTetrahedra, IsNotTakenWhereFactorsAreBetter) {
  EXPECT_FALSE(VertexSpaceToSolveBy(quadratic_, SolverKind::kAutomatic));
  EXPECT_FALSE(VertexSpaceToSolveBy(quadratic_, SolverKind::kCholesky));
}

TEST_F(VertexSpaceOfTetrahedra, IsNotTakenWhereThereIsNone) {
  if (!HasMultigrid()) {
    GTEST_SKIP() << "built without PETSc";
  }
  EXPECT_FALSE(VertexSpaceToSolveBy(linear_, SolverKind::kMultigrid));
  Scene curved = quadratic_;
  curved.mesh.kind = CurvedKind(curved.mesh.kind);
  EXPECT_FALSE(VertexSpaceToSolveBy(curved, SolverKind::kMultigrid));
  Scene floating = quadratic_;
  floating.load_cases.clear();
  EXPECT_FALSE(VertexSpaceToSolveBy(floating, SolverKind::kMultigrid));
}

TEST_F(VertexSpaceOfTetrahedra, IsNotTakenWhereMiddleNodesAloneAreHeld) {
  if (!HasMultigrid()) {
    GTEST_SKIP() << "built without PETSc";
  }
  ASSERT_TRUE(VertexSpaceToSolveBy(quadratic_, SolverKind::kMultigrid));
  quadratic_.supports.held.leftCols(linear_.mesh.NumNodes()).setConstant(false);
  EXPECT_FALSE(VertexSpaceToSolveBy(quadratic_, SolverKind::kMultigrid));
  Equilibrium model(quadratic_, SolverKind::kMultigrid);
  EXPECT_TRUE(model.Solve(
      model.Forces().Parameters().Moduli(Eigen::Vector4d(2, 0.1, 5, 0.4))));
}

}  // namespace
}  // namespace elastimate
