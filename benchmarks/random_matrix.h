#ifndef ELASTIMATE_BENCHMARKS_RANDOM_MATRIX_H_
#define ELASTIMATE_BENCHMARKS_RANDOM_MATRIX_H_

#include <Eigen/Core>
#include <cstdint>
#include <random>

#include "elastimate/core/algebra/large_pages.h"

namespace elastimate {

/// Independent values, uniform in [-1, 1); the same for a seed on every run.
/// In large pages, as the estimators have their columns.
inline Eigen::MatrixXd RandomMatrix(Eigen::Index rows, Eigen::Index columns,
                                    std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  Eigen::MatrixXd matrix;
  ResizeInLargePages(rows, columns, matrix);
  for (double& value : matrix.reshaped()) {
    value = uniform(generator);
  }
  return matrix;
}

}  // namespace elastimate

#endif  // ELASTIMATE_BENCHMARKS_RANDOM_MATRIX_H_
