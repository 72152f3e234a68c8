#include "elastimate/core/materials/anisotropic_law.h"

#include <array>
#include <cmath>
#include <limits>

#include "elastimate/core/laws/law_parameters.h"

namespace elastimate {
namespace {

// The stiffnesses stand row by row, each row from the diagonal on.
constexpr std::array<std::string_view, 21> kStiffnessNames = {
    "c11", "c12", "c13", "c14", "c15", "c16", "c22", "c23", "c24", "c25", "c26",
    "c33", "c34", "c35", "c36", "c44", "c45", "c46", "c55", "c56", "c66"};

// The place of a stiffness on the diagonal.
constexpr int DiagonalPlace(int row) { return row * (13 - row) / 2; }

// Returns the stiffness of an isotropic material of E = 1, nu = 0.3.
double TypicalStiffness(int row, int column) {
  constexpr double kLambda = 0.3 / (1.3 * 0.4);
  if (row != column) {
    return column < 3 ? kLambda : 0;
  }
  return row < 3 ? kLambda + 2 * kTypicalShearModulus : kTypicalShearModulus;
}

std::vector<LawParameter> Stiffnesses() {
  constexpr double kLargest = std::numeric_limits<double>::max();
  std::vector<LawParameter> all;
  for (int row = 0; row < 6; ++row) {
    for (int column = row; column < 6; ++column) {
      const std::string_view name = kStiffnessNames[all.size()];
      const double typical = TypicalStiffness(row, column);
      if (row == column) {
        all.push_back(Modulus(name, name, typical));
      } else {
        all.push_back(
            {name, name, false, -kLargest, kLargest, typical,
             std::array<int, 2>{DiagonalPlace(row), DiagonalPlace(column)}});
      }
    }
  }
  return all;
}

// The entries are those of Kelvin's notation.
std::vector<BlockEntry> StiffnessEntries() {
  const auto weight = [](int i) { return i < 3 ? 1 : std::sqrt(2.0); };
  std::vector<BlockEntry> entries;
  for (int row = 0; row < 6; ++row) {
    for (int column = row; column < 6; ++column) {
      entries.push_back({row, column, weight(row) * weight(column)});
    }
  }
  return entries;
}

}  // namespace

AnisotropicLaw::AnisotropicLaw()
    : KelvinLaw(SectionModel::kSolid, Stiffnesses(), ComponentModes(6),
                StiffnessEntries()) {}

std::string_view AnisotropicLaw::Description() const {
  return "no symmetry: all stiffnesses, in the notation of Voigt";
}

Eigen::VectorXd AnisotropicLaw::Moduli(const Eigen::VectorXd& parameters,
                                       SectionModel /*model*/) const {
  return parameters;
}

Eigen::MatrixXd AnisotropicLaw::ModuliJacobian(
    const Eigen::VectorXd& parameters, SectionModel /*model*/) const {
  return Eigen::MatrixXd::Identity(parameters.size(), parameters.size());
}

Eigen::VectorXd AnisotropicLaw::ParametersOf(const Eigen::VectorXd& moduli,
                                             SectionModel /*model*/) const {
  return moduli;
}

}  // namespace elastimate
