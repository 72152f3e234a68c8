#ifndef ELASTIMATE_TESTS_BIAS_LAW_H_
#define ELASTIMATE_TESTS_BIAS_LAW_H_

#include <Eigen/Core>

#include "elastimate/core/scene/scene.h"
#include "tests/dense_reference.h"

namespace elastimate::testing {

/// Displacement noise pulls nu of the closed form: its expectation is nu + rho
/// (nu_noise - nu).
struct BiasLaw {
  double rho;
  double noise_poisson_ratio;
};

/// Returns the law for noise whose norm over the free components is
/// `relative_noise` times that of the exact displacement of the scene's only
/// load case.  Computed from dense matrices.
inline BiasLaw BiasLawOf(const Scene& exact, double relative_noise) {
  const DegreesOfFreedom dofs(exact.supports);
  const Eigen::MatrixXd h = DenseStiffness<double>(exact.mesh, DenseDH());
  const Eigen::MatrixXd j = DenseStiffness<double>(exact.mesh, DenseDJ());
  const Eigen::MatrixXd h_free = h(dofs.free, dofs.free);
  const Eigen::MatrixXd j_free = j(dofs.free, dofs.free);
  const Eigen::VectorXd f =
      Eigen::VectorXd(AssembleLoadCases(exact).col(0)(dofs.free)).normalized();
  // The parameter t fits the direction of f, so that direction is left out.
  const Eigen::MatrixXd h_part = h_free - f * (f.transpose() * h_free);
  const Eigen::MatrixXd j_part = j_free - f * (f.transpose() * j_free);
  const double t_jj = j_part.squaredNorm();
  const double t_hj = h_part.cwiseProduct(j_part).sum();
  const Eigen::VectorXd q =
      exact.load_cases[0].displacement.reshaped()(dofs.free);
  const double b_squared = (j_part * q).squaredNorm();
  const double variance =
      relative_noise * relative_noise * q.squaredNorm() / double(q.size());
  return {variance * t_jj / (b_squared + variance * t_jj), -t_hj / t_jj};
}

}  // namespace elastimate::testing

#endif  // ELASTIMATE_TESTS_BIAS_LAW_H_
