#include "elastimate/core/solvers/algebraic_multigrid.h"

#include <algorithm>
#include <cmath>
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

}  // namespace

AlgebraicMultigrid::AlgebraicMultigrid(NodeBlocks blocks,
                                       FindSpaces find_spaces)
    : blocks_(std::move(blocks)),
      row_of_free_(blocks_.RowsOfFree()),
      find_spaces_(std::move(find_spaces)) {}

bool AlgebraicMultigrid::Factorize(const Eigen::VectorXd& values) {
  values_ = &values;
  if (!values.allFinite()) {
    return false;
  }
  are_spaces_of_matrix_ = false;
  return are_spaces_slow_ ? SetUp() : TakeFinest();
}

bool AlgebraicMultigrid::SetUp() {
  cycle_.clear();
  restrictions_.clear();
  spaces_ = {};  // Its memory is needed.
  finest_ = {};
  ++num_set_ups_;
  are_spaces_slow_ = true;  // Unless all goes well.
  if (!find_spaces_(*values_, spaces_)) {
    return false;
  }
  ReturnFreeMemory();
  for (const BlockMatrix& interpolation : spaces_.interpolations) {
    restrictions_.push_back(Transposed(interpolation));
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

bool AlgebraicMultigrid::FactorizeCoarsest() {
  Eigen::SparseMatrix<double> matrix =
      Sparse(spaces_.matrices.empty() ? finest_ : spaces_.matrices.front());
  const Eigen::VectorXd diagonal = matrix.diagonal();
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    matrix.coeffRef(i, i) += diagonal(i) > 0 ? kShift * diagonal(i) : 1;
  }
  coarsest_.compute(matrix);
  return coarsest_.info() == Eigen::Success &&
         (coarsest_.vectorD().array() > 0).all();
}

// Adds the space of a matrix to the cycle, above those that are there.
bool AlgebraicMultigrid::AddSpace(const BlockMatrix& matrix) {
  const std::size_t coarser = cycle_.size();
  const bool is_finest = coarser + 1 == spaces_.interpolations.size();
  CycleSpace& space = cycle_.emplace_back();
  space.multiply = [&matrix](const Eigen::MatrixXd& x) {
    return Multiply(matrix, x);
  };
  space.restrict = [&to = restrictions_[coarser]](const Eigen::MatrixXd& x) {
    return Multiply(to, x);
  };
  space.interpolate = [this, is_finest,
                       coarser](const Eigen::MatrixXd& x) -> Eigen::MatrixXd {
    const BlockMatrix& from = spaces_.interpolations[coarser];
    return is_finest ? Multiply(from, x / scale_) : Multiply(from, x);
  };
  const Eigen::MatrixXd blocks = DiagonalBlocks(matrix);
  const Eigen::RowVectorXd diagonal = DiagonalOf(blocks);
  if (is_finest) {
    diagonal_of_spaces_ =
        diagonal_of_spaces_ > 0 ? diagonal_of_spaces_ : diagonal.sum();
    scale_ = diagonal.sum() / diagonal_of_spaces_;
  }
  // Blocks of coarse spaces may be singular, as their modes may be.
  space.inverse_blocks =
      InverseBlocks(is_finest ? blocks : Eigen::MatrixXd(diagonal),
                    (diagonal.array() > 0).cast<double>().matrix().transpose());
  int num_products = 0;
  space.largest_eigenvalue =
      LargestEigenvalue(space.multiply, space.inverse_blocks, num_products);
  return space.largest_eigenvalue > 0;
}

// Takes the present matrix for the finest space.
bool AlgebraicMultigrid::TakeFinest() {
  finest_ = {};  // Its memory is needed.
  finest_ = blocks_.MatrixOf(*values_);
  if (spaces_.matrices.empty()) {
    return FactorizeCoarsest();
  }
  cycle_.resize(spaces_.matrices.size() - 1);
  return AddSpace(finest_);
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
  const auto in_blocks = [this](const Eigen::MatrixXd& of_free) {
    Eigen::MatrixXd rows =
        Eigen::MatrixXd::Zero(finest_.NumRows(), of_free.cols());
    rows(row_of_free_, Eigen::all) = of_free;
    return rows;
  };
  const Eigen::MatrixXd forces = in_blocks(right_hand_sides);
  ConjugateGradientOptions options;
  options.tolerance = tolerance;
  const double digits = std::clamp(-std::log10(tolerance), 1.0, 16.0);
  options.most_iterations =
      are_spaces_of_matrix_
          ? kMostIterations
          : std::clamp(int(kMostSlowdown * iterations_per_digit_ * digits),
                       kLeastIterationsOfOthers, kMostIterations);
  options.smallest_eigenvalue = smallest_eigenvalue_;
  const ConjugateGradientResult result = SolveByConjugateGradients(
      [&](const Eigen::MatrixXd& x) { return MultiplyAccurately(finest_, x); },
      [&](const Eigen::MatrixXd& x) {
        return VCycle(
            cycle_,
            [&](const Eigen::MatrixXd& coarsest) {
              return Eigen::MatrixXd(coarsest_.solve(coarsest));
            },
            x);
      },
      forces, start.size() > 0 ? in_blocks(start) : start, options);
  num_iterations_ += result.iterations;
  if (!result.has_converged) {
    are_spaces_slow_ = true;
    return std::nullopt;
  }
  smallest_eigenvalue_ = result.smallest_eigenvalue;
  const Eigen::Index num_columns =
      (forces.colwise().squaredNorm().array() > 0).count();
  const double per_digit =
      result.iterations / (digits * std::max(double(num_columns), 1.0));
  if (!are_spaces_of_matrix_ && iterations_per_digit_ > 0) {
    are_spaces_slow_ =
        are_spaces_slow_ || per_digit > kMostSlowdown * iterations_per_digit_;
  } else if (start.size() == 0) {
    // With a good guess, few iterations tell nothing of the spaces.
    iterations_per_digit_ = std::max(iterations_per_digit_, per_digit);
  }
  return result.solution(row_of_free_, Eigen::all);
}

}  // namespace elastimate
