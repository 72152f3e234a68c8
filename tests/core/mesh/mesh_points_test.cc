#include "elastimate/core/mesh/mesh_points.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

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

// Every element represents linear fields, and its shape functions add up to
// one.
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

// The number of points in each element is proportional to its volume.  Their
// mean is the centre of the body, as integrals of shape functions give it.
TEST_P(MeshPointsOfKinds, AreDrawnEvenly) {
  constexpr Eigen::Index kPoints = 20000;
  std::mt19937_64 generator(1);
  const MeshPoints points = DrawPoints(mesh_, kPoints, generator);
  ASSERT_EQ(points.Size(), kPoints);
  EXPECT_NO_THROW(ValidatePoints(mesh_, points));
  Eigen::ArrayXd counts = Eigen::ArrayXd::Zero(mesh_.NumElements());
  for (const int element : points.elements) {
    ++counts(element);
  }
  const Eigen::ArrayXd volumes = ElementVolumes(mesh_).array();
  const Eigen::ArrayXd expected = kPoints * volumes / volumes.sum();
  // The sum is chi squared with about n degrees of freedom, which has the
  // variance 2 n.
  const double n = double(mesh_.NumElements() - 1);
  EXPECT_NEAR(((counts - expected).square() / expected).sum(), n,
              4 * std::sqrt(2 * n));
  const Eigen::VectorXd shares = testing::TextbookVolumes(mesh_);
  const Eigen::VectorXd centre = mesh_.nodes * shares / shares.sum();
  const Eigen::MatrixXd positions = Interpolate(mesh_, points, mesh_.nodes);
  const Eigen::MatrixXd arms = positions.colwise() - centre;
  const Eigen::ArrayXd sd =
      arms.rowwise().norm().array() / double(kPoints);  // Of the mean.
  EXPECT_TRUE((arms.rowwise().mean().array().abs() < 4 * sd).all());
  std::mt19937_64 again(1);
  EXPECT_EQ(DrawPoints(mesh_, kPoints, again).local, points.local);
}

INSTANTIATE_TEST_SUITE_P(Kinds, MeshPointsOfKinds,
                         ::testing::ValuesIn(testing::AllKindsOfSections()),
                         testing::KindTestName);

TEST(MeshPoints, AreTheSameInQuadraticElements) {
  const Mesh mesh = testing::SmallScene("organ").mesh;
  const Mesh quadratic = testing::WithMidEdgeNodes(mesh);
  const MeshPoints points = RandomPoints(mesh, 50, 2);
  EXPECT_TRUE(Interpolate(quadratic, points, quadratic.nodes)
                  .isApprox(Interpolate(mesh, points, mesh.nodes), 1e-13));
}

// The element is a trapezoid with parallel edges of 4 and 1.  Equal areas of
// the reference square stand for four times the area beside the long edge.
TEST(MeshPoints, AreDrawnEvenlyInDistortedElements) {
  Mesh mesh;
  mesh.kind = ElementKind::kQuad4;
  mesh.section = {SectionModel::kPlaneStress, 1};
  mesh.nodes.resize(2, 4);
  mesh.nodes << 0, 4, 1, 0,  //
      0, 0, 1, 1;
  mesh.elements = Eigen::Vector4i(0, 1, 2, 3);
  constexpr Eigen::Index kPoints = 40000;
  std::mt19937_64 generator(4);
  const Eigen::MatrixXd positions =
      Interpolate(mesh, DrawPoints(mesh, kPoints, generator), mesh.nodes);
  // The part of the trapezoid below y has the area 4 y - 3 y^2 / 2; the whole
  // has 5/2.
  for (const double y : {0.1, 0.3, 0.5, 0.7, 0.9}) {
    const double share = (4 * y - 1.5 * y * y) / 2.5;
    const double found =
        double((positions.row(1).array() < y).count()) / kPoints;
    EXPECT_NEAR(found, share, 4 * std::sqrt(share * (1 - share) / kPoints));
  }
  // At each y the points spread evenly from 0 to 4 - 3 y.
  const Eigen::ArrayXd along =
      (positions.row(0).array() / (4 - 3 * positions.row(1).array()))
          .transpose();
  for (const double part : {0.1, 0.5, 0.8}) {
    const double found = double((along < part).count()) / kPoints;
    EXPECT_NEAR(found, part, 4 * std::sqrt(part * (1 - part) / kPoints));
  }
}

}  // namespace
}  // namespace elastimate
