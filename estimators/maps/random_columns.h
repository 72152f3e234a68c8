#ifndef ELASTIMATE_ESTIMATORS_MAPS_RANDOM_COLUMNS_H_
#define ELASTIMATE_ESTIMATORS_MAPS_RANDOM_COLUMNS_H_

#include <Eigen/Core>
#include <cmath>
#include <random>

namespace elastimate {

/// Returns independent standard normal numbers that are the same in every run
/// and on every machine: the generator is that of the standard, and the
/// transform is that of Box and Muller, as std::normal_distribution may differ
/// between libraries.
inline Eigen::MatrixXd StandardNormal(Eigen::Index num_rows,
                                      Eigen::Index num_columns,
                                      std::mt19937_64& generator) {
  constexpr double kTwoPi = 6.28318530717958647692;
  const auto uniform = [&] {
    return (static_cast<double>(generator() >> 11) + 0.5) * 0x1p-53;
  };
  return Eigen::MatrixXd::NullaryExpr(num_rows, num_columns, [&] {
    const double radius = std::sqrt(-2 * std::log(uniform()));
    return radius * std::cos(kTwoPi * uniform());
  });
}

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_MAPS_RANDOM_COLUMNS_H_
