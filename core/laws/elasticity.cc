#include "elastimate/core/laws/elasticity.h"

#include <cmath>

namespace elastimate {

IsotropicElasticity IsotropicElasticity::FromComplianceScale(
    double compliance_scale, double poisson_ratio, SectionModel model) {
  return {ComplianceFactor(poisson_ratio, model) / compliance_scale,
          poisson_ratio};
}

double IsotropicElasticity::ShearModulus() const {
  return youngs_modulus / (2 * (1 + poisson_ratio));
}

double IsotropicElasticity::LameLambda() const {
  return StiffnessScale(SectionModel::kSolid) * poisson_ratio;
}

double IsotropicElasticity::BulkModulus() const {
  return youngs_modulus / (3 * (1 - 2 * poisson_ratio));
}

double IsotropicElasticity::BulkCompliance() const {
  return 3 * (1 - 2 * poisson_ratio) / youngs_modulus;
}

double IsotropicElasticity::StiffnessScale(SectionModel model) const {
  return youngs_modulus / ComplianceFactor(poisson_ratio, model);
}

double IsotropicElasticity::ComplianceScale(SectionModel model) const {
  return ComplianceFactor(poisson_ratio, model) / youngs_modulus;
}

bool IsotropicElasticity::IsPhysical() const {
  return youngs_modulus > 0 && poisson_ratio > -1 && poisson_ratio < 0.5;
}

double ComplianceFactorSlope(double poisson_ratio, SectionModel model) {
  const double c = ShearShareOfJ(model);
  return 1 - c - 2 * c * poisson_ratio;
}

double LogYoungsModulusSlope(double poisson_ratio, SectionModel model) {
  return ComplianceFactorSlope(poisson_ratio, model) /
         ComplianceFactor(poisson_ratio, model);
}

double LogStiffnessRatio(double poisson_ratio) {
  return std::log((1 + poisson_ratio) / (1 - 2 * poisson_ratio));
}

double PoissonRatioOfLogStiffnessRatio(double log_stiffness_ratio) {
  const double ratio = std::exp(log_stiffness_ratio);
  return (ratio - 1) / (1 + 2 * ratio);
}

Eigen::Matrix2d ShearAndBulkJacobian(const IsotropicElasticity& elasticity) {
  const double youngs = elasticity.youngs_modulus;
  const double nu = elasticity.poisson_ratio;
  Eigen::Matrix2d jacobian;
  jacobian << elasticity.ShearModulus() / youngs,
      -elasticity.ShearModulus() / (1 + nu),  //
      -elasticity.BulkCompliance() / youngs, -6 / youngs;
  return jacobian;
}

}  // namespace elastimate
