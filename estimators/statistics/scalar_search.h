#ifndef ELASTIMATE_ESTIMATORS_STATISTICS_SCALAR_SEARCH_H_
#define ELASTIMATE_ESTIMATORS_STATISTICS_SCALAR_SEARCH_H_

#include <Eigen/Core>
#include <functional>

namespace elastimate {

// The search over one number: a scan of its range, and what lies between two
// points of the scan.

/// `count` values of nu from `lower` to `upper`, both exactly, even in
/// LogStiffnessRatio.  Precondition: -1 < lower <= upper < 1/2, count >= 2.
Eigen::VectorXd EvenPoissonRatios(double lower, double upper,
                                  Eigen::Index count);

/// A zero of the continuous f between `a` and `b`, in any order, up to
/// `tolerance` > 0; f_a = f(a) and f_b = f(b) are known.  Algorithm 748
/// [Alefeld, Potra & Shi, ACM Trans. Math. Softw. 21 (1995) 327]: less than ten
/// evaluations where f is smooth, 60 at most.
///
/// Where f_a and f_b have the same sign, the way from `a` to `b` is halved
/// until a change of signs is met; it ends at `b` where none is.
double ZeroBetween(const std::function<double(double)>& f, double a, double f_a,
                   double b, double f_b, double tolerance);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_STATISTICS_SCALAR_SEARCH_H_
