#include "elastimate/core/mechanics/gradient_products.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "tests/core/instruction_sets.h"
#include "tests/core/random_values.h"
#include "tests/dense_reference.h"
#include "tests/scenes.h"

namespace elastimate {
namespace {

using testing::BoxMesh;
using testing::Distorted;
using testing::WithBothOrientations;

using GradientProductsByInstructionSet = testing::InstructionSet;

// Gradients of the shape functions from the inverse of the matrix of nodal
// coordinates; rounding as there.
TEST_P(GradientProductsByInstructionSet, AreThoseOfTheShapeFunctions) {
  const Mesh mesh =
      WithBothOrientations(Distorted(BoxMesh({4, 3, 2}, {1, 0.8, 1.2})));
  const NodeGraph graph(mesh);
  const Eigen::Index size = 3 * mesh.NumNodes();
  Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(size, size);
  for (Eigen::Index e = 0; e < mesh.NumElements(); ++e) {
    Eigen::Matrix4d coordinates = Eigen::Matrix4d::Ones();
    for (int i = 0; i < 4; ++i) {
      coordinates.col(i).tail<3>() = mesh.nodes.col(mesh.elements(i, e));
    }
    const double volume = std::abs(coordinates.determinant()) / 6;
    const Eigen::Matrix<double, 4, 3> gradients =
        coordinates.inverse().rightCols<3>();
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j < 4; ++j) {
        const Eigen::Index row = mesh.elements(i, e);
        const Eigen::Index column = mesh.elements(j, e);
        expected.block<3, 3>(3 * row, 3 * column) +=
            volume * gradients.row(i).transpose() * gradients.row(j);
      }
    }
  }
  const Eigen::Matrix4Xd products = GradientProducts(mesh, graph);
  ASSERT_EQ(products.cols(), 3 * graph.NumPairs());
  EXPECT_TRUE(products.row(3).isZero(0));
  const double tolerance = 1e-13 * expected.cwiseAbs().maxCoeff();
  for (Eigen::Index j = 0; j < mesh.NumNodes(); ++j) {
    for (Eigen::Index k = graph.start[j]; k < graph.start[j + 1]; ++k) {
      const Eigen::Matrix3d block =
          expected.block<3, 3>(3 * Eigen::Index(graph.row[k]), 3 * j);
      EXPECT_LT((products.block<3, 3>(0, 3 * k) - block).norm(), tolerance);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Supported, GradientProductsByInstructionSet,
                         ::testing::ValuesIn(testing::InstructionSets()),
                         testing::InstructionSetName);

// One element: D_H and D_J for a pair of gradients g, h of a unit volume.
TEST(StiffnessBlocks, FollowFromTheGradientProduct) {
  const Eigen::Vector3d g(1, -2, 3);
  const Eigen::Vector3d h(0.5, 4, -1);
  const auto b = [](const Eigen::Vector3d& x) {
    Eigen::Matrix<double, 6, 3> rows;
    rows << x(0), 0, 0, 0, x(1), 0, 0, 0, x(2),  //
        x(1), x(0), 0, 0, x(2), x(1), x(2), 0, x(0);
    return rows;
  };
  const Eigen::Matrix3d m = g * h.transpose();
  EXPECT_TRUE(StiffnessBlockH<3>(m).isApprox(
      b(g).transpose() * testing::DenseDH() * b(h), 1e-14));
  EXPECT_TRUE(StiffnessBlockJ<3>(m, 2).isApprox(
      b(g).transpose() * testing::DenseDJ() * b(h), 1e-14));
}

}  // namespace
}  // namespace elastimate
