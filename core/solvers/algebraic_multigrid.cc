#include "elastimate/core/solvers/algebraic_multigrid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "elastimate/core/solvers/free_memory.h"

namespace elastimate {
namespace {

constexpr int kMostIterations = 500;
// Spaces of another matrix are replaced at the next matrix where a solve needs
// so many times the iterations per digit that their own matrix needed.  A solve
// is stopped for that beyond 100 iterations only, because finding new spaces
// takes as long.
constexpr double kMostSlowdown = 3;
constexpr int kLeastIterationsOfOthers = 100;

// Aggregates of few nodes leave coarse spaces modes without energy.
constexpr double kShift = 1e-6;

// Returns the diagonal of blocks that stand side by side.
Eigen::RowVectorXd DiagonalOf(const Eigen::MatrixXd& blocks) {
  Eigen::RowVectorXd diagonal(blocks.cols());
  for (Eigen::Index i = 0; i < blocks.cols(); ++i) {
    diagonal(i) = blocks(i % blocks.rows(), i);
  }
  return diagonal;
}

// Returns how many rows the ranks before this one and all ranks have.
std::pair<Eigen::Index, Eigen::Index> NumBeforeAndInAll(Eigen::Index num_own,
                                                        const Ranks& ranks) {
  Eigen::RowVectorXd num_rows = Eigen::RowVectorXd::Zero(ranks.Size());
  num_rows(ranks.Rank()) = double(num_own);
  SumOverRanks(&ranks, num_rows);
  return {Eigen::Index(num_rows.head(ranks.Rank()).sum()),
          Eigen::Index(num_rows.sum())};
}

Eigen::SparseMatrix<double> Sparse(const BlockMatrix& a) {
  std::vector<Eigen::Triplet<double>> triplets;
  triplets.reserve(a.entries.size());
  std::size_t entry = 0;
  for (Eigen::Index i = 0; i < a.NumBlockRows(); ++i) {
    for (Eigen::Index k = a.start[i]; k < a.start[i + 1]; ++k) {
      for (int c = 0; c < a.block_columns; ++c) {
        for (int r = 0; r < a.block_rows; ++r) {
          triplets.emplace_back(a.block_rows * i + r,
                                a.block_columns * a.column[k] + c,
                                a.entries[entry++]);
        }
      }
    }
  }
  Eigen::SparseMatrix<double> result(a.NumRows(), a.num_columns);
  result.setFromTriplets(triplets.begin(), triplets.end());
  return result;
}

// Returns the whole of a matrix of this size, of which this rank has the rows
// from `first` on.
Eigen::SparseMatrix<double> OfAllRanks(const Eigen::SparseMatrix<double>& own,
                                       Eigen::Index first, Eigen::Index size,
                                       const Halo& halo, const Ranks& ranks) {
  // The halo brings the numbers over all ranks, as each knows those of its own.
  const Eigen::VectorXd column = halo.WithOthers(Eigen::VectorXd::LinSpaced(
      own.rows(), double(first), double(first + own.rows() - 1)));
  Eigen::MatrixXd entries(own.nonZeros(), 3);
  Eigen::Index i = 0;
  for (Eigen::Index j = 0; j < own.outerSize(); ++j) {
    for (Eigen::SparseMatrix<double>::InnerIterator it(own, j); it; ++it) {
      entries.row(i++) << double(first + it.row()), column(j), it.value();
    }
  }
  std::vector<Eigen::Triplet<double>> triplets;
  entries = ranks.AllRows(entries);
  for (const auto& entry : entries.rowwise()) {
    triplets.emplace_back(int(entry(0)), int(entry(1)), entry(2));
  }
  Eigen::SparseMatrix<double> all(size, size);
  all.setFromTriplets(triplets.begin(), triplets.end());
  return all;
}

}  // namespace

AlgebraicMultigrid::AlgebraicMultigrid(MultigridRows& rows,
                                       FindSpaces find_spaces)
    : rows_(rows), find_spaces_(std::move(find_spaces)) {}

bool AlgebraicMultigrid::Factorize() {
  are_spaces_of_matrix_ = false;
  return are_spaces_slow_ ? SetUp() : TakeFinest();
}

bool AlgebraicMultigrid::SetUp() {
  cycle_.clear();
  by_column_.clear();
  spaces_ = {};  // Its memory is needed.
  rows_.FreeMatrix();
  ++num_set_ups_;
  are_spaces_slow_ = true;  // Unless all goes well.
  Eigen::RowVectorXd failures(1);
  failures << (find_spaces_(rows_, spaces_) ? 0 : 1);
  SumOverRanks(rows_.ranks, failures);
  if (failures(0) > 0) {
    return false;
  }
  ReturnFreeMemory();
  MakeHalos();
  for (const DividedMatrix& interpolation : spaces_.interpolations) {
    by_column_.push_back(OrderByColumn(interpolation.rows));
  }
  for (std::size_t i = 1; i < spaces_.matrices.size(); ++i) {
    if (!AddSpace(spaces_.matrices[i])) {
      return false;
    }
  }
  diagonal_of_spaces_ = 0;
  if ((!spaces_.matrices.empty() && !FactorizeCoarsest()) || !TakeFinest()) {
    return false;
  }
  ReturnFreeMemory();
  are_spaces_of_matrix_ = true;
  are_spaces_slow_ = false;
  iterations_per_digit_ = 0;
  return true;
}

// The rows of a coarse space are the columns of the interpolation from it.
void AlgebraicMultigrid::MakeHalos() {
  if (rows_.ranks == nullptr) {
    return;
  }
  for (std::size_t i = 0; i < spaces_.matrices.size(); ++i) {
    const Eigen::Index num_own = spaces_.matrices[i].rows.NumBlockRows();
    const auto [first, num_all] = NumBeforeAndInAll(num_own, *rows_.ranks);
    MakeHalo(first, num_own, *rows_.ranks, spaces_.matrices[i]);
    MakeHalo(first, num_own, *rows_.ranks, spaces_.interpolations[i]);
  }
}

bool AlgebraicMultigrid::FactorizeCoarsest() {
  const DividedMatrix& divided =
      spaces_.matrices.empty() ? rows_.Matrix() : spaces_.matrices.front();
  Eigen::SparseMatrix<double> matrix = Sparse(divided.rows);
  if (rows_.ranks != nullptr) {
    const auto [first, size] = NumBeforeAndInAll(matrix.rows(), *rows_.ranks);
    first_of_coarsest_ = first;
    matrix = OfAllRanks(matrix, first, size, *divided.halo, *rows_.ranks);
  }
  const Eigen::VectorXd diagonal = matrix.diagonal();
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    matrix.coeffRef(i, i) += diagonal(i) > 0 ? kShift * diagonal(i) : 1;
  }
  coarsest_.compute(matrix);
  return coarsest_.info() == Eigen::Success &&
         (coarsest_.vectorD().array() > 0).all();
}

Eigen::MatrixXd AlgebraicMultigrid::SolveCoarsest(
    const Eigen::MatrixXd& own) const {
  if (rows_.ranks == nullptr) {
    return coarsest_.solve(own);
  }
  const Eigen::MatrixXd all = coarsest_.solve(rows_.ranks->AllRows(own));
  return all.middleRows(first_of_coarsest_, own.rows());
}

// Adds the space of a matrix to the cycle, above those that are there.
bool AlgebraicMultigrid::AddSpace(const DividedMatrix& matrix) {
  const std::size_t coarser = cycle_.size();
  const bool is_finest = coarser + 1 == spaces_.interpolations.size();
  CycleSpace& space = cycle_.emplace_back();
  space.multiply = [&matrix](const Eigen::MatrixXd& x) {
    return Multiply(matrix, x);
  };
  space.restrict = [&from = spaces_.interpolations[coarser],
                    &by_column =
                        by_column_[coarser]](const Eigen::MatrixXd& x) {
    return MultiplyTransposed(from, by_column, x);
  };
  space.interpolate = [this, is_finest,
                       coarser](const Eigen::MatrixXd& x) -> Eigen::MatrixXd {
    const DividedMatrix& from = spaces_.interpolations[coarser];
    return is_finest ? Multiply(from, x / scale_) : Multiply(from, x);
  };
  const Eigen::MatrixXd blocks = DiagonalBlocks(matrix.rows);
  const Eigen::RowVectorXd diagonal = DiagonalOf(blocks);
  if (is_finest) {
    Eigen::RowVectorXd trace = Eigen::RowVectorXd::Constant(1, diagonal.sum());
    SumOverRanks(rows_.ranks, trace);
    diagonal_of_spaces_ =
        diagonal_of_spaces_ > 0 ? diagonal_of_spaces_ : trace(0);
    scale_ = trace(0) / diagonal_of_spaces_;
  }
  // Blocks of coarse spaces may be singular, as their modes may be.
  space.inverse_blocks =
      is_finest
          ? InverseBlocks(blocks)
          : InverseBlocks(
                (diagonal.array() > 0)
                    .select(diagonal, std::numeric_limits<double>::infinity()));
  int num_products = 0;
  space.largest_eigenvalue = LargestEigenvalue(
      space.multiply, space.inverse_blocks, num_products, rows_.ranks);
  return space.largest_eigenvalue > 0;
}

// Takes the present matrix for the finest space.
bool AlgebraicMultigrid::TakeFinest() {
  if (spaces_.matrices.empty()) {
    return FactorizeCoarsest();
  }
  cycle_.resize(spaces_.matrices.size() - 1);
  return AddSpace(rows_.Matrix());
}

Eigen::MatrixXd AlgebraicMultigrid::Cycle(const Eigen::MatrixXd& force) const {
  return VCycle(
      cycle_, [&](const Eigen::MatrixXd& own) { return SolveCoarsest(own); },
      force);
}

std::optional<Eigen::MatrixXd> AlgebraicMultigrid::Solve(
    const Eigen::MatrixXd& right_hand_sides, double tolerance,
    const Eigen::MatrixXd& start) {
  std::optional<Eigen::MatrixXd> solution =
      SolveOnce(right_hand_sides, tolerance, start);
  if (!solution && !are_spaces_of_matrix_ && SetUp()) {
    solution = SolveOnce(right_hand_sides, tolerance, start);
  }
  return solution;
}

std::optional<Eigen::MatrixXd> AlgebraicMultigrid::SolveOnce(
    const Eigen::MatrixXd& right_hand_sides, double tolerance,
    const Eigen::MatrixXd& start) {
  ConjugateGradientOptions options;
  options.tolerance = tolerance;
  options.ranks = rows_.ranks;
  const double digits = std::clamp(-std::log10(tolerance), 1.0, 16.0);
  options.most_iterations =
      are_spaces_of_matrix_
          ? kMostIterations
          : std::clamp(int(kMostSlowdown * iterations_per_digit_ * digits),
                       kLeastIterationsOfOthers, kMostIterations);
  options.smallest_eigenvalue = smallest_eigenvalue_;
  ConjugateGradientResult result = SolveByConjugateGradients(
      [&](const Eigen::MatrixXd& x) {
        return MultiplyAccurately(rows_.Matrix(), x);
      },
      [&](const Eigen::MatrixXd& x) { return Cycle(x); }, right_hand_sides,
      start, options);
  num_iterations_ += result.iterations;
  if (!result.has_converged) {
    are_spaces_slow_ = true;
    return std::nullopt;
  }
  smallest_eigenvalue_ = result.smallest_eigenvalue;
  const double per_digit =
      result.iterations / (digits * std::max(double(result.columns), 1.0));
  if (!are_spaces_of_matrix_ && iterations_per_digit_ > 0) {
    are_spaces_slow_ =
        are_spaces_slow_ || per_digit > kMostSlowdown * iterations_per_digit_;
  } else if (start.cols() == 0) {
    // With a good guess, few iterations tell nothing of the spaces.
    iterations_per_digit_ = std::max(iterations_per_digit_, per_digit);
  }
  return std::move(result.solution);
}

}  // namespace elastimate
