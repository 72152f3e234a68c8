#ifndef ELASTIMATE_ESTIMATORS_MISFIT_LEAST_SQUARE_SUM_H_
#define ELASTIMATE_ESTIMATORS_MISFIT_LEAST_SQUARE_SUM_H_

#include <Eigen/Core>

#include "elastimate/estimators/interface/free_parameters.h"

namespace elastimate {

/// Moves variables x as far as their bounds allow, and stops short of a bound.
[[nodiscard]] Eigen::VectorXd Moved(const FreeParameters& free,
                                    const Eigen::VectorXd& x,
                                    const Eigen::VectorXd& move);

/// The least of |r + S d|^2 over the changes d of variables, and d there.
struct Least {
  double square_sum;
  Eigen::VectorXd change;
};

/// The least where a^T d = 0; `information` is S^T S, with what is known
/// beforehand.
[[nodiscard]] Least LeastSquareSum(const Eigen::VectorXd& rows,
                                   const Eigen::MatrixXd& sensitivities,
                                   const Eigen::MatrixXd& information,
                                   const Eigen::VectorXd& a);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_MISFIT_LEAST_SQUARE_SUM_H_
