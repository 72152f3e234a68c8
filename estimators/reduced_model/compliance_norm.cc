#include "elastimate/estimators/reduced_model/compliance_norm.h"

#include <cmath>
#include <limits>
#include <random>

#include "elastimate/core/algebra/dense_algebra.h"
#include "elastimate/core/algebra/node_sums.h"

namespace elastimate {
namespace {

// The share of the largest eigenvalue of a matrix of this size that may be
// missing after kComplianceSteps.
double MissingShare(Eigen::Index size) {
  constexpr double kProbability = 1e-3;
  const double exponent =
      std::log(1.648 * std::sqrt(static_cast<double>(size)) / kProbability) /
      (2 * kComplianceSteps - 1);
  return std::min(exponent * exponent, 0.9);
}

}  // namespace

double ComplianceNorm(const Eigen::VectorXd& weights, StiffnessSolver& solver) {
  constexpr double kTolerance = 1e-3;
  std::mt19937_64 generator(19920401);
  std::normal_distribution<double> normal;
  const DegreesOfFreedom& dofs = solver.Dofs();
  Eigen::VectorXd next =
      weights.cwiseProduct(dofs.Extend(Eigen::VectorXd::NullaryExpr(
          dofs.NumFree(), [&] { return normal(generator); })));
  Eigen::MatrixXd vectors(next.size(), 0);
  Eigen::MatrixXd t;
  for (int step = 0; step < kComplianceSteps; ++step) {
    const double norm = Norm(next);
    if (!(norm > 0)) {
      break;
    }
    vectors.conservativeResize(Eigen::NoChange, step + 1);
    vectors.col(step) = next / norm;
    next = weights.cwiseProduct(
        solver.Solve(weights.cwiseProduct(vectors.col(step)), kTolerance)
            .col(0));
    if (!next.allFinite()) {
      return std::numeric_limits<double>::infinity();
    }
    const Eigen::VectorXd column = InnerProducts(vectors, next);
    t.conservativeResize(step + 1, step + 1);
    t.col(step) = column;
    t.row(step) = column.transpose();
    next -= vectors * column;
    next -= vectors * (InnerProducts(vectors, next));
  }
  const double largest = DecomposeSymmetric(t).values.maxCoeff();
  return std::sqrt(largest / (1 - MissingShare(dofs.NumFree())));
}

}  // namespace elastimate
