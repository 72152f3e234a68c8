#include "elastimate/core/stiffness_product.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <vector>

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

  // Largest entry of |K| |q|: what rounding is relative to.
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

// K = s (H + nu J) is Hooke's law, for any E and nu.
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
    // Differences of equal numbers have no rounding.
    EXPECT_TRUE(products.h.isZero(0));
    EXPECT_TRUE(products.j.isZero(0));
  }
}

TEST_F(StiffnessProduct, OfAnInfinitesimalRotationIsZero) {
  for (int axis = 0; axis < 3; ++axis) {
    Eigen::Matrix3Xd q = mesh_.nodes;
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

// Of q . H q: the energy of a deformation is positive.
TEST_F(StiffnessProduct, OfHIsPositiveSemidefinite) {
  const StiffnessProducts products = MultiplyStiffnessBasis(mesh_, q_);
  for (Eigen::Index i = 0; i < q_.cols(); ++i) {
    EXPECT_GT(q_.col(i).dot(products.h.col(i)), 0);
  }
}

// The patch test: a uniform stress is in equilibrium inside, whatever the
// elements.
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

}  // namespace
}  // namespace elastimate
