#include "elastimate/core/node_graph.h"

#include <gtest/gtest.h>

#include <set>
#include <utility>

#include "tests/core/random_values.h"
#include "tests/dense_reference.h"
#include "tests/scenes.h"

namespace elastimate {
namespace {

using testing::BoxMesh;
using testing::Distorted;
using testing::WithBothOrientations;

class NodeGraphOfABox : public ::testing::Test {
 protected:
  NodeGraphOfABox()
      : mesh_(
            WithBothOrientations(Distorted(BoxMesh({3, 2, 2}, {1, 0.8, 1.2})))),
        graph_(mesh_) {}

  Mesh mesh_;
  NodeGraph graph_;
};

TEST_F(NodeGraphOfABox, HasEachPairOfEachElementOnce) {
  std::set<std::pair<int, int>> expected;
  for (Eigen::Index e = 0; e < mesh_.NumElements(); ++e) {
    for (const int i : mesh_.elements.col(e)) {
      for (const int j : mesh_.elements.col(e)) {
        if (i >= j) {
          expected.emplace(j, i);
        }
      }
    }
  }
  // A set is in the order of columns, then rows: so are the pairs.
  ASSERT_EQ(graph_.NumPairs(), static_cast<Eigen::Index>(expected.size()));
  ASSERT_EQ(graph_.start.size(),
            static_cast<std::size_t>(mesh_.NumNodes() + 1));
  EXPECT_EQ(graph_.start.front(), 0);
  EXPECT_EQ(graph_.start.back(), graph_.NumPairs());
  Eigen::Index k = 0;
  for (const auto& [column, row] : expected) {
    EXPECT_EQ(graph_.row[k], row);
    EXPECT_LE(graph_.start[column], k);
    EXPECT_GT(graph_.start[column + 1], k);
    ++k;
  }
}

TEST_F(NodeGraphOfABox, BeginsEachColumnWithTheDiagonal) {
  for (Eigen::Index node = 0; node < mesh_.NumNodes(); ++node) {
    EXPECT_EQ(graph_.row[graph_.start[node]], node);
  }
}

TEST_F(NodeGraphOfABox, KnowsThePairsOfEachElement) {
  ASSERT_EQ(graph_.element_pairs.rows(), 16);
  ASSERT_EQ(graph_.element_pairs.cols(), mesh_.NumElements());
  for (Eigen::Index e = 0; e < mesh_.NumElements(); ++e) {
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j < 4; ++j) {
        const int pair = graph_.element_pairs(4 * i + j, e);
        const int row = mesh_.elements(i, e);
        const int column = mesh_.elements(j, e);
        if (row < column) {
          EXPECT_EQ(pair, -1);
          continue;
        }
        EXPECT_EQ(graph_.row[pair], row);
        EXPECT_GE(pair, graph_.start[column]);
        EXPECT_LT(pair, graph_.start[column + 1]);
      }
    }
  }
}

// Gradients of the shape functions from the inverse of the matrix of nodal
// coordinates; rounding as there.
TEST_F(NodeGraphOfABox, GradientProductsAreThoseOfTheShapeFunctions) {
  const Eigen::Index size = 3 * mesh_.NumNodes();
  Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(size, size);
  for (Eigen::Index e = 0; e < mesh_.NumElements(); ++e) {
    Eigen::Matrix4d coordinates = Eigen::Matrix4d::Ones();
    for (int i = 0; i < 4; ++i) {
      coordinates.col(i).tail<3>() = mesh_.nodes.col(mesh_.elements(i, e));
    }
    const double volume = std::abs(coordinates.determinant()) / 6;
    const Eigen::Matrix<double, 4, 3> gradients =
        coordinates.inverse().rightCols<3>();
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j < 4; ++j) {
        const Eigen::Index row = mesh_.elements(i, e);
        const Eigen::Index column = mesh_.elements(j, e);
        expected.block<3, 3>(3 * row, 3 * column) +=
            volume * gradients.row(i).transpose() * gradients.row(j);
      }
    }
  }
  const Eigen::Matrix3Xd products = GradientProducts(mesh_, graph_);
  ASSERT_EQ(products.cols(), 3 * graph_.NumPairs());
  const double tolerance = 1e-13 * expected.cwiseAbs().maxCoeff();
  for (Eigen::Index j = 0; j < mesh_.NumNodes(); ++j) {
    for (Eigen::Index k = graph_.start[j]; k < graph_.start[j + 1]; ++k) {
      const Eigen::Matrix3d block =
          expected.block<3, 3>(3 * Eigen::Index(graph_.row[k]), 3 * j);
      EXPECT_LT((products.middleCols<3>(3 * k) - block).norm(), tolerance);
    }
  }
}

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
  EXPECT_TRUE(StiffnessBlockH(m).isApprox(
      b(g).transpose() * testing::DenseDH() * b(h), 1e-14));
  EXPECT_TRUE(StiffnessBlockJ(m).isApprox(
      b(g).transpose() * testing::DenseDJ() * b(h), 1e-14));
}

}  // namespace
}  // namespace elastimate
