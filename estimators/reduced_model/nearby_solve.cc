#include "elastimate/estimators/reduced_model/nearby_solve.h"

#include <cmath>
#include <utility>

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
                               Eigen::MatrixXd forces,
                               const Eigen::VectorXd& tolerances,
                               int most_iterations, Equilibrium& equilibrium,
                               Eigen::MatrixXd& x,
                               const std::vector<int>& also_held) {
  const InternalForces& of_mesh = equilibrium.Forces();
  const auto precondition = [&](Eigen::MatrixXd& residual) {
    residual(also_held, Eigen::all).setZero();
    Eigen::MatrixXd preconditioned = equilibrium.Precondition(residual);
    preconditioned(also_held, Eigen::all).setZero();
    return preconditioned;
  };
  Eigen::MatrixXd residual = std::move(forces);
  residual -= of_mesh.Multiply(moduli, x);
  Eigen::MatrixXd direction = precondition(residual);
  Eigen::VectorXd products = ColumnProducts(residual, direction);
  Eigen::VectorXd last_steps;
  for (int i = 1; i <= most_iterations; ++i) {
    Eigen::MatrixXd of_direction = of_mesh.Multiply(moduli, direction);
    const Eigen::VectorXd lengths =
        Ratios(products, ColumnProducts(direction, of_direction));
    x += direction * lengths.asDiagonal();
    residual -= of_direction * lengths.asDiagonal();
    of_direction.resize(0, 0);  // Columns of large meshes need much memory.
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
    const Eigen::MatrixXd preconditioned = precondition(residual);
    const Eigen::VectorXd next = ColumnProducts(residual, preconditioned);
    direction =
        preconditioned + direction * Ratios(next, products).asDiagonal();
    products = next;
  }
  return std::nullopt;
}

}  // namespace elastimate
