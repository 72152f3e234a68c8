#include "elastimate/estimators/displacement_fit/element_change.h"

#include <gtest/gtest.h>

#include "elastimate/core/equilibrium/forward_model.h"
#include "elastimate/core/mesh/mid_edges.h"
#include "elastimate/core/scene/loads.h"
#include "elastimate/core/scene/quadratic_scene.h"
#include "elastimate/core/scene/simplicial_scene.h"
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
                       model.Responses(), [this](double nu) {
                         EXPECT_EQ(nu, model.PoissonRatio());
                         ++num_solvers;
                         return &model.Solver();
                       });
  }

  ObservedDisplacements observed;
  ForwardModel model;
  ElementChange change;
  int num_solvers = 0;
};

TEST(ElementChange, IsThatOfQuadraticElementsBothWays) {
  const Scene scene = MovedScene(kTetrahedra);
  const Scene quadratic_scene = QuadraticScene(scene);
  Changing linear(scene);
  Changing quadratic(quadratic_scene);
  const auto up = linear.At(0.3);
  const auto down = quadratic.At(0.3);
  ASSERT_TRUE(up && down);
  // Observed are the vertices, in the same unit.
  const Eigen::VectorXd expected =
      linear.observed.Restrict(
          quadratic.model.Displacement(kModulusOfTetrahedra)
              .topRows(scene.mesh.NumDofs())) -
      linear.observed.Restrict(linear.model.Displacement(kModulusOfTetrahedra));
  EXPECT_LT((*up - expected).norm(), 0.05 * expected.norm());
  EXPECT_LT((*down - expected).norm(), 1e-9 * expected.norm());
  EXPECT_EQ(linear.num_solvers, 1);
  // Quadratic elements need no solver of their own.
  EXPECT_EQ(quadratic.num_solvers, 0);
}

TEST(ElementChange, KnowsMidEdgeNodesToo) {
  const Scene scene = MovedScene(kTetrahedra);
  Scene quadratic_scene = QuadraticScene(scene);
  LoadCase& load_case = quadratic_scene.load_cases[0];
  load_case.observed.setConstant(true);
  Changing linear(scene);
  Changing quadratic(quadratic_scene);
  const auto down = quadratic.At(0.3);
  ASSERT_TRUE(down && linear.At(0.3));
  const Eigen::VectorXd expected = quadratic.observed.Restrict(
      quadratic.model.Displacement(kModulusOfTetrahedra) -
      MidEdges(quadratic_scene.mesh)
          .Interpolate(linear.model.Displacement(kModulusOfTetrahedra)));
  EXPECT_LT((*down - expected).norm(), 1e-9 * expected.norm());
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

// To quadratic simplices of the same nodes.
TEST(ElementChange, IsKnownOfEveryLinearKind) {
  for (const testing::KindOfSection& kind : testing::AllKindsOfSections()) {
    if (TopologyOf(kind.kind).order == 2) {
      continue;
    }
    const Scene scene = MovedScene(kind);
    const Scene quadratic_scene = QuadraticScene(SimplicialScene(scene));
    Changing linear(scene);
    Changing quadratic(quadratic_scene);
    const auto change = linear.At(0.3);
    quadratic.At(0.3);
    ASSERT_TRUE(change) << testing::NameOf(kind);
    const Eigen::VectorXd expected = linear.observed.Restrict(
        quadratic.model.Displacement(kModulusOfTetrahedra)
            .topRows(scene.mesh.NumDofs()) -
        linear.model.Displacement(kModulusOfTetrahedra));
    EXPECT_LT((*change - expected).norm(),
              2 * HierarchicalError::kTolerance * expected.norm())
        << testing::NameOf(kind);
    EXPECT_EQ(linear.num_solvers, 1);
  }
}

TEST(ElementChange, IsNotKnownWhereMidEdgeNodesAloneHold) {
  Scene scene = QuadraticScene(MovedScene(kTetrahedra));
  scene.supports.held.leftCols(scene.mesh.NumVertices()).setConstant(false);
  Changing quadratic(scene);
  EXPECT_FALSE(quadratic.At(0.3));
}

}  // namespace
}  // namespace elastimate
