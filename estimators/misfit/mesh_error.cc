#include "elastimate/estimators/misfit/mesh_error.h"

#include <algorithm>
#include <cmath>

#include "elastimate/core/algebra/node_sums.h"
#include "elastimate/estimators/interface/limits.h"

namespace elastimate {
namespace {

struct Fractions {
  double correction;   // k
  double uncertainty;  // c
  double residual;     // b
};

bool IsModulus(const FreeParameters& free, Eigen::Index variable) {
  const LawParameter& parameter =
      *free.All().All()[free.All().Free()[variable]].law_parameter;
  return parameter.is_modulus || parameter.beside;
}

bool IsAnyRatioFree(const FreeParameters& free) {
  for (Eigen::Index i = 0; i < free.Size(); ++i) {
    if (!IsModulus(free, i)) {
      return true;
    }
  }
  return false;
}

Fractions FractionsOf(const SpaceChange& change, const FreeParameters& free) {
  const double of_number = std::sqrt(2.0 / static_cast<double>(free.Size()));
  if (!change.is_of_quadratic) {
    return {0, 0.5, 0.03 * of_number};
  }
  return IsAnyRatioFree(free) ? Fractions{0.5, 0.5, 0.075 * of_number}
                              : Fractions{0.35, 0.35, 0};
}

// The change of the variables, where that of a ratio is not taken for smaller
// than a part of the largest one of a modulus.
Eigen::VectorXd CautiousChange(const SpaceChange& change,
                               const FreeParameters& free) {
  constexpr double kLeastOfRatio = 0.2;
  Eigen::VectorXd cautious = change.variables;
  double of_moduli = 0;
  for (Eigen::Index i = 0; i < free.Size(); ++i) {
    if (IsModulus(free, i)) {
      of_moduli = std::max(of_moduli, std::abs(cautious(i)));
    }
  }
  for (Eigen::Index i = 0; i < free.Size(); ++i) {
    if (!IsModulus(free, i)) {
      cautious(i) = std::copysign(
          std::max(std::abs(cautious(i)), kLeastOfRatio * of_moduli),
          cautious(i));
    }
  }
  return cautious;
}

// Returns the variance of a mesh error that is taken for small.
double LeastVariance(const FreeParameters& free, Eigen::Index variable) {
  return std::pow(
      0.5 * (IsModulus(free, variable) ? kLimits.notable_youngs_modulus_error
                                       : kLimits.notable_poisson_ratio_error),
      2);
}

}  // namespace

MeshError MeshErrorOf(const SpaceChange& change, const FreeParameters& free,
                      const Eigen::MatrixXd& sensitivities,
                      const Eigen::MatrixXd& inverse,
                      Eigen::Index num_displacements) {
  const Fractions fractions = FractionsOf(change, free);
  const Eigen::VectorXd d =
      change.is_of_quadratic ? change.variables : CautiousChange(change, free);
  Eigen::VectorXd sizes = change.rows.cwiseAbs();
  sizes.head(num_displacements)
      .setConstant(Norm(change.rows.head(num_displacements)));
  const Eigen::MatrixXd missed =
      fractions.residual * (sizes.asDiagonal() * sensitivities) * inverse;
  MeshError error = {fractions.correction * change.variables,
                     std::pow(fractions.uncertainty, 2) * d * d.transpose() +
                         InnerProducts(missed, missed),
                     Eigen::MatrixXd::Zero(d.size(), d.size())};
  if (change.is_kept_for_its_size) {
    for (Eigen::Index i = 0; i < d.size(); ++i) {
      error.covariance(i, i) =
          std::max(error.covariance(i, i), LeastVariance(free, i));
    }
  }
  if (change.by_supports.size() != 0) {
    error.correction += change.by_supports;
    error.of_supports = change.by_supports * change.by_supports.transpose();
    error.covariance += error.of_supports;
  }
  return error;
}

}  // namespace elastimate
