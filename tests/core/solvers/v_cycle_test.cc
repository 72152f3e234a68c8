#include "elastimate/core/solvers/v_cycle.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "tests/core/random_values.h"
#include "tests/dense_reference.h"

namespace elastimate {
namespace {

using testing::RandomMatrix;

// An elastic string of n springs between walls, with three spaces.
class VCycleOfAString : public ::testing::Test {
 protected:
  VCycleOfAString() {
    // Bases of hat functions: each second node of a space is in the next one.
    Eigen::MatrixXd k = Stiffness(63);
    std::vector<CycleSpace> spaces;
    for (int n = 63; n > 15; n = (n - 1) / 2) {
      const Eigen::MatrixXd p = Interpolation(n);
      spaces.insert(spaces.begin(), Space(k, p));
      k = p.transpose() * k * p;
    }
    coarsest_ = k;
    spaces_ = spaces;
  }

  static Eigen::MatrixXd Stiffness(int n) {
    Eigen::MatrixXd k = 2 * Eigen::MatrixXd::Identity(n, n);
    k.diagonal(1).setConstant(-1);
    k.diagonal(-1).setConstant(-1);
    return k;
  }

  static Eigen::MatrixXd Interpolation(int n) {
    Eigen::MatrixXd p = Eigen::MatrixXd::Zero(n, (n - 1) / 2);
    for (Eigen::Index j = 0; j < p.cols(); ++j) {
      p.col(j).segment<3>(2 * j) << 0.5, 1, 0.5;
    }
    return p;
  }

  static CycleSpace Space(const Eigen::MatrixXd& k, const Eigen::MatrixXd& p) {
    CycleSpace space;
    space.multiply = [k](const Eigen::MatrixXd& x) {
      return Eigen::MatrixXd(k * x);
    };
    space.inverse_blocks = InverseBlocks(k.diagonal().transpose());
    int products = 0;
    space.largest_eigenvalue =
        LargestEigenvalue(space.multiply, space.inverse_blocks, products);
    space.restrict = [p](const Eigen::MatrixXd& x) {
      return Eigen::MatrixXd(p.transpose() * x);
    };
    space.interpolate = [p](const Eigen::MatrixXd& x) {
      return Eigen::MatrixXd(p * x);
    };
    return space;
  }

  Eigen::MatrixXd Cycle(const Eigen::MatrixXd& force) const {
    return VCycle(
        spaces_,
        [&](const Eigen::MatrixXd& x) {
          return testing::SolveDensely(coarsest_, x);
        },
        force);
  }

  std::vector<CycleSpace> spaces_;
  Eigen::MatrixXd coarsest_;
};

TEST_F(VCycleOfAString, IsSymmetric) {
  const Eigen::MatrixXd cycle = Cycle(Eigen::MatrixXd::Identity(63, 63));
  EXPECT_LE((cycle - cycle.transpose()).norm(), 1e-12 * cycle.norm());
}

TEST_F(VCycleOfAString, LeavesATenthOfTheError) {
  const Eigen::MatrixXd k = Stiffness(63);
  const Eigen::VectorXd exact = RandomMatrix(63, 1, 1);
  const Eigen::VectorXd error = exact - Cycle(k * exact);
  EXPECT_LE(error.dot(k * error), 0.01 * exact.dot(k * exact));
}

TEST_F(VCycleOfAString, SolvesWhereThereAreNoFinerSpaces) {
  spaces_.clear();
  const Eigen::VectorXd exact = RandomMatrix(coarsest_.rows(), 1, 1);
  EXPECT_TRUE(Cycle(coarsest_ * exact).isApprox(exact, 1e-12));
}

TEST(LargestEigenvalue, IsAtMostATenthTooSmall) {
  const Eigen::VectorXd values = Eigen::VectorXd::LinSpaced(200, 0.01, 3);
  int products = 0;
  const double largest = LargestEigenvalue(
      [&](const Eigen::MatrixXd& x) {
        return Eigen::MatrixXd(values.asDiagonal() * x);
      },
      Eigen::MatrixXf::Ones(1, 200), products);
  EXPECT_GE(largest, 0.9 * 3);
  EXPECT_LE(largest, 3 + 1e-12);
  EXPECT_EQ(products, 1 + 6);
}

TEST(LargestEigenvalue, IsNotANumberForANegativeMatrix) {
  int products = 0;
  EXPECT_TRUE(std::isnan(LargestEigenvalue(
      [](const Eigen::MatrixXd& x) { return Eigen::MatrixXd(-x); },
      Eigen::MatrixXf::Ones(1, 5), products)));
}

TEST(InverseBlocks, AreZeroWhereComponentsAreHeld) {
  Eigen::MatrixXd blocks(2, 6);
  blocks << 2, 1, 4, 2, 5, 2, 1, 2, 2, 4, 2, 3;
  Eigen::MatrixXf expected = Eigen::MatrixXf::Zero(2, 6);
  expected.leftCols<2>() << 2, -1, -1, 2;
  expected.leftCols<2>() /= 3;
  expected(1, 3) = 0.25;
  Eigen::MatrixXf inverses = InverseBlocks(blocks);
  HoldInInverses({2, 4, 5}, inverses);
  EXPECT_TRUE(inverses.isApprox(expected, 1e-6F));
  EXPECT_EQ(inverses.rightCols<2>(), Eigen::Matrix2f::Zero());
}

}  // namespace
}  // namespace elastimate
