#include "elastimate/core/mechanics/stiffness_product.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdint>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include "tests/core/instruction_sets.h"
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
using testing::RandomMatrix;
using testing::WithBothOrientations;

// A row sums some hundred products that have each lost one or two digits to
// the differences of node positions.
constexpr double kRounding = 1e-13;

class StiffnessProduct : public ::testing::Test {
 protected:
  StiffnessProduct()
      : reference_(BoxMesh({3, 2, 3}, {1, 0.8, 1.2})),
        mesh_(WithBothOrientations(Distorted(reference_))),
        dense_h_(DenseStiffness<double>(mesh_, DenseDH())),
        dense_j_(DenseStiffness<double>(mesh_, DenseDJ())),
        q_(RandomMatrix(3 * mesh_.NumNodes(), 3, 1)) {}

  // Returns the largest entry of |K| |q|, to which rounding errors are
  // relative.
  double Scale(const Eigen::MatrixXd& q) const {
    return (dense_j_.cwiseAbs() * q.cwiseAbs()).maxCoeff();
  }

  Mesh reference_;
  Mesh mesh_;
  Eigen::MatrixXd dense_h_;
  Eigen::MatrixXd dense_j_;
  Eigen::MatrixXd q_;
};

TEST_F(StiffnessProduct, EqualsTheTextbookStiffness) {
  const StiffnessProducts products = MultiplyStiffnessBasis(mesh_, q_);
  const double tolerance = kRounding * Scale(q_);
  EXPECT_LT((products.h - dense_h_ * q_).cwiseAbs().maxCoeff(), tolerance);
  EXPECT_LT((products.j - dense_j_ * q_).cwiseAbs().maxCoeff(), tolerance);
}

// K = s (H + nu J) is the stiffness of Hooke's law for any E and nu.
TEST_F(StiffnessProduct, BasisSpansEveryStiffness) {
  const StiffnessProducts products = MultiplyStiffnessBasis(mesh_, q_);
  for (const double nu : {-0.9, -0.5, 0.0, 0.3, 0.49, 0.499}) {
    const double youngs = 7;
    const Eigen::Matrix<double, 6, 6> hooke = testing::HookeMatrix(youngs, nu);
    const Eigen::MatrixXd force = DenseStiffness<double>(mesh_, hooke) * q_;
    const double s = youngs / ((1 + nu) * (1 - 2 * nu));
    EXPECT_LT((s * (products.h + nu * products.j) - force).norm(),
              kRounding * s * Scale(q_) * 10)
        << nu;
  }
}

TEST_F(StiffnessProduct, OfSeveralColumnsIsThatOfEachBitForBit) {
  const StiffnessProducts all = MultiplyStiffnessBasis(mesh_, q_);
  for (Eigen::Index i = 0; i < q_.cols(); ++i) {
    const StiffnessProducts one = MultiplyStiffnessBasis(mesh_, q_.col(i));
    EXPECT_EQ(one.h, all.h.col(i));
    EXPECT_EQ(one.j, all.j.col(i));
  }
  const StiffnessProducts again = MultiplyStiffnessBasis(mesh_, q_);
  EXPECT_EQ(again.h, all.h);
  EXPECT_EQ(again.j, all.j);
}

TEST_F(StiffnessProduct, OfNoColumnsIsEmpty) {
  const StiffnessProducts none =
      MultiplyStiffnessBasis(mesh_, Eigen::MatrixXd(q_.rows(), 0));
  EXPECT_EQ(none.h.rows(), q_.rows());
  EXPECT_EQ(none.h.cols(), 0);
  EXPECT_EQ(none.j.cols(), 0);
}

TEST_F(StiffnessProduct, OfATranslationIsZero) {
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::VectorXd q =
        (1e3 * Eigen::Vector3d::Unit(axis)).replicate(mesh_.NumNodes(), 1);
    const StiffnessProducts products = MultiplyStiffnessBasis(mesh_, q);
    // Differences of equal numbers are exactly zero, without rounding.
    EXPECT_TRUE(products.h.isZero(0));
    EXPECT_TRUE(products.j.isZero(0));
  }
}

TEST_F(StiffnessProduct, OfAnInfinitesimalRotationIsZero) {
  for (int axis = 0; axis < 3; ++axis) {
    Eigen::MatrixXd q = mesh_.nodes;
    for (auto column : q.colwise()) {
      column =
          Eigen::Vector3d::Unit(axis).cross(Eigen::Vector3d(column)).eval();
    }
    const StiffnessProducts products =
        MultiplyStiffnessBasis(mesh_, q.reshaped());
    const double tolerance = kRounding * Scale(q.reshaped());
    EXPECT_LT(products.h.cwiseAbs().maxCoeff(), tolerance);
    EXPECT_LT(products.j.cwiseAbs().maxCoeff(), tolerance);
  }
}

TEST_F(StiffnessProduct, IsSymmetric) {
  const StiffnessProducts products = MultiplyStiffnessBasis(mesh_, q_);
  const double tolerance =
      kRounding * Scale(q_) * static_cast<double>(q_.rows());
  for (const Eigen::MatrixXd& gram :
       {Eigen::MatrixXd(q_.transpose() * products.h),
        Eigen::MatrixXd(q_.transpose() * products.j)}) {
    EXPECT_LT((gram - gram.transpose()).cwiseAbs().maxCoeff(), tolerance);
  }
}

// q . H q is the energy of a deformation at nu = 0, which is positive.
TEST_F(StiffnessProduct, OfHIsPositiveSemidefinite) {
  const StiffnessProducts products = MultiplyStiffnessBasis(mesh_, q_);
  for (Eigen::Index i = 0; i < q_.cols(); ++i) {
    EXPECT_GT(q_.col(i).dot(products.h.col(i)), 0);
  }
}

// This is the patch test: a uniform stress is in equilibrium inside, whatever
// the elements.
TEST_F(StiffnessProduct, OfALinearFieldIsZeroAtInteriorNodes) {
  Eigen::Matrix3d gradient;
  gradient << 0.1, 0.2, -0.3, 0.4, -0.5, 0.6, 0.7, 0.8, 0.9;
  const Eigen::VectorXd q = (gradient * mesh_.nodes).reshaped();
  const StiffnessProducts products = MultiplyStiffnessBasis(mesh_, q);
  std::vector<bool> on_boundary(mesh_.NumNodes(), false);
  const Eigen::MatrixXi facets = BoundaryFacets(mesh_);
  for (const int node : facets.reshaped()) {
    on_boundary[node] = true;
  }
  int num_interior = 0;
  const double tolerance = kRounding * Scale(q);
  for (Eigen::Index node = 0; node < mesh_.NumNodes(); ++node) {
    if (!on_boundary[node]) {
      ++num_interior;
      EXPECT_LT(products.h.middleRows<3>(3 * node).norm(), tolerance);
      EXPECT_LT(products.j.middleRows<3>(3 * node).norm(), tolerance);
    }
  }
  EXPECT_EQ(num_interior, 2 * 1 * 2);
  EXPECT_GT(products.h.norm(), 0.01);
}

// H and J have the dimension of a length; a power of two is exact.
TEST_F(StiffnessProduct, ScalesWithLengthAndDisplacement) {
  const StiffnessProducts products = MultiplyStiffnessBasis(mesh_, q_);
  Mesh large = mesh_;
  large.nodes *= 1024;
  const StiffnessProducts of_large = MultiplyStiffnessBasis(large, q_);
  EXPECT_EQ(of_large.h, 1024 * products.h);
  EXPECT_EQ(of_large.j, 1024 * products.j);
  const StiffnessProducts of_small = MultiplyStiffnessBasis(mesh_, q_ / 4096);
  EXPECT_EQ(of_small.h, products.h / 4096);
  EXPECT_EQ(of_small.j, products.j / 4096);
}

TEST_F(StiffnessProduct, DoesNotDependOnTheOrderOfAnElementsNodes) {
  const StiffnessProducts products = MultiplyStiffnessBasis(mesh_, q_);
  Mesh turned = mesh_;
  turned.elements.row(0).swap(turned.elements.row(2));
  turned.elements.row(1).swap(turned.elements.row(2));
  const StiffnessProducts of_turned = MultiplyStiffnessBasis(turned, q_);
  const double tolerance = kRounding * Scale(q_);
  EXPECT_LT((of_turned.h - products.h).cwiseAbs().maxCoeff(), tolerance);
  EXPECT_LT((of_turned.j - products.j).cwiseAbs().maxCoeff(), tolerance);
}

using ProductByInstructionSet = testing::InstructionSet;

// The last batch of elements and the last block of columns may be full or not.
TEST_P(ProductByInstructionSet, EqualsTheTextbookStiffnessForAnyCount) {
  const Mesh whole =
      WithBothOrientations(Distorted(BoxMesh({2, 2, 1}, {1, 0.8, 1.2})));
  const Eigen::MatrixXd q = RandomMatrix(3 * whole.NumNodes(), 17, 2);
  for (int num_elements = 1; num_elements <= 20; ++num_elements) {
    Mesh mesh = whole;
    mesh.elements.conservativeResize(4, num_elements);
    const Eigen::MatrixXd h = DenseStiffness<double>(mesh, DenseDH());
    const Eigen::MatrixXd j = DenseStiffness<double>(mesh, DenseDJ());
    const double tolerance =
        kRounding * (j.cwiseAbs() * q.cwiseAbs()).maxCoeff();
    for (const int num_columns : {1, 2, 3, 4, 5, 8, 9, 17}) {
      SCOPED_TRACE(std::to_string(num_elements) + " elements, " +
                   std::to_string(num_columns) + " columns");
      const Eigen::MatrixXd columns = q.leftCols(num_columns);
      const StiffnessProducts products = MultiplyStiffnessBasis(mesh, columns);
      EXPECT_LT((products.h - h * columns).cwiseAbs().maxCoeff(), tolerance);
      EXPECT_LT((products.j - j * columns).cwiseAbs().maxCoeff(), tolerance);
    }
  }
}

TEST_P(ProductByInstructionSet, OfSeveralColumnsIsThatOfEachBitForBit) {
  const Mesh mesh =
      WithBothOrientations(Distorted(BoxMesh({3, 2, 3}, {1, 0.8, 1.2})));
  const Eigen::MatrixXd q = RandomMatrix(3 * mesh.NumNodes(), 9, 3);
  const StiffnessProducts all = MultiplyStiffnessBasis(mesh, q);
  for (Eigen::Index i = 0; i < q.cols(); ++i) {
    const StiffnessProducts one = MultiplyStiffnessBasis(mesh, q.col(i));
    EXPECT_EQ(one.h, all.h.col(i));
    EXPECT_EQ(one.j, all.j.col(i));
  }
}

INSTANTIATE_TEST_SUITE_P(Supported, ProductByInstructionSet,
                         ::testing::ValuesIn(testing::InstructionSets()),
                         testing::InstructionSetName);

// The mesh has many blocks of elements, which threads share.
class LargeMesh : public ::testing::Test {
 protected:
  LargeMesh()
      : mesh_(Distorted(BoxMesh({16, 16, 40}, {1, 1, 3}))),
        q_(RandomMatrix(3 * mesh_.NumNodes(), 5, 4)),
        products_(MultiplyStiffnessBasis(mesh_, q_)) {}

  static std::vector<int> Shuffled(Eigen::Index size, std::uint32_t seed) {
    std::vector<int> order(size);
    std::iota(order.begin(), order.end(), 0);
    std::shuffle(order.begin(), order.end(), std::mt19937(seed));
    return order;
  }

  void ExpectSame(const StiffnessProducts& a, const StiffnessProducts& b) {
    const double tolerance = 1e-13 * a.h.cwiseAbs().maxCoeff();
    EXPECT_LT((a.h - b.h).cwiseAbs().maxCoeff(), tolerance);
    EXPECT_LT((a.j - b.j).cwiseAbs().maxCoeff(), tolerance);
  }

  Mesh mesh_;
  Eigen::MatrixXd q_;
  StiffnessProducts products_;
};

// The products are the sums of those of each element in a mesh of its own.
TEST_F(LargeMesh, ProductsAreSumsOverTheElements) {
  StiffnessProducts sum;
  sum.h.setZero(q_.rows(), q_.cols());
  sum.j = sum.h;
  Mesh one;
  one.nodes.resize(3, 4);
  one.elements = Eigen::Vector4i(0, 1, 2, 3);
  for (Eigen::Index e = 0; e < mesh_.NumElements(); ++e) {
    const Eigen::Vector4i nodes = mesh_.elements.col(e);
    Eigen::MatrixXd q(12, q_.cols());
    for (int i = 0; i < 4; ++i) {
      one.nodes.col(i) = mesh_.nodes.col(nodes(i));
      q.middleRows<3>(3 * i) = q_.middleRows<3>(3 * nodes(i));
    }
    const StiffnessProducts products = MultiplyStiffnessBasis(one, q);
    for (int i = 0; i < 4; ++i) {
      sum.h.middleRows<3>(3 * nodes(i)) += products.h.middleRows<3>(3 * i);
      sum.j.middleRows<3>(3 * nodes(i)) += products.j.middleRows<3>(3 * i);
    }
  }
  ExpectSame(products_, sum);
}

TEST_F(LargeMesh, OperatorHasTheSameBitsForAnyNumberOfThreads) {
  for (const int num_threads : {1, 2, 3, 16}) {
    SCOPED_TRACE(num_threads);
    const StiffnessOperator stiffness(mesh_, num_threads);
    EXPECT_FALSE(stiffness.IsReordered());
    // Multiply has to overwrite old values, whether their matrix has the right
    // shape or not.
    StiffnessProducts products{2 * q_, Eigen::MatrixXd::Ones(2, 2)};
    stiffness.Multiply(q_, products);
    EXPECT_EQ(products.h, products_.h);
    EXPECT_EQ(products.j, products_.j);
  }
}

TEST_F(LargeMesh, OperatorOrdersARandomNumberingAgain) {
  const std::vector<int> nodes = Shuffled(mesh_.NumNodes(), 1);
  const std::vector<int> elements = Shuffled(mesh_.NumElements(), 2);
  Mesh mesh = mesh_;
  Eigen::MatrixXd q(q_.rows(), q_.cols());
  StiffnessProducts expected{q, q};
  for (Eigen::Index i = 0; i < mesh_.NumNodes(); ++i) {
    mesh.nodes.col(nodes[i]) = mesh_.nodes.col(i);
    q.middleRows<3>(3 * nodes[i]) = q_.middleRows<3>(3 * i);
    expected.h.middleRows<3>(3 * nodes[i]) = products_.h.middleRows<3>(3 * i);
    expected.j.middleRows<3>(3 * nodes[i]) = products_.j.middleRows<3>(3 * i);
  }
  for (Eigen::Index e = 0; e < mesh_.NumElements(); ++e) {
    for (int i = 0; i < 4; ++i) {
      mesh.elements(i, e) = nodes[mesh_.elements(i, elements[e])];
    }
  }
  ExpectSame(expected, MultiplyStiffnessBasis(mesh, q));
  StiffnessProducts first;
  for (const int num_threads : {1, 2}) {
    const StiffnessOperator stiffness(mesh, num_threads);
    EXPECT_TRUE(stiffness.IsReordered());
    StiffnessProducts products;
    stiffness.Multiply(q, products);
    ExpectSame(expected, products);
    if (num_threads == 1) {
      first = products;
    }
    EXPECT_EQ(products.h, first.h);
    EXPECT_EQ(products.j, first.j);
  }
}

}  // namespace
}  // namespace elastimate
