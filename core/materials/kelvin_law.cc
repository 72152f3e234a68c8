#include "elastimate/core/materials/kelvin_law.h"

#include <array>
#include <cassert>
#include <cmath>
#include <utility>

namespace elastimate {
namespace {

// The components of a symmetric tensor in the order of Voigt and Kelvin.
std::vector<std::array<int, 2>> ComponentPairs(Eigen::Index dimension) {
  return dimension == 3
             ? std::vector<std::array<int, 2>>{{0, 0}, {1, 1}, {2, 2},
                                               {1, 2}, {0, 2}, {0, 1}}
             : std::vector<std::array<int, 2>>{{0, 0}, {1, 1}, {0, 1}};
}

}  // namespace

std::vector<Eigen::MatrixXd> ComponentModes(int num_components) {
  std::vector<Eigen::MatrixXd> modes;
  modes.reserve(num_components);
  for (int i = 0; i < num_components; ++i) {
    modes.emplace_back(Eigen::VectorXd::Unit(num_components, i));
  }
  return modes;
}

Eigen::MatrixXd KelvinStrainOfGradient(Eigen::Index dimension) {
  const auto pairs = ComponentPairs(dimension);
  Eigen::MatrixXd strain =
      Eigen::MatrixXd::Zero(Eigen::Index(pairs.size()), dimension * dimension);
  for (Eigen::Index i = 0; i < strain.rows(); ++i) {
    const auto [a, b] = pairs[i];
    strain(i, a + dimension * b) = a == b ? 1 : std::sqrt(0.5);
    strain(i, b + dimension * a) = a == b ? 1 : std::sqrt(0.5);
  }
  return strain;
}

Eigen::MatrixXd VoigtStiffness(const Eigen::MatrixXd& tangent) {
  const Eigen::Index dimension = tangent.rows() == 9 ? 3 : 2;
  const auto pairs = ComponentPairs(dimension);
  const Eigen::Index size = Eigen::Index(pairs.size());
  return Eigen::MatrixXd::NullaryExpr(
      size, size, [&](Eigen::Index i, Eigen::Index j) {
        return tangent(pairs[i][0] + dimension * pairs[i][1],
                       pairs[j][0] + dimension * pairs[j][1]);
      });
}

KelvinLaw::KelvinLaw(SectionModel model, std::vector<LawParameter> parameters,
                     const std::vector<Eigen::MatrixXd>& modes,
                     std::vector<BlockEntry> entries)
    : model_(model),
      parameters_(std::move(parameters)),
      entries_(std::move(entries)) {
  for (const BlockEntry& entry : entries_) {
    const Eigen::MatrixXd product =
        entry.factor * modes[entry.row] * modes[entry.column].transpose();
    bases_.emplace_back(entry.row == entry.column
                            ? product
                            : Eigen::MatrixXd(product + product.transpose()));
  }
}

Eigen::VectorXd KelvinLaw::Energies(const Eigen::MatrixXd& gradient,
                                    SectionModel model) const {
  return Stresses(gradient, model).transpose() * gradient.reshaped() / 2;
}

Eigen::MatrixXd KelvinLaw::Stresses(const Eigen::MatrixXd& gradient,
                                    SectionModel model) const {
  assert(Takes(model));
  static_cast<void>(model);
  const Eigen::MatrixXd to_strain = KelvinStrainOfGradient(gradient.rows());
  const Eigen::VectorXd strain = to_strain * gradient.reshaped();
  Eigen::MatrixXd stresses(strain.size(), NumModuli());
  for (Eigen::Index k = 0; k < stresses.cols(); ++k) {
    stresses.col(k) = bases_[k] * strain;
  }
  return to_strain.transpose() * stresses;
}

Eigen::MatrixXd KelvinLaw::Tangent(const Eigen::VectorXd& moduli,
                                   const Eigen::MatrixXd& gradient,
                                   SectionModel model) const {
  assert(Takes(model));
  static_cast<void>(model);
  Eigen::MatrixXd stiffness =
      Eigen::MatrixXd::Zero(bases_[0].rows(), bases_[0].cols());
  for (Eigen::Index k = 0; k < moduli.size(); ++k) {
    stiffness += moduli(k) * bases_[k];
  }
  const Eigen::MatrixXd to_strain = KelvinStrainOfGradient(gradient.rows());
  return to_strain.transpose() * stiffness * to_strain;
}

}  // namespace elastimate
