#include "elastimate/estimators/reduced_model/reduced_equilibrium.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <utility>

#include "elastimate/core/algebra/dense_algebra.h"
#include "elastimate/core/algebra/node_sums.h"
#include "elastimate/core/algebra/tall_columns.h"

namespace elastimate {
namespace {

// Vectors of unit energy of which others leave less than this, and combinations
// that have less, are rounding.
constexpr double kRoundingOfRest = 1e-20;
constexpr double kRoundingOfCombination = 1e-12;

// 1 / sqrt(energy), zero for what is rounding.
Eigen::RowVectorXd Scales(const Eigen::MatrixXd& columns,
                          const Eigen::MatrixXd& products, double rounding) {
  return ColumnProducts(columns, products).unaryExpr([&](double energy) {
    return energy > rounding && std::isfinite(energy) ? 1 / std::sqrt(energy)
                                                      : 0.0;
  });
}

}  // namespace

ReducedEquilibrium::ReducedEquilibrium(const Equilibrium& full,
                                       const ObservedDisplacements& observed)
    : forces_(full.Forces()), load_(full.Load()), observed_(observed) {
  const Eigen::MatrixXd held = full.HeldDisplacement();
  for (Eigen::Index k = 0; k < load_.cols(); ++k) {
    LoadCase load_case;
    if (!held.col(k).isZero(0)) {
      load_case.held = held.col(k);
      load_case.held_columns = forces_.Columns(load_case.held);
      ++element_passes_;
    }
    cases_.push_back(load_case);
  }
  ForgetBases();
}

Eigen::MatrixXd ReducedEquilibrium::StiffnessOf(
    const LoadCase& load_case, const Eigen::VectorXd& moduli) const {
  const Eigen::Index m = load_case.basis.cols();
  Eigen::MatrixXd stiffness = Eigen::MatrixXd::Zero(m, m);
  for (Eigen::Index k = 0; k < moduli.size(); ++k) {
    stiffness += moduli(k) * load_case.of_moduli.middleCols(m * k, m);
  }
  return stiffness;
}

void ReducedEquilibrium::Extend(const Eigen::VectorXd& moduli,
                                Eigen::MatrixXd displacements) {
  const Eigen::Index n = displacements.cols() / load_.cols();
  for (Eigen::Index k = 0; k < load_.cols(); ++k) {
    Eigen::MatrixXd columns =
        load_.cols() == 1 ? std::move(displacements)
                          : Eigen::MatrixXd(displacements.middleCols(n * k, n));
    Append(k, NewVectors(moduli, cases_[k], std::move(columns)), cases_[k]);
  }
}

Eigen::MatrixXd ReducedEquilibrium::NewVectors(const Eigen::VectorXd& moduli,
                                               const LoadCase& load_case,
                                               Eigen::MatrixXd columns) {
  // The second pass takes off what rounding left in the first.
  constexpr int kPasses = 2;
  const auto multiply = [&] {
    ++element_passes_;
    return forces_.Multiply(moduli, columns);
  };
  const Eigen::MatrixXd old_stiffness = StiffnessOf(load_case, moduli);
  Eigen::MatrixXd products = multiply();
  Eigen::RowVectorXd scales = Scales(columns, products, 0);
  for (int i = 0; i < kPasses; ++i) {
    Scale(columns, scales);
    Scale(products, scales);
    if (old_stiffness.size() > 0) {
      columns -= load_case.basis * old_stiffness.ldlt().solve(InnerProducts(
                                       load_case.basis, products));
      products = multiply();
      scales = Scales(columns, products, kRoundingOfRest);
      Scale(columns, scales);
      Scale(products, scales);
    }
    const SymmetricEigenDecomposition modes =
        DecomposeSymmetric(InnerProducts(columns, products));
    const Eigen::Index kept =
        (modes.values.array() > kRoundingOfCombination).count();
    if (kept == 0) {
      return Eigen::MatrixXd(columns.rows(), 0);
    }
    const Eigen::MatrixXd combinations =
        modes.vectors.rightCols(kept) *
        modes.values.tail(kept).cwiseSqrt().cwiseInverse().asDiagonal();
    columns = columns * combinations;
    products = multiply();
    scales = Scales(columns, products, 0);
  }
  return columns;
}

void ReducedEquilibrium::Append(Eigen::Index k, Eigen::MatrixXd vectors,
                                LoadCase& load_case) {
  const Eigen::Index old = load_case.basis.cols();
  const Eigen::Index m = old + vectors.cols();
  const Eigen::Index num_moduli = NumModuli();
  if (old == 0) {
    load_case.basis = std::move(vectors);
  } else {
    load_case.basis.conservativeResize(Eigen::NoChange, m);
    load_case.basis.rightCols(m - old) = vectors;
    vectors.resize(0, 0);  // A column of a large mesh needs much memory.
  }
  Eigen::MatrixXd of_moduli(m, m * num_moduli);
  for (Eigen::Index i = 0; i < num_moduli; ++i) {
    of_moduli.block(0, m * i, old, old) =
        load_case.of_moduli.middleCols(old * i, old);
  }
  for (Eigen::Index j = old; j < m; ++j) {
    ++element_passes_;
    const std::vector<Eigen::MatrixXd> forces =
        forces_.Products(load_case.basis.col(j));
    for (Eigen::Index i = 0; i < num_moduli; ++i) {
      const Eigen::VectorXd products =
          InnerProducts(load_case.basis, forces[i]);
      of_moduli.col(m * i + j) = products;
      of_moduli.row(j).segment(m * i, m) = products.transpose();
    }
  }
  load_case.of_moduli = of_moduli;
  load_case.load = InnerProducts(load_case.basis, load_.col(k));
  if (load_case.held_columns.size() > 0) {
    load_case.held_load =
        InnerProducts(load_case.basis, load_case.held_columns);
  } else {
    load_case.held_load.setZero(m, num_moduli);
  }
  const Eigen::Index first = observed_.CaseStart(k);
  const Eigen::Index num_rows = observed_.CaseStart(k + 1) - first;
  Eigen::MatrixXd rows(num_rows, m + 1);
  for (Eigen::Index j = 0; j < m; ++j) {
    rows.col(j) = observed_.RestrictToCase(k, load_case.basis.col(j));
  }
  rows.col(m) = observed_.Measured().segment(first, num_rows);
  load_case.rows = TriangularFactor(rows);
}

Eigen::MatrixXd ReducedEquilibrium::SolveIn(const LoadCase& load_case,
                                            const Eigen::MatrixXd& columns) {
  const auto lower = load_case.factor.triangularView<Eigen::Lower>();
  return lower.transpose().solve(lower.solve(columns));
}

bool ReducedEquilibrium::Solve(const Eigen::VectorXd& moduli) {
  for (LoadCase& load_case : cases_) {
    load_case.stiffness = StiffnessOf(load_case, moduli);
    const Eigen::LLT<Eigen::MatrixXd> cholesky(load_case.stiffness);
    if (cholesky.info() != Eigen::Success) {
      return false;
    }
    load_case.factor = cholesky.matrixL();
    load_case.y =
        SolveIn(load_case, load_case.load - load_case.held_load * moduli);
    if (!load_case.y.allFinite()) {
      return false;
    }
  }
  return true;
}

Eigen::MatrixXd ReducedEquilibrium::Derivatives(
    const LoadCase& load_case, const Eigen::MatrixXd& directions) const {
  const Eigen::Index m = load_case.basis.cols();
  Eigen::MatrixXd forces = load_case.held_load;
  for (Eigen::Index k = 0; k < directions.rows(); ++k) {
    forces.col(k) += load_case.of_moduli.middleCols(m * k, m) * load_case.y;
  }
  return -SolveIn(load_case, forces * directions);
}

Eigen::Index ReducedEquilibrium::NumRows() const {
  Eigen::Index sum = 0;
  for (const LoadCase& load_case : cases_) {
    sum += load_case.rows.rows();
  }
  return sum;
}

Eigen::VectorXd ReducedEquilibrium::Residual() const {
  Eigen::VectorXd residual(NumRows());
  Eigen::Index first = 0;
  for (const LoadCase& load_case : cases_) {
    const Eigen::MatrixXd& rows = load_case.rows;
    residual.segment(first, rows.rows()) =
        rows.leftCols(load_case.y.size()) * load_case.y - rows.rightCols<1>();
    first += rows.rows();
  }
  return residual;
}

Eigen::MatrixXd ReducedEquilibrium::Sensitivities(
    const Eigen::MatrixXd& directions) {
  Eigen::MatrixXd sensitivities(NumRows(), directions.cols());
  Eigen::Index first = 0;
  for (const LoadCase& load_case : cases_) {
    const Eigen::MatrixXd& rows = load_case.rows;
    sensitivities.middleRows(first, rows.rows()) =
        rows.leftCols(load_case.y.size()) * Derivatives(load_case, directions);
    first += rows.rows();
  }
  return sensitivities;
}

Eigen::MatrixXd ReducedEquilibrium::Displacement() const {
  Eigen::MatrixXd displacement(load_.rows(), load_.cols());
  for (Eigen::Index k = 0; k < load_.cols(); ++k) {
    displacement.col(k) = cases_[k].basis * cases_[k].y;
    if (cases_[k].held.size() > 0) {
      displacement.col(k) += cases_[k].held;
    }
  }
  return displacement;
}

Eigen::MatrixXd ReducedEquilibrium::DisplacementSensitivities(
    const Eigen::MatrixXd& directions) {
  const Eigen::Index n = directions.cols();
  Eigen::MatrixXd sensitivities(load_.rows(), n * load_.cols());
  for (Eigen::Index k = 0; k < load_.cols(); ++k) {
    sensitivities.middleCols(n * k, n) =
        cases_[k].basis * Derivatives(cases_[k], directions);
  }
  return sensitivities;
}

Eigen::MatrixXd ReducedEquilibrium::Adjoint() {
  Eigen::MatrixXd adjoint(load_.rows(), load_.cols());
  const Eigen::VectorXd residual = Residual();
  Eigen::Index first = 0;
  for (Eigen::Index k = 0; k < load_.cols(); ++k) {
    const Eigen::MatrixXd& rows = cases_[k].rows;
    adjoint.col(k) =
        cases_[k].basis *
        SolveIn(cases_[k], rows.leftCols(cases_[k].y.size()).transpose() *
                               residual.segment(first, rows.rows()));
    first += rows.rows();
  }
  return adjoint;
}

void ReducedEquilibrium::ForgetBases() {
  for (LoadCase& load_case : cases_) {
    load_case.basis.resize(load_.rows(), 0);
    load_case.of_moduli.resize(0, 0);
    load_case.held_load.resize(0, NumModuli());
  }
}

Eigen::MatrixXd ReducedEquilibrium::EnergyOfSensitivities(
    const Eigen::MatrixXd& directions) {
  const Eigen::Index n = directions.cols();
  Eigen::MatrixXd energy = Eigen::MatrixXd::Zero(n, n);
  for (const LoadCase& load_case : cases_) {
    const Eigen::MatrixXd derivatives = Derivatives(load_case, directions);
    energy += derivatives.transpose() * load_case.stiffness * derivatives;
  }
  return energy;
}

double ReducedEquilibrium::ComplianceNorm() const {
  double largest = 0;
  for (const LoadCase& load_case : cases_) {
    const Eigen::MatrixXd rows = load_case.rows.leftCols(load_case.y.size());
    const SymmetricEigenDecomposition modes =
        DecomposeSymmetric(rows.transpose() * rows, load_case.stiffness);
    if (modes.values.size() > 0) {
      largest = std::max(largest, modes.values.maxCoeff());
    }
  }
  return std::sqrt(largest);
}

}  // namespace elastimate
