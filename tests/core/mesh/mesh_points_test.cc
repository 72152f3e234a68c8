#include "elastimate/core/mesh/mesh_points.h"

#include <gtest/gtest.h>

#include "elastimate/core/mesh/shape_functions.h"
#include "tests/core/random_values.h"
#include "tests/element_kinds.h"
#include "tests/quadratic_reference.h"
#include "tests/random_points.h"
#include "tests/scenes.h"
#include "tests/throws.h"

namespace elastimate {
namespace {

using testing::MeshOfKind;
using testing::RandomMatrix;
using testing::RandomPoints;

class MeshPointsOfKinds
    : public ::testing::TestWithParam<testing::KindOfSection> {
 protected:
  const Mesh mesh_ = MeshOfKind(GetParam());
  const MeshPoints points_ = RandomPoints(mesh_, 50, 1);
};

// Every element has the linear fields, and its functions add up to one.
TEST_P(MeshPointsOfKinds, InterpolateLinearFields) {
  const Eigen::MatrixXd gradient = RandomMatrix(2, mesh_.Dimension(), 1);
  const Eigen::MatrixXd at_nodes = (gradient * mesh_.nodes).array() + 0.5;
  const Eigen::MatrixXd positions = Interpolate(mesh_, points_, mesh_.nodes);
  const Eigen::MatrixXd expected = (gradient * positions).array() + 0.5;
  EXPECT_TRUE(Interpolate(mesh_, points_, at_nodes).isApprox(expected, 1e-13));
  EXPECT_TRUE(ShapeFunctionsOf(mesh_, points_)
                  .colwise()
                  .sum()
                  .isApproxToConstant(1, 1e-13));
}

TEST_P(MeshPointsOfKinds, LieInTheirElements) {
  const Eigen::MatrixXd positions = Interpolate(mesh_, points_, mesh_.nodes);
  for (Eigen::Index i = 0; i < points_.Size(); ++i) {
    const auto nodes =
        mesh_.nodes(Eigen::all, mesh_.elements.col(points_.elements(i)));
    EXPECT_TRUE(
        (positions.col(i).array() >= nodes.rowwise().minCoeff().array() - 1e-12)
            .all());
    EXPECT_TRUE(
        (positions.col(i).array() <= nodes.rowwise().maxCoeff().array() + 1e-12)
            .all());
  }
}

TEST_P(MeshPointsOfKinds, AreRefusedOutsideTheirElements) {
  EXPECT_NO_THROW(ValidatePoints(mesh_, points_));
  MeshPoints points = points_;
  points.elements(3) = static_cast<int>(mesh_.NumElements());
  EXPECT_THROWS_WITH(ValidatePoints(mesh_, points),
                     "point 3 is in element [0-9]+, which does not exist");
  points = points_;
  points.local(0, 7) = 1.1;
  EXPECT_THROWS_WITH(ValidatePoints(mesh_, points),
                     "point 7 does not lie in element");
  points.local(0, 7) = testing::kNan;
  EXPECT_THROWS_WITH(ValidatePoints(mesh_, points), "point 7 does not lie");
  points.local.conservativeResize(Eigen::NoChange, 49);
  EXPECT_THROWS_WITH(ValidatePoints(mesh_, points),
                     "make them dimension x points");
}

INSTANTIATE_TEST_SUITE_P(Kinds, MeshPointsOfKinds,
                         ::testing::ValuesIn(testing::AllKindsOfSections()),
                         [](const auto& info) {
                           return testing::NameOf(info.param);
                         });

TEST(MeshPoints, AreTheSameInQuadraticElements) {
  const Mesh mesh = testing::SmallScene("organ").mesh;
  const Mesh quadratic = testing::WithMidEdgeNodes(mesh);
  const MeshPoints points = RandomPoints(mesh, 50, 2);
  EXPECT_TRUE(Interpolate(quadratic, points, quadratic.nodes)
                  .isApprox(Interpolate(mesh, points, mesh.nodes), 1e-13));
}

}  // namespace
}  // namespace elastimate
