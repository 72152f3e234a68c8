#include "elastimate/core/mechanics/stiffness_traces.h"

#include <gtest/gtest.h>

#include <cmath>

#include "elastimate/core/mechanics/internal_forces.h"
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

class Traces : public ::testing::TestWithParam<int> {
 protected:
  Traces()
      : mesh_(
            WithBothOrientations(Distorted(BoxMesh({3, 2, 3}, {1, 0.8, 1.2})))),
        held_(RandomSupports(mesh_.NumNodes(), GetParam()).held),
        dofs_(RandomSupports(mesh_.NumNodes(), GetParam())),
        h_(DenseStiffness<double>(mesh_, DenseDH())(dofs_.free, dofs_.free)),
        j_(DenseStiffness<double>(mesh_, DenseDJ())(dofs_.free, dofs_.free)) {}

  Mesh mesh_;
  ComponentMask held_;
  DegreesOfFreedom dofs_;
  Eigen::MatrixXd h_;
  Eigen::MatrixXd j_;
};

TEST_P(Traces, EqualTheSumsOverTheFreeRowsAndColumns) {
  const Eigen::Matrix2d traces =
      StiffnessTraces(mesh_, InternalForces(mesh_, {}), dofs_);
  Eigen::Matrix2d expected;
  expected(0, 0) = h_.squaredNorm();
  expected(0, 1) = h_.cwiseProduct(j_).sum();
  expected(1, 0) = expected(0, 1);
  expected(1, 1) = j_.squaredNorm();
  // Thousands of terms, of which each has rounded at 1e-14 or better.
  EXPECT_LT((traces - expected).cwiseAbs().maxCoeff(), 1e-12 * expected(1, 1));
  EXPECT_EQ(traces(0, 1), traces(1, 0));
}

Eigen::Matrix2d Estimated(const Mesh& mesh, const ComponentMask& held,
                          const DegreesOfFreedom& dofs) {
  Eigen::MatrixXd probes(held.size(), 2);
  SetTraceProbes(held, probes);
  return EstimateStiffnessTraces(dofs,
                                 InternalForces(mesh, {}).Products(probes));
}

// With signs z, z^T M z has the variance 2 sum of the squared off-diagonal
// values of the symmetric part of M [Hutchinson 1990].
TEST_P(Traces, EstimateIsWithinFiveStandardDeviations) {
  constexpr double kNumProbes = 2;
  const Eigen::Matrix2d exact =
      StiffnessTraces(mesh_, InternalForces(mesh_, {}), dofs_);
  const Eigen::Matrix2d estimate = Estimated(mesh_, held_, dofs_);
  const Eigen::MatrixXd* const bases[2] = {&h_, &j_};
  for (int row = 0; row < 2; ++row) {
    for (int column = 0; column < 2; ++column) {
      const Eigen::MatrixXd product = *bases[row] * *bases[column];
      Eigen::MatrixXd off_diagonal = (product + product.transpose()) / 2;
      off_diagonal.diagonal().setZero();
      const double sd = std::sqrt(2 * off_diagonal.squaredNorm() / kNumProbes);
      EXPECT_NEAR(estimate(row, column), exact(row, column), 5 * sd);
      // The bound of the header, with the factor that "about" stands for.
      EXPECT_LT(sd, 2 * std::abs(exact(row, column)) /
                        std::sqrt(static_cast<double>(dofs_.NumFree())));
    }
  }
  EXPECT_EQ(estimate(0, 1), estimate(1, 0));
}

TEST_P(Traces, EstimateIsDeterministic) {
  EXPECT_EQ(Estimated(mesh_, held_, dofs_), Estimated(mesh_, held_, dofs_));
}

INSTANTIATE_TEST_SUITE_P(RandomSupports, Traces, ::testing::Range(1, 6));

}  // namespace
}  // namespace elastimate
