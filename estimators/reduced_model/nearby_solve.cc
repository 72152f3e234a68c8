#include "elastimate/estimators/reduced_model/nearby_solve.h"

#include <cmath>

namespace elastimate {
namespace {

Eigen::VectorXd ColumnProducts(const Eigen::MatrixXd& a,
                               const Eigen::MatrixXd& b) {
  return a.cwiseProduct(b).colwise().sum();
}

// Zero over zero, of columns that are solved, is zero.
Eigen::VectorXd Ratios(const Eigen::VectorXd& numerators,
                       const Eigen::VectorXd& denominators) {
  return numerators.binaryExpr(
      denominators, [](double a, double b) { return b > 0 ? a / b : 0.0; });
}

}  // namespace

std::optional<int> SolveNearby(const Eigen::VectorXd& moduli,
                               const Eigen::MatrixXd& forces,
                               const Eigen::VectorXd& tolerances,
                               int most_iterations, Equilibrium& equilibrium,
                               Eigen::MatrixXd& x) {
  const InternalForces& of_mesh = equilibrium.Forces();
  Eigen::MatrixXd residual = forces - of_mesh.Multiply(moduli, x);
  Eigen::MatrixXd preconditioned = equilibrium.Precondition(residual);
  Eigen::MatrixXd direction = preconditioned;
  Eigen::VectorXd products = ColumnProducts(residual, preconditioned);
  Eigen::VectorXd last_steps;
  for (int i = 1; i <= most_iterations; ++i) {
    const Eigen::MatrixXd of_direction = of_mesh.Multiply(moduli, direction);
    const Eigen::VectorXd lengths =
        Ratios(products, ColumnProducts(direction, of_direction));
    x += direction * lengths.asDiagonal();
    residual -= of_direction * lengths.asDiagonal();
    const Eigen::VectorXd steps =
        lengths.cwiseProduct(products).cwiseMax(0).cwiseSqrt();
    if (!steps.allFinite()) {
      return std::nullopt;
    }
    const Eigen::VectorXd left =
        last_steps.size() == 0 ? steps
                               : Eigen::VectorXd(steps.cwiseProduct(
                                     Ratios(steps, last_steps).cwiseMin(1)));
    if ((left.array() <= tolerances.array()).all()) {
      return i;
    }
    last_steps = steps;
    preconditioned = equilibrium.Precondition(residual);
    const Eigen::VectorXd next = ColumnProducts(residual, preconditioned);
    direction =
        preconditioned + direction * Ratios(next, products).asDiagonal();
    products = next;
  }
  return std::nullopt;
}

}  // namespace elastimate
