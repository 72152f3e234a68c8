#include "elastimate/core/materials/orthotropic_law.h"

#include <Eigen/LU>

#include "elastimate/core/laws/law_parameters.h"

namespace elastimate {
namespace {

int NumDirections(SectionModel model) {
  return model == SectionModel::kSolid ? 3 : 2;
}

std::vector<LawParameter> OrthotropicParameters(SectionModel model) {
  if (model == SectionModel::kSolid) {
    return {Modulus("youngs_modulus_1", "E_1", 1),
            Modulus("youngs_modulus_2", "E_2", 1),
            Modulus("youngs_modulus_3", "E_3", 1),
            DirectedPoissonRatio("poisson_ratio_12", "nu_12"),
            DirectedPoissonRatio("poisson_ratio_13", "nu_13"),
            DirectedPoissonRatio("poisson_ratio_23", "nu_23"),
            Modulus("shear_modulus_12", "G_12", kTypicalShearModulus),
            Modulus("shear_modulus_13", "G_13", kTypicalShearModulus),
            Modulus("shear_modulus_23", "G_23", kTypicalShearModulus)};
  }
  return {Modulus("youngs_modulus_1", "E_1", 1),
          Modulus("youngs_modulus_2", "E_2", 1),
          DirectedPoissonRatio("poisson_ratio_12", "nu_12"),
          Modulus("shear_modulus_12", "G_12", kTypicalShearModulus)};
}

// The entries of normal strains come row by row, those of shears behind them.
std::vector<BlockEntry> OrthotropicEntries(int num_directions) {
  std::vector<BlockEntry> entries;
  for (int i = 0; i < num_directions; ++i) {
    for (int j = i; j < num_directions; ++j) {
      entries.push_back({i, j, 1});
    }
  }
  const int num_shears = num_directions == 3 ? 3 : 1;
  for (int i = 0; i < num_shears; ++i) {
    entries.push_back({num_directions + i, num_directions + i, 2});
  }
  return entries;
}

}  // namespace

OrthotropicLaw::OrthotropicLaw(SectionModel model)
    : KelvinLaw(model, OrthotropicParameters(model),
                ComponentModes(model == SectionModel::kSolid ? 6 : 3),
                OrthotropicEntries(NumDirections(model))),
      num_directions_(NumDirections(model)) {}

std::string_view OrthotropicLaw::Description() const {
  return num_directions_ == 3
             ? "three planes of symmetry, normal to its axes"
             : "a lamina in plane stress, with an axis in its plane";
}

Eigen::MatrixXd OrthotropicLaw::NormalCompliance(
    const Eigen::VectorXd& parameters) const {
  Eigen::MatrixXd compliance(num_directions_, num_directions_);
  int ratio = num_directions_;
  for (int i = 0; i < num_directions_; ++i) {
    compliance(i, i) = 1 / parameters(i);
    for (int j = i + 1; j < num_directions_; ++j, ++ratio) {
      compliance(i, j) = compliance(j, i) = -parameters(ratio) / parameters(i);
    }
  }
  return compliance;
}

Eigen::VectorXd OrthotropicLaw::Moduli(const Eigen::VectorXd& parameters,
                                       SectionModel /*model*/) const {
  const Eigen::MatrixXd stiffness = NormalCompliance(parameters).inverse();
  Eigen::VectorXd moduli(parameters.size());
  int k = 0;
  for (int i = 0; i < num_directions_; ++i) {
    for (int j = i; j < num_directions_; ++j) {
      moduli(k++) = stiffness(i, j);
    }
  }
  // The parameters G_12, G_13, G_23 become c_44 = G_23, c_55 and c_66 in
  // reverse order.
  const Eigen::Index num_shears = moduli.size() - k;
  moduli.tail(num_shears) = parameters.tail(num_shears).reverse();
  return moduli;
}

Eigen::MatrixXd OrthotropicLaw::ModuliJacobian(
    const Eigen::VectorXd& parameters, SectionModel /*model*/) const {
  const Eigen::MatrixXd compliance = NormalCompliance(parameters);
  const Eigen::MatrixXd stiffness = compliance.inverse();
  const Eigen::Index size = parameters.size();
  Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(size, size);
  const Eigen::Index num_shears = num_directions_ == 3 ? 3 : 1;
  const auto enter = [&](int parameter, const Eigen::MatrixXd& slope) {
    // d C = -C dS C.
    const Eigen::MatrixXd change = -stiffness * slope * stiffness;
    int k = 0;
    for (int i = 0; i < num_directions_; ++i) {
      for (int j = i; j < num_directions_; ++j) {
        jacobian(k++, parameter) = change(i, j);
      }
    }
  };
  int ratio = num_directions_;
  for (int i = 0; i < num_directions_; ++i) {
    Eigen::MatrixXd by_modulus =
        Eigen::MatrixXd::Zero(num_directions_, num_directions_);
    by_modulus(i, i) = -compliance(i, i) / parameters(i);
    for (int j = i + 1; j < num_directions_; ++j, ++ratio) {
      by_modulus(i, j) = by_modulus(j, i) = -compliance(i, j) / parameters(i);
      Eigen::MatrixXd by_ratio =
          Eigen::MatrixXd::Zero(num_directions_, num_directions_);
      by_ratio(i, j) = by_ratio(j, i) = -1 / parameters(i);
      enter(ratio, by_ratio);
    }
    enter(i, by_modulus);
  }
  for (Eigen::Index i = 0; i < num_shears; ++i) {
    jacobian(size - 1 - i, size - num_shears + i) = 1;
  }
  return jacobian;
}

Eigen::VectorXd OrthotropicLaw::ParametersOf(const Eigen::VectorXd& moduli,
                                             SectionModel /*model*/) const {
  Eigen::MatrixXd stiffness(num_directions_, num_directions_);
  int k = 0;
  for (int i = 0; i < num_directions_; ++i) {
    for (int j = i; j < num_directions_; ++j) {
      stiffness(i, j) = stiffness(j, i) = moduli(k++);
    }
  }
  const Eigen::MatrixXd compliance = stiffness.inverse();
  Eigen::VectorXd parameters(moduli.size());
  int ratio = num_directions_;
  for (int i = 0; i < num_directions_; ++i) {
    parameters(i) = 1 / compliance(i, i);
    for (int j = i + 1; j < num_directions_; ++j) {
      parameters(ratio++) = -compliance(i, j) / compliance(i, i);
    }
  }
  const Eigen::Index num_shears = moduli.size() - k;
  parameters.tail(num_shears) = moduli.tail(num_shears).reverse();
  return parameters;
}

}  // namespace elastimate
