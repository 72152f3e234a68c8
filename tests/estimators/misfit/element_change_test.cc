#include "elastimate/estimators/misfit/element_change.h"

#include <gtest/gtest.h>

#include "elastimate/core/equilibrium/forward_model.h"
#include "elastimate/core/scene/finer_scene.h"
#include "elastimate/core/scene/loads.h"
#include "elastimate/core/scene/quadratic_scene.h"
#include "tests/element_kinds.h"

namespace elastimate {
namespace {

constexpr testing::KindOfSection kTetrahedra = {ElementKind::kTet4,
                                                SectionModel::kSolid};
constexpr double kModulusOfTetrahedra = 5e4;

// With supports that move.
Scene MovedScene(const testing::KindOfSection& kind) {
  Scene scene = testing::SceneOfKind(kind);
  testing::DisplaceSupports(scene);
  scene.load_cases[0].displacement.setOnes(scene.mesh.Dimension(),
                                           scene.mesh.NumNodes());
  return scene;
}

// A scene with its model and what its elements change.
struct Changing {
  explicit Changing(const Scene& scene)
      : observed(scene),
        model(scene.mesh, scene.supports, AssembleLoadCases(scene)),
        change(scene) {}

  std::optional<Eigen::VectorXd> At(double poisson_ratio) {
    EXPECT_TRUE(model.SetPoissonRatio(poisson_ratio));
    return change.Rows(observed, {kModulusOfTetrahedra, poisson_ratio},
                       [this](double nu) -> ElementChange::Model {
                         EXPECT_TRUE(model.SetPoissonRatio(nu));
                         ++num_solvers;
                         return {model.Responses(), &model.Solver()};
                       });
  }

  ObservedDisplacements observed;
  ForwardModel model;
  ElementChange change;
  int num_solvers = 0;
};

TEST(ElementChange, KnowsMidEdgeNodesToo) {
  Scene scene = QuadraticScene(MovedScene(kTetrahedra));
  scene.load_cases[0].observed.setConstant(true);
  const Scene finer_scene = FinerScene(scene);
  Changing quadratic(scene);
  Changing finer(finer_scene);
  const auto change = quadratic.At(0.3);
  ASSERT_TRUE(change);
  EXPECT_TRUE(finer.model.SetPoissonRatio(0.3));
  const Eigen::VectorXd expected = quadratic.observed.Restrict(
      finer.model.Displacement(kModulusOfTetrahedra)
          .topRows(scene.mesh.NumDofs()) -
      quadratic.model.Displacement(kModulusOfTetrahedra));
  EXPECT_LT((*change - expected).norm(),
            2 * HierarchicalError::kTolerance * expected.norm());
}

// Where iterations would not end, it is most of that of the limit.
TEST(ElementChange, IsKnownOfQuadraticElementsNextToOneHalf) {
  constexpr double kNextToLimit = 0.4999;
  Scene linear_scene = testing::SceneOfKind(kTetrahedra);
  linear_scene.load_cases[0].displacement.setOnes(3,
                                                  linear_scene.mesh.NumNodes());
  const Scene scene = QuadraticScene(linear_scene);
  const Scene finer_scene = FinerScene(scene);
  Changing quadratic(scene);
  Changing finer(finer_scene);
  const auto change = quadratic.At(kNextToLimit);
  EXPECT_TRUE(quadratic.model.SetPoissonRatio(kNextToLimit));
  EXPECT_TRUE(finer.model.SetPoissonRatio(kNextToLimit));
  ASSERT_TRUE(change);
  const Eigen::VectorXd expected = quadratic.observed.Restrict(
      finer.model.Displacement(kModulusOfTetrahedra)
          .topRows(scene.mesh.NumDofs()) -
      quadratic.model.Displacement(kModulusOfTetrahedra));
  EXPECT_GT(expected.norm(), 0);
  EXPECT_LT((*change - expected).norm(), 0.5 * expected.norm());
}

TEST(ElementChange, IsFoundOnceForAboutTheSameStiffness) {
  const Scene scene = MovedScene(kTetrahedra);
  Changing linear(scene);
  ASSERT_TRUE(linear.At(0.3));
  const int passes = linear.change.WorkDone().element_passes;
  EXPECT_GT(passes, 0);
  linear.At(0.301);
  EXPECT_EQ(linear.change.WorkDone().element_passes, passes);
  EXPECT_EQ(linear.num_solvers, 1);
  linear.At(0.45);
  EXPECT_GT(linear.change.WorkDone().element_passes, passes);
}

// The error of a straight line between two is of second order; that of the
// nearer of them, of first.
TEST(ElementChange, IsLinearBetweenThoseThatAreKnown) {
  const Scene scene = MovedScene(kTetrahedra);
  Changing exact(scene);
  const auto expected = exact.At(0.31);
  Changing linear(scene);
  const auto one = linear.At(0.28);
  ASSERT_TRUE(linear.At(0.33));
  ASSERT_TRUE(expected && one);
  const int num_solvers = linear.num_solvers;
  ASSERT_EQ(num_solvers, 2);
  const auto between = linear.At(0.31);
  ASSERT_TRUE(between);
  EXPECT_EQ(linear.num_solvers, num_solvers);
  const double of_nearer = (*one - *expected).norm();
  EXPECT_GT(of_nearer, 1e-2 * expected->norm());
  EXPECT_LT((*between - *expected).norm(), 0.2 * of_nearer);
}

// To quadratic simplices of the same nodes.
TEST(ElementChange, IsKnownOfEveryKind) {
  for (const testing::KindOfSection& kind : testing::AllKindsOfSections()) {
    const Scene scene = MovedScene(kind);
    const Scene finer_scene = FinerScene(scene);
    Changing coarse(scene);
    Changing finer(finer_scene);
    const auto change = coarse.At(0.3);
    EXPECT_TRUE(finer.model.SetPoissonRatio(0.3));
    ASSERT_TRUE(change) << testing::NameOf(kind);
    const Eigen::VectorXd expected = coarse.observed.Restrict(
        finer.model.Displacement(kModulusOfTetrahedra)
            .topRows(scene.mesh.NumDofs()) -
        coarse.model.Displacement(kModulusOfTetrahedra));
    EXPECT_LT((*change - expected).norm(),
              2 * HierarchicalError::kTolerance * expected.norm())
        << testing::NameOf(kind);
    EXPECT_EQ(coarse.num_solvers, 1);
  }
}

TEST(ElementChange, IsKnownWhereMidEdgeNodesAloneHold) {
  Scene scene = QuadraticScene(MovedScene(kTetrahedra));
  scene.supports.held.leftCols(scene.mesh.NumVertices()).setConstant(false);
  Changing quadratic(scene);
  EXPECT_TRUE(quadratic.At(0.3));
}

}  // namespace
}  // namespace elastimate
