#include "elastimate/estimators/misfit/observed_model.h"

#include "elastimate/core/scene/loads.h"

namespace elastimate {

ObservedModel::ObservedModel(const Scene& scene,
                             const EstimatorOptions& options)
    : section_model_(scene.mesh.section.model),
      model_(scene.mesh, scene.supports, AssembleLoadCases(scene),
             options.solver),
      num_load_cases_(Eigen::Index(scene.load_cases.size())),
      observed_(scene),
      on_factorization_(options.on_factorization) {}

bool ObservedModel::SetPoissonRatio(double poisson_ratio) {
  if (poisson_ratio == model_.PoissonRatio()) {
    return true;
  }
  if (on_factorization_) {
    on_factorization_(++num_factorizations_);
  }
  if (!model_.SetPoissonRatio(poisson_ratio)) {
    return false;
  }
  unit_load_response_ = observed_.Restrict(model_.UnitLoadResponse());
  return true;
}

Eigen::VectorXd ObservedModel::UnitLoadResponseDerivative() {
  return observed_.Restrict(model_.UnitLoadResponseDerivative());
}

Eigen::VectorXd ObservedModel::SupportResponse() const {
  return observed_.Restrict(
      model_.SupportResponse().replicate(1, num_load_cases_));
}

Eigen::Matrix<double, Eigen::Dynamic, 2> ObservedModel::Sensitivities(
    double youngs_modulus) {
  const DisplacementSensitivities sensitivities =
      model_.Sensitivities(youngs_modulus);
  Eigen::Matrix<double, Eigen::Dynamic, 2> rows(observed_.Size(), 2);
  rows << observed_.Restrict(sensitivities.log_youngs_modulus),
      observed_.Restrict(sensitivities.poisson_ratio);
  return rows;
}

Eigen::VectorXd ObservedModel::PoissonRatioSlope(
    const IsotropicElasticity& elasticity, bool at_fixed_youngs_modulus) {
  const Eigen::Matrix<double, Eigen::Dynamic, 2> sensitivities =
      Sensitivities(elasticity.youngs_modulus);
  const double log_youngs_modulus_slope =
      at_fixed_youngs_modulus
          ? 0
          : LogYoungsModulusSlope(elasticity.poisson_ratio, section_model_);
  return sensitivities.col(1) + log_youngs_modulus_slope * sensitivities.col(0);
}

}  // namespace elastimate
