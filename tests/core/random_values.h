#ifndef ELASTIMATE_TESTS_CORE_RANDOM_VALUES_H_
#define ELASTIMATE_TESTS_CORE_RANDOM_VALUES_H_

#include <Eigen/Core>
#include <cstdint>
#include <random>

#include "elastimate/core/scene/scene.h"

namespace elastimate::testing {

/// Independent values, uniform in [-1, 1); the same on every run.
inline Eigen::MatrixXd RandomMatrix(Eigen::Index rows, Eigen::Index columns,
                                    std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  Eigen::MatrixXd values(rows, columns);
  for (double& value : values.reshaped()) {
    value = uniform(generator);
  }
  return values;
}

/// Holds each component of each node with probability 1/4, at zero.
inline Supports RandomSupports(Eigen::Index num_nodes, std::uint64_t seed) {
  const Eigen::Array3Xd values = RandomMatrix(3, num_nodes, seed).array();
  return {values < -0.5, Eigen::MatrixXd::Zero(3, num_nodes)};
}

/// Turns the orientation of every third element around.
inline Mesh WithBothOrientations(Mesh mesh) {
  for (Eigen::Index e = 0; e < mesh.NumElements(); e += 3) {
    std::swap(mesh.elements(1, e), mesh.elements(3, e));
  }
  return mesh;
}

}  // namespace elastimate::testing

#endif  // ELASTIMATE_TESTS_CORE_RANDOM_VALUES_H_
