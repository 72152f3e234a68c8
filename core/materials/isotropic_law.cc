#include "elastimate/core/materials/isotropic_law.h"

#include <algorithm>
#include <limits>

#include "elastimate/core/laws/elasticity.h"

namespace elastimate {
namespace {

Eigen::MatrixXd Strain(const Eigen::MatrixXd& gradient) {
  return (gradient + gradient.transpose()) / 2;
}

}  // namespace

bool AreIsotropic(const std::vector<Material>& materials) {
  return std::all_of(materials.begin(), materials.end(),
                     [](const Material& material) {
                       return material.law == IsotropicLaw::kName;
                     });
}

std::string_view IsotropicLaw::Description() const {
  return "Hooke's law of a material that is alike in all directions";
}

const std::vector<LawParameter>& IsotropicLaw::Parameters() const {
  static const std::vector<LawParameter> parameters = {
      {"youngs_modulus", "E", true, std::numeric_limits<double>::min(),
       std::numeric_limits<double>::max(), 1},
      {"poisson_ratio", "nu", false, kSmallestPoissonRatio,
       kLargestPoissonRatio, 0.3}};
  return parameters;
}

bool IsotropicLaw::Takes(SectionModel /*model*/) const { return true; }

Eigen::VectorXd IsotropicLaw::Energies(const Eigen::MatrixXd& gradient,
                                       SectionModel model) const {
  const Eigen::MatrixXd e = Strain(gradient);
  const double trace = e.trace();
  return Eigen::Vector2d(
      e.squaredNorm() / 2,
      (trace * trace - ShearShareOfJ(model) * e.squaredNorm()) / 2);
}

Eigen::MatrixXd IsotropicLaw::Stresses(const Eigen::MatrixXd& gradient,
                                       SectionModel model) const {
  const Eigen::MatrixXd e = Strain(gradient);
  Eigen::MatrixXd of_j = -ShearShareOfJ(model) * e;
  of_j.diagonal().array() += e.trace();
  Eigen::MatrixXd stresses(e.size(), 2);
  stresses << e.reshaped(), of_j.reshaped();
  return stresses;
}

Eigen::MatrixXd IsotropicLaw::Tangent(const Eigen::VectorXd& moduli,
                                      const Eigen::MatrixXd& gradient,
                                      SectionModel model) const {
  // Linear: the columns are the stresses of unit gradients.
  Eigen::MatrixXd tangent(gradient.size(), gradient.size());
  Eigen::MatrixXd unit =
      Eigen::MatrixXd::Zero(gradient.rows(), gradient.cols());
  for (Eigen::Index i = 0; i < gradient.size(); ++i) {
    unit(i) = 1;
    tangent.col(i) = Stresses(unit, model) * moduli;
    unit(i) = 0;
  }
  return tangent;
}

Eigen::VectorXd IsotropicLaw::Moduli(const Eigen::VectorXd& parameters,
                                     SectionModel model) const {
  const IsotropicElasticity elasticity = {parameters(0), parameters(1)};
  return elasticity.StiffnessScale(model) * Eigen::Vector2d(1, parameters(1));
}

Eigen::MatrixXd IsotropicLaw::ModuliJacobian(const Eigen::VectorXd& parameters,
                                             SectionModel model) const {
  const double nu = parameters(1);
  const double s = IsotropicElasticity{parameters(0), nu}.StiffnessScale(model);
  // s = E / g(nu).
  const double slope =
      -s * ComplianceFactorSlope(nu, model) / ComplianceFactor(nu, model);
  return (Eigen::Matrix2d() << s / parameters(0), slope, nu * s / parameters(0),
          s + nu * slope)
      .finished();
}

Eigen::VectorXd IsotropicLaw::ParametersOf(const Eigen::VectorXd& moduli,
                                           SectionModel model) const {
  const double nu = moduli(1) / moduli(0);
  return Eigen::Vector2d(moduli(0) * ComplianceFactor(nu, model), nu);
}

}  // namespace elastimate
