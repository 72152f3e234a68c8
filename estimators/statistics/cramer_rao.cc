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

// sum of s s^T over what load case `k` observes, s with respect to (ln E, nu),
// which are of one magnitude.
Eigen::Matrix2d InformationOf(const Scene& scene, Eigen::Index k,
                              const DisplacementSensitivities& sensitivities) {
  const LoadCase& load_case = scene.load_cases[k];
  const PointDisplacements& points = load_case.points;
  const int dimension = scene.mesh.Dimension();
  const auto by_node = [&](const Eigen::MatrixXd& sensitivity) {
    return Eigen::MatrixXd(
        sensitivity.col(k).reshaped(dimension, scene.mesh.NumNodes()));
  };
  const Eigen::MatrixXd of_e = by_node(sensitivities.log_youngs_modulus);
  const Eigen::MatrixXd of_nu = by_node(sensitivities.poisson_ratio);
  ComponentMask observed(dimension, scene.mesh.NumNodes());
  for (Eigen::Index node = 0; node < observed.cols(); ++node) {
    for (int i = 0; i < dimension; ++i) {
      observed(i, node) =
          !scene.supports.held(i, node) && IsObserved(load_case, i, node);
    }
  }
  const auto information = [](const ComponentMask& mask,
                              const Eigen::MatrixXd& e,
                              const Eigen::MatrixXd& nu) {
    Eigen::Matrix2d sum;
    sum(0, 0) = mask.select(e.array().square(), 0).sum();
    sum(1, 1) = mask.select(nu.array().square(), 0).sum();
    sum(0, 1) = sum(1, 0) = mask.select(e.array() * nu.array(), 0).sum();
    return sum;
  };
  Eigen::Matrix2d sum = information(observed, of_e, of_nu);
  if (points.displacement.cols() > 0) {
    sum += information(!points.displacement.array().isNaN(),
                       Interpolate(scene.mesh, points.points, of_e),
                       Interpolate(scene.mesh, points.points, of_nu));
  }
  return sum;
}

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
  Eigen::Matrix2d information = Eigen::Matrix2d::Zero();
  for (Eigen::Index k = 0; k < num_cases; ++k) {
    information +=
        InformationOf(scene, k, sensitivities) / (noise_sd(k) * noise_sd(k));
  }
  const Eigen::Vector2d eigenvalues = DecomposeSymmetric(information).values;
  if (eigenvalues(0) <= kSingular * eigenvalues(1)) {
    return Eigen::Matrix2d::Constant(std::numeric_limits<double>::infinity());
  }
  const Eigen::Vector2d scale(elasticity.youngs_modulus, 1);
  return scale.asDiagonal() * information.inverse() * scale.asDiagonal();
}

}  // namespace elastimate
