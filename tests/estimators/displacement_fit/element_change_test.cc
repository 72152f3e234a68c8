#include "elastimate/estimators/displacement_fit/element_change.h"

#include <gtest/gtest.h>

#include "elastimate/core/equilibrium/forward_model.h"
#include "elastimate/core/mesh/mid_edges.h"
#include "elastimate/core/scene/loads.h"
#include "elastimate/core/scene/quadratic_scene.h"
#include "tests/element_kinds.h"

namespace elastimate {
namespace {

constexpr testing::KindOfSection kTetrahedra = {ElementKind::kTet4,
                                                SectionModel::kSolid};

// With supports that move.
Scene MovedScene(const testing::KindOfSection& kind) {
  Scene scene = testing::SceneOfKind(kind);
  for (Eigen::Index i = 0; i < scene.supports.held.size(); ++i) {
    if (scene.supports.held(i)) {
      scene.supports.displacement(i) = 0.001 * double(i % 5);
    }
  }
  return scene;
}

Eigen::MatrixXd ResponsesOf(const ForwardModel& model) {
  Eigen::MatrixXd responses(model.UnitLoadResponse().rows(), 2);
  responses << model.UnitLoadResponse(), model.SupportResponse();
  return responses;
}

struct Model {
  explicit Model(const Scene& scene)
      : model(scene.mesh, scene.supports, AssembleLoadCases(scene)) {}

  Eigen::MatrixXd At(double poisson_ratio) {
    EXPECT_TRUE(model.SetPoissonRatio(poisson_ratio));
    return ResponsesOf(model);
  }

  ForwardModel model;
};

TEST(ElementChange, IsThatOfQuadraticElementsBothWays) {
  const Scene linear = MovedScene(kTetrahedra);
  const Scene quadratic = QuadraticScene(linear);
  Model of_linear(linear);
  Model of_quadratic(quadratic);
  const Eigen::MatrixXd at_linear = of_linear.At(0.3);
  const Eigen::MatrixXd at_quadratic = of_quadratic.At(0.3);

  ElementChange upwards(linear);
  EXPECT_TRUE(upwards.IsOfFinerElements());
  const auto up = upwards.Find(0.3, at_linear, of_linear.model.Solver());
  ASSERT_TRUE(up);
  const Eigen::MatrixXd expected =
      at_quadratic.topRows(at_linear.rows()) - at_linear;
  EXPECT_LT((*up - expected).norm(), 0.05 * expected.norm());

  ElementChange downwards(quadratic);
  EXPECT_FALSE(downwards.IsOfFinerElements());
  const auto down =
      downwards.Find(0.3, at_quadratic, of_quadratic.model.Solver());
  ASSERT_TRUE(down);
  EXPECT_LT((down->topRows(at_linear.rows()) - expected).norm(),
            1e-9 * expected.norm());
  EXPECT_LT(
      (*down - (at_quadratic - MidEdges(quadratic.mesh).Interpolate(at_linear)))
          .norm(),
      1e-9 * expected.norm());
}

TEST(ElementChange, IsFoundOnceForAboutTheSameStiffness) {
  const Scene scene = MovedScene(kTetrahedra);
  Model model(scene);
  ElementChange change(scene);
  const Eigen::MatrixXd responses = model.At(0.3);
  ASSERT_TRUE(change.Find(0.3, responses, model.model.Solver()));
  const int passes = change.WorkDone().element_passes;
  EXPECT_GT(passes, 0);
  change.Find(0.301, responses, model.model.Solver());
  EXPECT_EQ(change.WorkDone().element_passes, passes);
  change.Find(0.45, model.At(0.45), model.model.Solver());
  EXPECT_GT(change.WorkDone().element_passes, passes);
}

TEST(ElementChange, IsNotKnownOfHexahedra) {
  const Scene scene = MovedScene({ElementKind::kHex8, SectionModel::kSolid});
  Model model(scene);
  ElementChange change(scene);
  EXPECT_FALSE(change.Find(0.3, model.At(0.3), model.model.Solver()));
}

TEST(ElementChange, IsNotKnownWhereMidEdgeNodesAloneHold) {
  Scene scene = QuadraticScene(testing::SceneOfKind(kTetrahedra));
  const Eigen::Index num_vertices = scene.mesh.NumVertices();
  scene.supports.held.leftCols(num_vertices).setConstant(false);
  ForwardModel model(scene.mesh, scene.supports, AssembleLoadCases(scene));
  ASSERT_TRUE(model.SetPoissonRatio(0.3));
  ElementChange change(scene);
  EXPECT_FALSE(change.Find(0.3, model.UnitLoadResponse(), model.Solver()));
}

}  // namespace
}  // namespace elastimate
