#include "elastimate/estimators/plan/expected_errors.h"

#include <cmath>
#include <limits>

#include "elastimate/core/algebra/dense_algebra.h"

namespace elastimate {
namespace {

// A ratio of informations that comes from rounding.
constexpr double kRoundingOfInformation = 1e-13;
// A combination with less along directions that are not determined has none.
constexpr double kNoPartOfCombination = 1e-6;
constexpr double kRoundingOfErrors = 1e-6;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace

ExpectedErrors ExpectedErrors::Of(const Eigen::MatrixXd& information) {
  const SymmetricEigenDecomposition eigen = DecomposeSymmetric(information);
  const double rounding = kRoundingOfInformation * eigen.values.tail(1)(0);
  ExpectedErrors errors = {eigen.values, eigen.vectors};
  for (double& value : errors.standard_errors) {
    value = value > rounding ? 1 / std::sqrt(value) : kInfinity;
  }
  // The sign says nothing: the largest share of each is positive.
  for (auto direction : errors.directions.colwise()) {
    Eigen::Index largest = 0;
    direction.cwiseAbs().maxCoeff(&largest);
    direction *= direction(largest) < 0 ? -1 : 1;
  }
  return errors;
}

Eigen::Index ExpectedErrors::NumUndetermined() const {
  return (standard_errors.array() == kInfinity).count();
}

double ExpectedErrors::Along(const Eigen::VectorXd& combination) const {
  const Eigen::VectorXd shares = directions.transpose() * combination;
  const Eigen::Index undetermined = NumUndetermined();
  if (shares.head(undetermined).norm() >
      kNoPartOfCombination * combination.norm()) {
    return kInfinity;
  }
  const Eigen::Index determined = shares.size() - undetermined;
  return shares.tail(determined)
      .cwiseProduct(standard_errors.tail(determined))
      .norm();
}

Eigen::VectorXd ExpectedErrors::OfParameters() const {
  const Eigen::Index n = standard_errors.size();
  Eigen::VectorXd errors(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    errors(i) = Along(Eigen::VectorXd::Unit(n, i));
  }
  return errors;
}

bool ExpectedErrors::AreSmallerThan(const ExpectedErrors& others) const {
  const Eigen::Index undetermined = NumUndetermined();
  if (undetermined != others.NumUndetermined()) {
    return undetermined < others.NumUndetermined();
  }
  return undetermined < standard_errors.size() &&
         standard_errors(undetermined) <
             (1 - kRoundingOfErrors) * others.standard_errors(undetermined);
}

}  // namespace elastimate
