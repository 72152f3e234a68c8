#include "elastimate/estimators/reduced_model/nearby_solve.h"

#include <cmath>
#include <utility>

#include "elastimate/core/algebra/tall_columns.h"

namespace elastimate {
namespace {

// Zero over zero, of columns that are solved, is zero.
Eigen::RowVectorXd Ratios(const Eigen::RowVectorXd& numerators,
                          const Eigen::RowVectorXd& denominators) {
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
    equilibrium.ClearHeld(residual);
    residual(also_held, Eigen::all).setZero();
    Eigen::MatrixXd preconditioned = equilibrium.Precondition(residual);
    preconditioned(also_held, Eigen::all).setZero();
    return preconditioned;
  };
  Eigen::MatrixXd residual = std::move(forces);
  residual -= of_mesh.Multiply(moduli, x);
  Eigen::MatrixXd direction = precondition(residual);
  Eigen::RowVectorXd products = ColumnProducts(residual, direction);
  Eigen::RowVectorXd last_steps;
  for (int i = 1; i <= most_iterations; ++i) {
    Eigen::MatrixXd of_direction = of_mesh.Multiply(moduli, direction);
    const Eigen::RowVectorXd lengths =
        Ratios(products, ColumnProducts(direction, of_direction));
    AddTo(x, direction, lengths);
    AddTo(residual, of_direction, -lengths);
    of_direction.resize(0, 0);  // Columns of large meshes need much memory.
    const Eigen::RowVectorXd steps =
        lengths.cwiseProduct(products).cwiseMax(0).cwiseSqrt();
    if (!steps.allFinite()) {
      return std::nullopt;
    }
    const Eigen::RowVectorXd left =
        last_steps.size() == 0 ? steps
                               : Eigen::RowVectorXd(steps.cwiseProduct(
                                     Ratios(steps, last_steps).cwiseMin(1)));
    if ((left.array() <= tolerances.transpose().array()).all()) {
      return i;
    }
    last_steps = steps;
    const Eigen::MatrixXd preconditioned = precondition(residual);
    const Eigen::RowVectorXd next = ColumnProducts(residual, preconditioned);
    Scale(direction, Ratios(next, products));
    AddTo(direction, preconditioned);
    products = next;
  }
  return std::nullopt;
}

}  // namespace elastimate
