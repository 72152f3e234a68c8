#include "elastimate/estimators/force_balance/free_direction.h"

#include "elastimate/core/algebra/dense_algebra.h"

namespace elastimate {

double LeastSingularValue(const Eigen::MatrixXd& columns) {
  const Eigen::VectorXd scales = columns.colwise().norm();
  if (!(scales.minCoeff() > 0)) {
    return 0;
  }
  return DecomposeSingularValues(columns * scales.cwiseInverse().asDiagonal())
      .values(columns.cols() - 1);
}

bool NoteFreeDirection(const Eigen::MatrixXd& derivatives, double rounding,
                       const FreeParameters& free, const Estimate& estimate,
                       Evidence& evidence) {
  if (LeastSingularValue(derivatives) > rounding) {
    return false;
  }
  const Eigen::VectorXd scales = derivatives.colwise().norm();
  const std::vector<ParameterEstimate>& parameters = estimate.parameters;
  if (scales.minCoeff() > 0 && free.Size() == 2 && parameters.size() == 2 &&
      parameters[0].symbol == "E" && parameters[1].symbol == "nu") {
    const SingularValueDecomposition svd = DecomposeSingularValues(
        derivatives * scales.cwiseInverse().asDiagonal());
    const Eigen::Vector2d direction = svd.v.col(1).cwiseQuotient(scales);
    evidence.free_direction = {{parameters[0].value, parameters[1].value},
                               direction / direction(1)};
  } else {
    evidence.are_forces_dependent = true;
  }
  return true;
}

}  // namespace elastimate
