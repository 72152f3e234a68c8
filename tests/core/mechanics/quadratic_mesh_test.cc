#include "elastimate/core/mechanics/quadratic_mesh.h"

#include <gtest/gtest.h>
#include <omp.h>

#include <cmath>
#include <string>
#include <type_traits>
#include <vector>

#include "elastimate/core/materials/material.h"
#include "elastimate/core/mechanics/internal_forces.h"
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

  Eigen::MatrixXd NaN() const {
    return Eigen::MatrixXd::Constant(q_.rows(), q_.cols(), std::nan(""));
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
  ASSERT_GE(in_blocks.Blocks().blocks.size(), 3U);
  EXPECT_LT(in_blocks.Blocks().most_nodes, mesh_.NumNodes() / 2);
  EXPECT_TRUE(Sum(in_blocks).isApprox(Sum(QuadraticMesh(mesh_)), 1e-13));
  const StiffnessProducts expected = MultiplyStiffnessBasis(mesh_, q_);
  // Old values are overwritten.
  StiffnessProducts products = {NaN(), NaN()};
  StiffnessOperator(mesh_).Multiply(q_, products);
  EXPECT_TRUE(products.h.isApprox(expected.h, 1e-13));
  EXPECT_TRUE(products.j.isApprox(expected.j, 1e-13));
}

TEST_P(QuadraticMeshOfKinds, HasTheSameBitsForAnyNumberOfThreads) {
  const QuadraticMesh in_blocks = QuadraticMesh::InBlocks(mesh_);
  const int num_threads = omp_get_max_threads();
  omp_set_num_threads(1);
  const StiffnessOperator stiffness(mesh_);
  StiffnessProducts of_one;
  stiffness.Multiply(q_, of_one);
  const Eigen::MatrixXd sum_of_one = Sum(in_blocks);
  for (const int num : {3, 64}) {
    omp_set_num_threads(num);
    EXPECT_EQ(Sum(in_blocks), sum_of_one);
    StiffnessProducts products;
    stiffness.Multiply(q_, products);
    EXPECT_EQ(products.h, of_one.h);
    EXPECT_EQ(products.j, of_one.j);
  }
  omp_set_num_threads(num_threads);
}

// The whole mesh and its parts have different blocks.
TEST_P(QuadraticMeshOfKinds, HasTheForcesOfSeveralMaterials) {
  Mesh mesh = mesh_;
  mesh.regions.resize(mesh.NumElements());
  for (Eigen::Index e = 0; e < mesh.NumElements(); ++e) {
    mesh.regions(e) = e % 3 == 0 ? 1 : 2;
  }
  const InternalForces forces(mesh, IsotropicMaterialOfEachRegion(mesh));
  const Eigen::Vector4d moduli(1, 0.3, 5, 2);
  const std::vector<Eigen::MatrixXd> products = forces.Products(q_);
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(q_.rows(), q_.cols());
  for (int k = 0; k < 4; ++k) {
    sum += moduli(k) * products[k];
  }
  EXPECT_TRUE(forces.Multiply(moduli, q_).isApprox(sum, 1e-13));
}

static_assert(!std::is_constructible_v<QuadraticMesh, Mesh>);

TEST(QuadraticMesh, LeavesASmallMeshAsItIs) {
  const Mesh mesh =
      testing::MeshOfKind({ElementKind::kTet10, SectionModel::kSolid}, 3);
  const QuadraticMesh small = QuadraticMesh::InBlocks(mesh);
  EXPECT_EQ(small.Blocks().blocks.size(), 1U);
  EXPECT_EQ(small.Positions(), mesh.nodes.data());
}

}  // namespace
}  // namespace elastimate
