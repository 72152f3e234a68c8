#include "elastimate/core/mechanics/stiffness_assembly.h"

#include <gtest/gtest.h>

#include <tuple>

#include "elastimate/core/mechanics/stiffness_product.h"
#include "tests/core/random_values.h"
#include "tests/dense_reference.h"
#include "tests/scenes.h"

namespace elastimate {
namespace {

using testing::BoxMesh;
using testing::DenseDH;
using testing::DenseDJ;
using testing::DenseStiffness;
using testing::Distorted;
using testing::RandomSupports;
using testing::WithBothOrientations;

Eigen::MatrixXd DenseLowerTriangle(const SymmetricPattern& pattern,
                                   const Eigen::VectorXd& values) {
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(pattern.Size(), pattern.Size());
  for (std::int64_t j = 0; j < pattern.Size(); ++j) {
    for (std::int64_t k = pattern.column_start[j];
         k < pattern.column_start[j + 1]; ++k) {
      dense(pattern.row[k], j) = values(k);
    }
  }
  return dense;
}

class Assembly : public ::testing::TestWithParam<int> {
 protected:
  Assembly()
      : mesh_(
            WithBothOrientations(Distorted(BoxMesh({2, 3, 2}, {1, 0.8, 1.2})))),
        dofs_(SupportsOfParameter()) {}

  // Seed 0: nothing is held.
  Supports SupportsOfParameter() const {
    Supports supports = RandomSupports(mesh_.NumNodes(), GetParam());
    if (GetParam() == 0) {
      supports.held.setConstant(false);
    }
    return supports;
  }

  Eigen::MatrixXd FreeLowerTriangle(
      const Mesh& mesh, const Eigen::Matrix<double, 6, 6>& d) const {
    const Eigen::MatrixXd all = DenseStiffness<double>(mesh, d);
    const Eigen::MatrixXd free = all(dofs_.free, dofs_.free);
    return free.triangularView<Eigen::Lower>();
  }

  // Rounding: sums of at most 24 elements, each with one or two digits lost to
  // the differences of node positions.
  static void ExpectSame(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
    ASSERT_EQ(a.rows(), b.rows());
    EXPECT_LT((a - b).cwiseAbs().maxCoeff(), 1e-13 * b.cwiseAbs().maxCoeff());
  }

  Mesh mesh_;
  DegreesOfFreedom dofs_;
};

TEST_P(Assembly, PatternIsALowerTriangleWithAscendingRows) {
  const StiffnessAssembly assembly(mesh_, dofs_);
  const SymmetricPattern& pattern = assembly.Pattern();
  ASSERT_EQ(pattern.Size(), dofs_.NumFree());
  EXPECT_EQ(pattern.column_start.front(), 0);
  EXPECT_EQ(pattern.column_start.back(),
            static_cast<std::int64_t>(pattern.row.size()));
  for (std::int64_t j = 0; j < pattern.Size(); ++j) {
    ASSERT_EQ(pattern.row[pattern.column_start[j]], j);
    for (std::int64_t k = pattern.column_start[j] + 1;
         k < pattern.column_start[j + 1]; ++k) {
      ASSERT_GT(pattern.row[k], pattern.row[k - 1]);
      ASSERT_LT(pattern.row[k], pattern.Size());
    }
  }
  EXPECT_EQ(assembly.H().size(), static_cast<Eigen::Index>(pattern.row.size()));
  EXPECT_EQ(assembly.J().size(), assembly.H().size());
}

TEST_P(Assembly, EqualsTheTextbookStiffness) {
  const StiffnessAssembly assembly(mesh_, dofs_);
  ExpectSame(DenseLowerTriangle(assembly.Pattern(), assembly.H()),
             FreeLowerTriangle(mesh_, DenseDH()));
  ExpectSame(DenseLowerTriangle(assembly.Pattern(), assembly.J()),
             FreeLowerTriangle(mesh_, DenseDJ()));
}

TEST_P(Assembly, CombinesIntoTheStiffnessOfANu) {
  const StiffnessAssembly assembly(mesh_, dofs_);
  StiffnessAssembly without_bases = assembly;
  without_bases.ForgetBases();
  for (const double nu : {-0.5, 0.0, 0.3, 0.49}) {
    const double scale = (1 + nu) * (1 - 2 * nu);
    const Eigen::MatrixXd expected =
        FreeLowerTriangle(mesh_, testing::HookeMatrix<double>(scale, nu));
    ExpectSame(DenseLowerTriangle(assembly.Pattern(), assembly.Combine(nu)),
               expected);
    ExpectSame(
        DenseLowerTriangle(assembly.Pattern(), without_bases.Combine(nu)),
        expected);
  }
}

INSTANTIATE_TEST_SUITE_P(RandomSupports, Assembly, ::testing::Range(0, 6));

// A x of the symmetric matrix A with these values.
Eigen::VectorXd Multiply(const SymmetricPattern& pattern,
                         const Eigen::VectorXd& values,
                         const Eigen::VectorXd& x) {
  Eigen::VectorXd product = Eigen::VectorXd::Zero(x.size());
  for (std::int64_t j = 0; j < pattern.Size(); ++j) {
    for (std::int64_t k = pattern.column_start[j];
         k < pattern.column_start[j + 1]; ++k) {
      const std::int64_t i = pattern.row[k];
      product(i) += values(k) * x(j);
      product(j) += i == j ? 0.0 : values(k) * x(i);
    }
  }
  return product;
}

// Whether or not later elements come back to the nodes of earlier ones.
TEST(StiffnessAssembly, OfALargeMeshMultipliesAsTheElementPassDoes) {
  const Mesh mesh = Distorted(BoxMesh({3, 4, 90}, {0.3, 0.4, 9}));
  Mesh reversed = mesh;
  reversed.elements = mesh.elements.rowwise().reverse().eval();
  Mesh mixed = mesh;
  for (Eigen::Index e = 0; e < mesh.NumElements() / 2; e += 2) {
    mixed.elements.col(e).swap(mixed.elements.col(mesh.NumElements() - 1 - e));
  }
  const DegreesOfFreedom dofs(RandomSupports(mesh.NumNodes(), 1));
  const Eigen::VectorXd x = testing::RandomMatrix(dofs.NumFree(), 1, 2);
  const StiffnessProducts expected =
      MultiplyStiffnessBasis(mesh, dofs.Extend(x));
  for (const Mesh& numbered : {mesh, reversed, mixed}) {
    const StiffnessAssembly assembly(numbered, dofs);
    EXPECT_TRUE(Multiply(assembly.Pattern(), assembly.H(), x)
                    .isApprox(dofs.Restrict(expected.h), 1e-12));
    EXPECT_TRUE(Multiply(assembly.Pattern(), assembly.J(), x)
                    .isApprox(dofs.Restrict(expected.j), 1e-12));
  }
}

TEST(StiffnessAssembly, OfOneTetrahedronWithOneFreeDegreeOfFreedom) {
  Mesh mesh;
  mesh.nodes.resize(3, 4);
  mesh.nodes << 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1;
  mesh.elements.resize(4, 1);
  mesh.elements << 3, 1, 0, 2;
  Supports supports{ComponentMask::Constant(3, 4, true),
                    Eigen::MatrixXd::Zero(3, 4)};
  supports.held(2, 3) = false;
  const StiffnessAssembly assembly(mesh, DegreesOfFreedom(supports));
  // N_3 = z: the strain is e_zz = 1 in a volume of 1/6.
  ASSERT_EQ(assembly.H().size(), 1);
  EXPECT_NEAR(assembly.H()(0), 1.0 / 6, 1e-15);
  EXPECT_NEAR(assembly.J()(0), -1.0 / 6, 1e-15);
}

}  // namespace
}  // namespace elastimate
