#include "elastimate/core/solvers/conjugate_gradients.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/core/random_values.h"
#include "tests/dense_reference.h"
#include "tests/scenes.h"

namespace elastimate {
namespace {

using testing::RandomMatrix;

class ConjugateGradients : public ::testing::Test {
 protected:
  // Returns a reflection, which is orthogonal.
  static Eigen::MatrixXd EigenvectorsOf(Eigen::Index size) {
    const Eigen::VectorXd v = RandomMatrix(size, 1, 5).col(0).normalized();
    return Eigen::MatrixXd::Identity(size, size) - 2 * v * v.transpose();
  }

  // Returns a symmetric matrix with these eigenvalues.
  static Eigen::MatrixXd WithEigenvalues(const Eigen::VectorXd& values) {
    const Eigen::MatrixXd vectors = EigenvectorsOf(values.size());
    return vectors * values.asDiagonal() * vectors.transpose();
  }

  ConjugateGradientResult Solve(const Eigen::MatrixXd& b,
                                const Eigen::MatrixXd& start = {}) const {
    return SolveByConjugateGradients(
        [&](const Eigen::MatrixXd& x) { return Eigen::MatrixXd(a_ * x); },
        [&](const Eigen::MatrixXd& x) {
          return Eigen::MatrixXd(preconditioner_ * x);
        },
        b, start, options_);
  }

  // Returns the error in the energy norm, relative to the solution.
  double Error(const Eigen::VectorXd& x, const Eigen::VectorXd& b) const {
    const Eigen::VectorXd expected = testing::SolveDensely(a_, b);
    const Eigen::VectorXd error = x - expected;
    return std::sqrt(error.dot(a_ * error) / expected.dot(b));
  }

  Eigen::MatrixXd a_ =
      WithEigenvalues(Eigen::VectorXd::LinSpaced(40, 0.05, 1.0));
  Eigen::MatrixXd preconditioner_ = Eigen::MatrixXd::Identity(40, 40);
  Eigen::MatrixXd b_ = RandomMatrix(40, 3, 1);
  ConjugateGradientOptions options_;
};

TEST_F(ConjugateGradients, SolveToTheTolerance) {
  for (const double tolerance : {1e-2, 1e-5, 1e-8}) {
    options_.tolerance = tolerance;
    const ConjugateGradientResult result = Solve(b_);
    ASSERT_TRUE(result.has_converged);
    for (Eigen::Index k = 0; k < b_.cols(); ++k) {
      const double error = Error(result.solution.col(k), b_.col(k));
      EXPECT_LE(error, tolerance);
      // The next iteration is not for nothing.
      EXPECT_GE(error, 1e-2 * tolerance);
    }
  }
}

TEST_F(ConjugateGradients, SeeTheEigenvalues) {
  const ConjugateGradientResult result = Solve(b_);
  EXPECT_NEAR(result.smallest_eigenvalue, 0.05, 1e-3);
  EXPECT_NEAR(result.largest_eigenvalue, 1, 1e-3);
}

TEST_F(ConjugateGradients, TreatColumnsAsIfEachWereAlone) {
  Eigen::MatrixXd b = b_;
  // Columns that are done at other times than their neighbours.
  b.col(1) = a_ * a_.col(0);
  b.col(2).setZero();
  const ConjugateGradientResult all = Solve(b);
  ASSERT_TRUE(all.has_converged);
  EXPECT_TRUE(all.solution.col(2).isZero(0));
  int iterations = 0;
  for (Eigen::Index k = 0; k < b.cols(); ++k) {
    const ConjugateGradientResult one = Solve(b.col(k));
    iterations += one.iterations;
    EXPECT_LE((one.solution - all.solution.col(k)).norm(),
              1e-6 * all.solution.col(k).norm());
  }
  // Each may be let go later by what the others tell of the eigenvalues.
  EXPECT_NEAR(all.iterations, iterations, 3);
}

// A column in the space of n eigenvectors is done after n iterations.
TEST_F(ConjugateGradients, LetColumnsGoAtDifferentSteps) {
  const Eigen::VectorXd values = Eigen::VectorXd::LinSpaced(40, 0.05, 1.0);
  const Eigen::MatrixXd vectors = EigenvectorsOf(40);
  const std::vector<int> num_vectors = {40, 1, 0, 7, 3};
  Eigen::MatrixXd b = Eigen::MatrixXd::Zero(40, 5);
  Eigen::MatrixXd expected = b;
  for (Eigen::Index k = 0; k < b.cols(); ++k) {
    for (int i = 0; i < num_vectors[k]; ++i) {
      // Some columns are far larger than others.
      const double factor = std::pow(1e3, double(k)) * (1 + i % 3);
      const int place = (11 * i + int(k)) % 40;
      b.col(k) += factor * vectors.col(place);
      expected.col(k) += factor / values(place) * vectors.col(place);
    }
  }
  const ConjugateGradientResult all = Solve(b);
  ASSERT_TRUE(all.has_converged);
  EXPECT_EQ(all.columns, 4);
  EXPECT_TRUE(all.solution.col(2).isZero(0));
  for (Eigen::Index k = 0; k < b.cols(); ++k) {
    const ConjugateGradientResult alone = Solve(b.col(k));
    ASSERT_TRUE(alone.has_converged);
    if (k != 0) {
      EXPECT_EQ(alone.iterations, num_vectors[k]);
    }
    for (const Eigen::VectorXd& x : {Eigen::VectorXd(all.solution.col(k)),
                                     Eigen::VectorXd(alone.solution.col(0))}) {
      const Eigen::VectorXd error = x - expected.col(k);
      EXPECT_LE(std::sqrt(error.dot(a_ * error)),
                options_.tolerance * std::sqrt(expected.col(k).dot(b.col(k))))
          << "column " << k;
    }
  }
}

TEST_F(ConjugateGradients, TakeTheBestMultipleOfAGuess) {
  const Eigen::MatrixXd solution = testing::SolveDensely(a_, b_);
  EXPECT_EQ(Solve(b_, -7 * solution).iterations, 0);
  const ConjugateGradientResult cold = Solve(b_);
  const ConjugateGradientResult warm =
      Solve(b_, 3 * solution + 1e-4 * RandomMatrix(40, 3, 2));
  ASSERT_TRUE(warm.has_converged);
  EXPECT_LT(warm.iterations, cold.iterations);
  EXPECT_LT(Error(warm.solution.col(0), b_.col(0)), options_.tolerance);
  EXPECT_TRUE(
      Solve(b_, Eigen::MatrixXd::Constant(40, 3, testing::kNan)).has_converged);
}

TEST_F(ConjugateGradients, FollowAPreconditionerThatChangesALittle) {
  int calls = 0;
  const ConjugateGradientResult result = SolveByConjugateGradients(
      [&](const Eigen::MatrixXd& x) { return Eigen::MatrixXd(a_ * x); },
      [&](const Eigen::MatrixXd& x) {
        ++calls;
        return Eigen::MatrixXd(
            x + 0.02 * RandomMatrix(40, 1, 10 + calls).col(0).asDiagonal() * x);
      },
      b_, {}, options_);
  ASSERT_TRUE(result.has_converged);
  EXPECT_LT(Error(result.solution.col(0), b_.col(0)), 2 * options_.tolerance);
}

TEST_F(ConjugateGradients, EndWellWithoutASolution) {
  options_.most_iterations = 2;
  EXPECT_FALSE(Solve(b_).has_converged);
  EXPECT_EQ(Solve(b_).iterations, 6);
  options_.most_iterations = 200;
  a_ = -a_;
  EXPECT_FALSE(Solve(b_).has_converged);
  a_ = Eigen::MatrixXd::Zero(40, 40);
  EXPECT_FALSE(Solve(b_).has_converged);
  a_.setConstant(testing::kNan);
  EXPECT_FALSE(Solve(b_).has_converged);
  EXPECT_TRUE(Solve(Eigen::MatrixXd(40, 0)).has_converged);
}

}  // namespace
}  // namespace elastimate
