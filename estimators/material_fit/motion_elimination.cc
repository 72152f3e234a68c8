#include "elastimate/estimators/material_fit/motion_elimination.h"

#include <algorithm>
#include <cmath>

#include "elastimate/core/algebra/dense_algebra.h"

namespace elastimate {
namespace {

// What an iteration takes from the square sum, relative to it, where no more is
// worth while: of a fit, a millionth of the noise; of sensitivities, what does
// not slow a Gauss-Newton step down.
constexpr double kExact = 1e-12;
constexpr double kOfSensitivities = 1e-10;
// Up to so many amounts of a load case, the rows of each are solved for, at all
// moduli or at the first.
constexpr Eigen::Index kColumnsAtATime = 32;
constexpr Eigen::Index kMostColumnsAnew = kColumnsAtATime;
constexpr Eigen::Index kMostColumns = 400;
constexpr Eigen::Index kMostEntries = 20'000'000;
constexpr int kMostIterations = 2000;
// Of a square sum, and of eigenvalues of A^T A, relative to the largest.
constexpr double kRoundingOfRows = 1e-14;
constexpr double kDependentAmounts = 1e-13;

}  // namespace

MotionElimination::MotionElimination(const Scene& scene,
                                     const ObservedDisplacements& observed,
                                     Equilibrium& model)
    : observed_(observed), model_(model), motion_(scene) {
  const int dimension = scene.mesh.Dimension();
  const Eigen::MatrixXd measured = MeasuredSupports(scene);
  const Eigen::Index num_cases = Eigen::Index(scene.load_cases.size());
  amounts_.setZero(motion_.NumAmounts() * num_cases);
  for (Eigen::Index k = 0; k < num_cases; ++k) {
    amounts_.segment(motion_.NumAmounts() * k, motion_.of_supports.cols()) =
        motion_.of_supports.transpose() * measured.col(k);
    first_resultant_.push_back(NumResultants());
    for (const Resultant& resultant : scene.load_cases[k].resultants) {
      for (int i = 0; i < dimension; ++i) {
        if (std::isnan(resultant.force(i))) {
          continue;
        }
        ResultantRow row = {k, {}, resultant.force(i), resultant.noise_sd(i)};
        for (const int node : resultant.nodes) {
          if (scene.supports.held(i, node)) {
            row.held.push_back(dimension * Eigen::Index(node) + i);
          }
        }
        resultants_.push_back(row);
      }
    }
  }
  first_resultant_.push_back(NumResultants());
}

void MotionElimination::SetNoise(double standard_deviation) {
  noise_ = standard_deviation;
  InvertGrams();
}

Eigen::VectorXd MotionElimination::Fit() {
  SolveForColumns();
  model_.Superpose(SupportMotion(amounts_));
  return Refit();
}

Eigen::VectorXd MotionElimination::Refit() {
  Eigen::VectorXd rows = RowsOf(
      WithMotionOfAll(amounts_, model_.Displacement()), model_.SupportForces());
  rows.head(observed_.Size()) -= observed_.Measured();
  rows.tail(NumResultants()) -= noise_ * MeasuredResultants();
  const Eigen::VectorXd surplus = Minimize(kExact, rows);
  amounts_ -= surplus;
  model_.Superpose(-SupportMotion(surplus));
  return rows;
}

Eigen::VectorXd MotionElimination::Eliminate(
    const Eigen::MatrixXd& displacements,
    const Eigen::MatrixXd& support_forces) {
  Eigen::VectorXd rows = RowsOf(displacements, support_forces);
  Minimize(kOfSensitivities, rows);
  return rows;
}

Eigen::VectorXd MotionElimination::Resultants(
    const Eigen::MatrixXd& support_forces) const {
  Eigen::VectorXd forces(NumResultants());
  for (Eigen::Index k = 0; k < observed_.NumLoadCases(); ++k) {
    forces.segment(first_resultant_[k], NumResultantsOf(k)) =
        ResultantsOfCase(k, support_forces.col(k));
  }
  return forces;
}

Eigen::VectorXd MotionElimination::ResultantsOfCase(
    Eigen::Index k, const Eigen::VectorXd& support_forces) const {
  Eigen::VectorXd forces(NumResultantsOf(k));
  for (Eigen::Index i = 0; i < forces.size(); ++i) {
    const ResultantRow& row = resultants_[first_resultant_[k] + i];
    forces(i) = support_forces(row.held).sum() / row.noise_sd;
  }
  return forces;
}

Eigen::VectorXd MotionElimination::MeasuredResultants() const {
  Eigen::VectorXd forces(NumResultants());
  std::transform(
      resultants_.begin(), resultants_.end(), forces.begin(),
      [](const ResultantRow& row) { return row.force / row.noise_sd; });
  return forces;
}

Eigen::VectorXd MotionElimination::RowsOf(
    const Eigen::MatrixXd& displacements,
    const Eigen::MatrixXd& support_forces) const {
  Eigen::VectorXd rows(NumRows());
  rows << observed_.Restrict(displacements),
      noise_ * Resultants(support_forces);
  return rows;
}

Eigen::VectorXd MotionElimination::MultiplyColumns(
    const Eigen::VectorXd& amounts) const {
  Eigen::VectorXd rows(NumRows());
  for (Eigen::Index k = 0; k < observed_.NumLoadCases(); ++k) {
    const auto of_case =
        amounts.segment(motion_.NumAmounts() * k, motion_.NumAmounts());
    rows.segment(observed_.CaseStart(k), NumObservedOf(k)) =
        columns_[k].of_displacements * of_case;
    rows.segment(observed_.Size() + first_resultant_[k], NumResultantsOf(k)) =
        noise_ * (columns_[k].of_resultants * of_case);
  }
  return rows;
}

Eigen::VectorXd MotionElimination::MultiplyColumnsTransposed(
    const Eigen::VectorXd& rows) const {
  Eigen::VectorXd amounts(amounts_.size());
  for (Eigen::Index k = 0; k < observed_.NumLoadCases(); ++k) {
    amounts.segment(motion_.NumAmounts() * k, motion_.NumAmounts()) =
        columns_[k].of_displacements.transpose() *
            rows.segment(observed_.CaseStart(k), NumObservedOf(k)) +
        noise_ * (columns_[k].of_resultants.transpose() *
                  rows.segment(observed_.Size() + first_resultant_[k],
                               NumResultantsOf(k)));
  }
  return amounts;
}

Eigen::MatrixXd MotionElimination::SupportMotion(
    const Eigen::VectorXd& amounts) {
  const auto of_cases =
      amounts.reshaped(motion_.NumAmounts(), observed_.NumLoadCases());
  return model_.Extend(motion_.of_supports *
                       of_cases.topRows(motion_.of_supports.cols()));
}

Eigen::MatrixXd MotionElimination::WithMotionOfAll(
    const Eigen::VectorXd& amounts, Eigen::MatrixXd displacements) const {
  const auto of_cases =
      amounts.reshaped(motion_.NumAmounts(), observed_.NumLoadCases());
  displacements += motion_.of_all * of_cases.bottomRows(motion_.of_all.cols());
  return displacements;
}

Eigen::VectorXd MotionElimination::Multiply(const Eigen::VectorXd& amounts) {
  if (are_columns_of_here_) {
    return MultiplyColumns(amounts);
  }
  const Eigen::MatrixXd motion = SupportMotion(amounts);
  return RowsOf(WithMotionOfAll(amounts, motion), model_.HeldForces(motion));
}

Eigen::VectorXd MotionElimination::MultiplyTransposed(
    const Eigen::VectorXd& rows) {
  if (are_columns_of_here_) {
    return MultiplyColumnsTransposed(rows);
  }
  const Eigen::MatrixXd of_nodes =
      observed_.RestrictTransposed(rows.head(observed_.Size()));
  Eigen::MatrixXd forces =
      Eigen::MatrixXd::Zero(of_nodes.rows(), of_nodes.cols());
  for (Eigen::Index i = 0; i < NumResultants(); ++i) {
    const ResultantRow& row = resultants_[i];
    for (const Eigen::Index dof : row.held) {
      forces(dof, row.load_case) +=
          noise_ / row.noise_sd * rows(observed_.Size() + i);
    }
  }
  Eigen::MatrixXd amounts(motion_.NumAmounts(), observed_.NumLoadCases());
  amounts << motion_.of_supports.transpose() *
                 model_.ExtendTransposed(of_nodes +
                                         model_.HeldForcesTransposed(forces)),
      motion_.of_all.transpose() * of_nodes;
  return amounts.reshaped();
}

void MotionElimination::SolveForColumns() {
  const Eigen::Index n = motion_.NumAmounts();
  are_columns_of_here_ = false;
  if (n == 0 || n > kMostColumns || n * NumRows() > kMostEntries ||
      (n > kMostColumnsAnew && !columns_.empty())) {
    return;
  }
  are_columns_of_here_ = true;
  columns_.clear();
  for (Eigen::Index k = 0; k < observed_.NumLoadCases(); ++k) {
    columns_.push_back({Eigen::MatrixXd(NumObservedOf(k), n),
                        Eigen::MatrixXd(NumResultantsOf(k), n),
                        {}});
  }
  const Eigen::Index num_of_supports = motion_.of_supports.cols();
  for (Eigen::Index first = 0; first < n; first += kColumnsAtATime) {
    const Eigen::Index end = std::min(n, first + kColumnsAtATime);
    Eigen::MatrixXd motions(motion_.of_all.rows(), end - first);
    for (Eigen::Index j = first; j < end; ++j) {
      motions.col(j - first) =
          j < num_of_supports
              ? Eigen::VectorXd(motion_.of_supports.col(j))
              : Eigen::VectorXd(motion_.of_all.col(j - num_of_supports));
    }
    const Eigen::Index num_extended =
        std::clamp<Eigen::Index>(num_of_supports - first, 0, end - first);
    motions.leftCols(num_extended) =
        model_.Extend(motions.leftCols(num_extended));
    Eigen::MatrixXd forces =
        Eigen::MatrixXd::Zero(motions.rows(), motions.cols());
    forces.leftCols(num_extended) =
        model_.HeldForces(motions.leftCols(num_extended));
    for (Eigen::Index k = 0; k < observed_.NumLoadCases(); ++k) {
      for (Eigen::Index j = first; j < end; ++j) {
        columns_[k].of_displacements.col(j) =
            observed_.RestrictToCase(k, motions.col(j - first));
        columns_[k].of_resultants.col(j) =
            ResultantsOfCase(k, forces.col(j - first));
      }
    }
  }
  InvertGrams();
}

void MotionElimination::InvertGrams() {
  for (Columns& columns : columns_) {
    const SymmetricEigenDecomposition gram = DecomposeSymmetric(
        columns.of_displacements.transpose() * columns.of_displacements +
        noise_ * noise_ *
            (columns.of_resultants.transpose() * columns.of_resultants));
    // What rigid motions of supports and of all have in common is zero here.
    const double least = kDependentAmounts * gram.values.maxCoeff();
    columns.inverse_gram = gram.vectors *
                           (gram.values.array() > least)
                               .select(gram.values.cwiseInverse().array(), 0.0)
                               .matrix()
                               .asDiagonal() *
                           gram.vectors.transpose();
  }
}

Eigen::VectorXd MotionElimination::Precondition(
    const Eigen::VectorXd& gradient) const {
  if (columns_.empty()) {
    return gradient;
  }
  Eigen::VectorXd direction(gradient.size());
  for (std::size_t k = 0; k < columns_.size(); ++k) {
    const Eigen::Index first = motion_.NumAmounts() * Eigen::Index(k);
    direction.segment(first, motion_.NumAmounts()) =
        columns_[k].inverse_gram *
        gradient.segment(first, motion_.NumAmounts());
  }
  return direction;
}

Eigen::VectorXd MotionElimination::Minimize(double tolerance,
                                            Eigen::VectorXd& rows) {
  Eigen::VectorXd amounts = Eigen::VectorXd::Zero(amounts_.size());
  if (amounts.size() == 0) {
    return amounts;
  }
  const double nothing = kRoundingOfRows * kRoundingOfRows * rows.squaredNorm();
  Eigen::VectorXd gradient = MultiplyTransposed(rows);
  Eigen::VectorXd preconditioned = Precondition(gradient);
  Eigen::VectorXd direction = preconditioned;
  double square = gradient.dot(preconditioned);
  for (int i = 0; i < kMostIterations && square > 0; ++i) {
    const Eigen::VectorXd step = Multiply(direction);
    const double length = square / step.squaredNorm();
    amounts += length * direction;
    rows -= length * step;
    const double left = rows.squaredNorm();
    if (left <= nothing || length * square <= tolerance * left) {
      break;
    }
    gradient = MultiplyTransposed(rows);
    preconditioned = Precondition(gradient);
    const double next = gradient.dot(preconditioned);
    direction = preconditioned + next / square * direction;
    square = next;
  }
  return amounts;
}

}  // namespace elastimate
