#include "elastimate/estimators/statistics/cramer_rao.h"

#include <Eigen/LU>
#include <limits>
#include <stdexcept>

#include "elastimate/core/algebra/dense_algebra.h"
#include "elastimate/core/equilibrium/forward_model.h"
#include "elastimate/core/scene/loads.h"
#include "elastimate/estimators/interface/estimator.h"

namespace elastimate {
namespace {

// A ratio of informations that comes from rounding.
constexpr double kSingular = 1e-13;

}  // namespace

Eigen::Matrix2d CramerRaoBound(const Scene& scene,
                               const IsotropicElasticity& elasticity,
                               const Eigen::VectorXd& noise_sd) {
  ValidateScene(scene);
  const Eigen::Index num_cases = Eigen::Index(scene.load_cases.size());
  if (!elasticity.IsPhysical()) {
    throw std::invalid_argument(
        "the Cramer-Rao bound needs E > 0 and nu between -1 and 0.5");
  }
  if (noise_sd.size() != num_cases || !(noise_sd.array() > 0).all()) {
    throw std::invalid_argument(
        "the Cramer-Rao bound needs a positive noise standard deviation for "
        "each load case");
  }
  ForwardModel model(scene.mesh, scene.supports, AssembleLoadCases(scene));
  if (!model.SetPoissonRatio(elasticity.poisson_ratio)) {
    throw std::runtime_error(
        "the stiffness matrix is singular to working precision");
  }
  const DisplacementSensitivities sensitivities =
      model.Sensitivities(elasticity.youngs_modulus);
  // With respect to (ln E, nu), which are of one magnitude.
  Eigen::Matrix2d information = Eigen::Matrix2d::Zero();
  for (Eigen::Index k = 0; k < num_cases; ++k) {
    for (Eigen::Index node = 0; node < scene.mesh.NumNodes(); ++node) {
      for (int i = 0; i < scene.mesh.Dimension(); ++i) {
        if (!scene.supports.held(i, node) &&
            IsObserved(scene.load_cases[k], i, node)) {
          const Eigen::Index dof = scene.mesh.Dimension() * node + i;
          const Eigen::Vector2d s(
              sensitivities.log_youngs_modulus(dof, k) / noise_sd(k),
              sensitivities.poisson_ratio(dof, k) / noise_sd(k));
          information += s * s.transpose();
        }
      }
    }
  }
  const Eigen::Vector2d eigenvalues = DecomposeSymmetric(information).values;
  if (eigenvalues(0) <= kSingular * eigenvalues(1)) {
    return Eigen::Matrix2d::Constant(std::numeric_limits<double>::infinity());
  }
  const Eigen::Vector2d scale(elasticity.youngs_modulus, 1);
  return scale.asDiagonal() * information.inverse() * scale.asDiagonal();
}

}  // namespace elastimate
