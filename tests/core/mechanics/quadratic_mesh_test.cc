#include "elastimate/core/mechanics/quadratic_mesh.h"

#include <gtest/gtest.h>
#include <omp.h>

#include <string>

#include "elastimate/core/mechanics/stiffness_product.h"
#include "elastimate/core/mechanics/tensor_stiffness_product.h"
#include "elastimate/core/mechanics/tet10_stiffness_product.h"
#include "tests/core/random_values.h"
#include "tests/element_kinds.h"

namespace elastimate {
namespace {

using testing::KindOfSection;
using testing::RandomMatrix;

struct LargeMeshOfKind {
  KindOfSection kind;
  int cells;
};

class QuadraticMeshOfKinds : public ::testing::TestWithParam<LargeMeshOfKind> {
 protected:
  QuadraticMeshOfKinds()
      : mesh_(testing::MeshOfKind(GetParam().kind, GetParam().cells)),
        q_(RandomMatrix(mesh_.NumDofs(), 2, 1)),
        coefficients_(
            RandomMatrix(2, mesh_.NumElements(), 2) +
            Eigen::Vector2d(2, 0.6).replicate(1, mesh_.NumElements())) {}

  Eigen::MatrixXd Sum(const QuadraticMesh& mesh) const {
    return mesh.Kind() == ElementKind::kTet10
               ? MultiplyQuadraticTetrahedra(mesh, coefficients_, q_)
               : MultiplyTensorElements(mesh, coefficients_, q_);
  }

  const Mesh mesh_;
  const Eigen::MatrixXd q_;
  const Eigen::Matrix2Xd coefficients_;
};

INSTANTIATE_TEST_SUITE_P(
    All, QuadraticMeshOfKinds,
    ::testing::Values(
        LargeMeshOfKind{{ElementKind::kTet10, SectionModel::kSolid}, 16},
        LargeMeshOfKind{{ElementKind::kHex27, SectionModel::kSolid}, 16},
        LargeMeshOfKind{{ElementKind::kQuad9, SectionModel::kPlaneStress}, 95}),
    [](const auto& test) { return testing::NameOf(test.param.kind); });

TEST_P(QuadraticMeshOfKinds, HasTheSameSumsInBlocks) {
  const QuadraticMesh in_blocks = QuadraticMesh::InBlocks(mesh_);
  EXPECT_GE(in_blocks.Blocks().blocks.size(), 3U);
  EXPECT_LT(in_blocks.Blocks().most_nodes, mesh_.NumNodes() / 2);
  EXPECT_TRUE(Sum(in_blocks).isApprox(Sum(QuadraticMesh(mesh_)), 1e-13));
  const StiffnessProducts expected = MultiplyStiffnessBasis(mesh_, q_);
  StiffnessProducts products;
  StiffnessOperator(mesh_).Multiply(q_, products);
  EXPECT_TRUE(products.h.isApprox(expected.h, 1e-13));
  EXPECT_TRUE(products.j.isApprox(expected.j, 1e-13));
}

TEST_P(QuadraticMeshOfKinds, HasTheSameBitsForAnyNumberOfThreads) {
  const QuadraticMesh in_blocks = QuadraticMesh::InBlocks(mesh_);
  const int num_threads = omp_get_max_threads();
  omp_set_num_threads(1);
  const Eigen::MatrixXd of_one = Sum(in_blocks);
  omp_set_num_threads(3);
  EXPECT_EQ(Sum(in_blocks), of_one);
  omp_set_num_threads(num_threads);
}

TEST(QuadraticMesh, LeavesASmallMeshAsItIs) {
  const Mesh mesh =
      testing::MeshOfKind({ElementKind::kTet10, SectionModel::kSolid}, 3);
  const QuadraticMesh small = QuadraticMesh::InBlocks(mesh);
  EXPECT_EQ(small.Blocks().blocks.size(), 1U);
  EXPECT_EQ(small.Positions(), mesh.nodes.data());
}

}  // namespace
}  // namespace elastimate
