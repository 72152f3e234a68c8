#include "elastimate/core/large_strain/charts.h"

#include "elastimate/core/laws/elasticity.h"
#include "elastimate/core/laws/law_parameters.h"

namespace elastimate {

const std::vector<LawParameter>& LameChart::Parameters() {
  static const std::vector<LawParameter> parameters = {
      Modulus("youngs_modulus", "E", 1),
      {"poisson_ratio", "nu", false, kSmallestPoissonRatio,
       kLargestPoissonRatio, 0.3}};
  return parameters;
}

Eigen::Vector2d LameChart::Moduli(const Eigen::VectorXd& parameters) {
  const IsotropicElasticity elasticity = {parameters(0), parameters(1)};
  return {elasticity.ShearModulus(), elasticity.LameLambda()};
}

Eigen::Matrix2d LameChart::ModuliJacobian(const Eigen::VectorXd& parameters) {
  const double youngs = parameters(0);
  const double nu = parameters(1);
  const Eigen::Vector2d moduli = Moduli(parameters);
  // mu = E / (2 (1 + nu)), lambda = E nu / g(nu).
  const double g = ComplianceFactor(nu, SectionModel::kSolid);
  const double slope = ComplianceFactorSlope(nu, SectionModel::kSolid);
  Eigen::Matrix2d jacobian;
  jacobian << moduli(0) / youngs, -moduli(0) / (1 + nu),  //
      moduli(1) / youngs, youngs / g * (1 - nu * slope / g);
  return jacobian;
}

Eigen::Vector2d LameChart::ParametersOf(const Eigen::VectorXd& moduli) {
  const double mu = moduli(0);
  const double lambda = moduli(1);
  return {mu * (3 * lambda + 2 * mu) / (lambda + mu),
          lambda / (2 * (lambda + mu))};
}

}  // namespace elastimate
