#include "elastimate/estimators/validation/folds.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "elastimate/core/scene/observed_displacements.h"
#include "tests/scenes.h"
#include "tests/throws.h"

namespace elastimate {
namespace {

Scene MeasuredColumn() {
  const Mesh mesh = testing::BoxMesh({2, 2, 6}, {1, 1, 3});
  Scene scene = testing::HeldAtBottom(mesh, mesh, {0, 0, -1});
  testing::Measure({100, 0.3}, scene);
  return scene;
}

TEST(Folds, HoldEachMeasuredNodeOutOnce) {
  Scene scene = MeasuredColumn();
  ComponentMask observed =
      ComponentMask::Constant(3, scene.mesh.NumNodes(), true);
  observed.col(7) = false;
  scene.load_cases[0].observed = observed;
  const Folds folds = DivideMeasurement(scene, HeldOutPart::kAutomatic, 3);
  ASSERT_EQ(folds.Size(), 3);
  Eigen::ArrayXi times_seen = Eigen::ArrayXi::Zero(scene.mesh.NumNodes());
  for (int i = 0; i < folds.Size(); ++i) {
    const PartOfScene without = WithoutFold(scene, folds, i);
    const PartOfScene only = OnlyFold(scene, folds, i);
    int num_held_out = 0;
    for (int node = 0; node < scene.mesh.NumNodes(); ++node) {
      const bool is_seen = IsObserved(without.scene.load_cases[0], 0, node);
      const bool is_held_out = IsObserved(only.scene.load_cases[0], 0, node);
      EXPECT_EQ(is_seen || is_held_out, node != 7);
      EXPECT_FALSE(is_seen && is_held_out);
      times_seen(node) += is_held_out ? 1 : 0;
      num_held_out += is_held_out ? 1 : 0;
    }
    EXPECT_GE(num_held_out, 9);
  }
  EXPECT_EQ(times_seen(7), 0);
  EXPECT_EQ(times_seen.sum(), scene.mesh.NumNodes() - 1);
}

TEST(Folds, ArePartsAlongTheLongestEdge) {
  const Scene scene = MeasuredColumn();
  const Folds folds = DivideMeasurement(scene, HeldOutPart::kPoints, 3);
  for (int a = 0; a < scene.mesh.NumNodes(); ++a) {
    for (int b = 0; b < scene.mesh.NumNodes(); ++b) {
      if (folds.of_nodes[0](a) < folds.of_nodes[0](b)) {
        EXPECT_LT(scene.mesh.nodes(2, a), scene.mesh.nodes(2, b));
      }
    }
  }
  // The first plane of nodes is held.
  EXPECT_EQ(folds.names[0], "z from 0.5 to 1.5");
}

TEST(Folds, DivideMeasuredPoints) {
  Scene scene = MeasuredColumn();
  std::mt19937_64 generator(3);
  LoadCase& load_case = scene.load_cases[0];
  load_case.points.points = DrawPoints(scene.mesh, 40, generator);
  load_case.points.displacement =
      Interpolate(scene.mesh, load_case.points.points, load_case.displacement);
  load_case.displacement.resize(0, 0);
  const Folds folds = DivideMeasurement(scene, HeldOutPart::kAutomatic, 5);
  Eigen::Index num_rows = 0;
  for (int i = 0; i < folds.Size(); ++i) {
    const PartOfScene only = OnlyFold(scene, folds, i);
    num_rows += ObservedDisplacements(only.scene).Size();
    EXPECT_NO_THROW(ValidateScene(only.scene));
    EXPECT_NO_THROW(ValidateScene(WithoutFold(scene, folds, i).scene));
  }
  EXPECT_EQ(num_rows, ObservedDisplacements(scene).Size());
}

TEST(Folds, DivideLoadCasesWhereThereAreSeveral) {
  Scene scene = testing::WithThreeForces(MeasuredColumn());
  testing::Measure({100, 0.3}, scene);
  const Folds folds = DivideMeasurement(scene, HeldOutPart::kAutomatic, 5);
  EXPECT_THAT(folds.names, ::testing::ElementsAre("load case 1", "load case 2",
                                                  "load case 3"));
  EXPECT_THAT(WithoutFold(scene, folds, 1).load_cases,
              ::testing::ElementsAre(0, 2));
  EXPECT_THAT(OnlyFold(scene, folds, 1).load_cases, ::testing::ElementsAre(1));
  EXPECT_THAT(DivideMeasurement(scene, HeldOutPart::kAutomatic, 2).names,
              ::testing::ElementsAre("load case 1", "load cases 2 to 3"));
}

TEST(Folds, LeaveSupportsThatMovedAsMeasuredToEveryFit) {
  Scene scene = MeasuredColumn();
  scene.supports.unknown = scene.supports.held;
  const Folds folds = DivideMeasurement(scene, HeldOutPart::kAutomatic, 3);
  for (int node = 0; node < scene.mesh.NumNodes(); ++node) {
    EXPECT_EQ(folds.of_nodes[0](node) < 0, scene.supports.held(0, node));
  }
  EXPECT_NO_THROW(ValidateScene(OnlyFold(scene, folds, 0).scene));
}

TEST(Folds, RefuseWhatCannotBeDivided) {
  Scene scene = MeasuredColumn();
  EXPECT_THROWS_WITH(DivideMeasurement(scene, HeldOutPart::kPoints, 1),
                     "2 parts or more");
  EXPECT_THROWS_WITH(DivideMeasurement(scene, HeldOutPart::kPoints, 1000),
                     "54 points, which cannot be divided");
  EXPECT_THROWS_WITH(DivideMeasurement(scene, HeldOutPart::kLoadCases, 2),
                     "one load case");
  scene = testing::WithThreeForces(scene);
  scene.load_cases[0].displacement.setZero(3, scene.mesh.NumNodes());
  scene.load_cases[1].displacement.resize(0, 0);
  EXPECT_THROWS_WITH(DivideMeasurement(scene, HeldOutPart::kAutomatic, 2),
                     "load case 2 has no measured displacements");
}

}  // namespace
}  // namespace elastimate
