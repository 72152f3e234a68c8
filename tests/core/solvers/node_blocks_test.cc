#include "elastimate/core/solvers/node_blocks.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <vector>

#include "elastimate/core/mechanics/stiffness_assembly.h"
#include "tests/core/random_values.h"
#include "tests/scenes.h"

namespace elastimate {
namespace {

using testing::RandomMatrix;

// Nodes keep three, two, one or no free component.
TEST(NodeBlocks, HoldTheMatrixInAnyOrderOfNodes) {
  Scene scene = testing::SmallScene("organ");
  const Eigen::Index num_nodes = scene.mesh.NumNodes();
  scene.supports.held =
      scene.supports.held || testing::RandomSupports(num_nodes, 3).held;
  const DegreesOfFreedom dofs(scene.supports);
  const StiffnessAssembly assembly(scene.mesh, dofs);
  const Eigen::VectorXd values = assembly.Combine(0.3);
  // The product of the lower triangle and what is above it.
  const Eigen::VectorXd x = RandomMatrix(dofs.NumFree(), 1, 1);
  Eigen::VectorXd product = Eigen::VectorXd::Zero(x.size());
  const SymmetricPattern& pattern = assembly.Pattern();
  for (Eigen::Index j = 0; j < x.size(); ++j) {
    for (auto k = pattern.column_start[j]; k < pattern.column_start[j + 1];
         ++k) {
      const std::int64_t i = pattern.row[k];
      product(i) += values(k) * x(j);
      product(j) += i == j ? 0 : values(k) * x(i);
    }
  }
  std::vector<int> backwards(num_nodes);
  for (Eigen::Index i = 0; i < num_nodes; ++i) {
    backwards[i] = int(num_nodes - 1 - i);
  }
  for (const std::vector<int>& order : {std::vector<int>(), backwards}) {
    const NodeBlocks blocks(assembly.Graph(), dofs, order);
    const BlockMatrix matrix = blocks.MatrixOf(values);
    ASSERT_EQ(matrix.NumRows(), 3 * blocks.NumBlocks());
    const std::vector<int> rows = blocks.RowsOfFree();
    Eigen::MatrixXd all = Eigen::MatrixXd::Zero(matrix.NumRows(), 1);
    all(rows, 0) = x;
    const Eigen::MatrixXd of_blocks = MultiplyAccurately(matrix, all);
    EXPECT_LT((of_blocks(rows, 0) - product).norm(), 1e-12 * product.norm());
    // Held components have a diagonal of the size of their node's.
    EXPECT_GT(
        (MultiplyAccurately(matrix, Eigen::MatrixXd::Ones(matrix.NumRows(), 1))
             .cwiseAbs()
             .minCoeff()),
        0);
    EXPECT_NEAR(of_blocks.norm(), product.norm(), 1e-12 * product.norm());
  }
}

}  // namespace
}  // namespace elastimate
