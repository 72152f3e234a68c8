#include "elastimate/core/solvers/algebraic_multigrid.h"

#include <utility>

#include "elastimate/core/solvers/free_memory.h"

namespace elastimate {
namespace {

constexpr int kMostIterations = 500;

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

AlgebraicMultigrid::AlgebraicMultigrid(FindSpaces find_spaces)
    : find_spaces_(std::move(find_spaces)) {}

bool AlgebraicMultigrid::Factorize(const Eigen::VectorXd& values) {
  cycle_.clear();
  restrictions_.clear();
  spaces_ = {};  // Its memory is needed.
  smallest_eigenvalue_ = 1;
  const bool is_set_up = values.allFinite() && find_spaces_(values, spaces_) &&
                         FactorizeCoarsest() && SetUpCycle();
  ReturnFreeMemory();
  return is_set_up;
}

bool AlgebraicMultigrid::FactorizeCoarsest() {
  Eigen::SparseMatrix<double> matrix = Sparse(spaces_.matrices.front());
  const Eigen::VectorXd diagonal = matrix.diagonal();
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    matrix.coeffRef(i, i) += diagonal(i) > 0 ? kShift * diagonal(i) : 1;
  }
  coarsest_.compute(matrix);
  return coarsest_.info() == Eigen::Success &&
         (coarsest_.vectorD().array() > 0).all();
}

bool AlgebraicMultigrid::SetUpCycle() {
  for (const BlockMatrix& interpolation : spaces_.interpolations) {
    restrictions_.push_back(Transposed(interpolation));
  }
  const std::size_t num_spaces = spaces_.matrices.size();
  for (std::size_t i = 1; i < num_spaces; ++i) {
    const BlockMatrix& matrix = spaces_.matrices[i];
    CycleSpace& space = cycle_.emplace_back();
    space.multiply = [&matrix](const Eigen::MatrixXd& x) {
      return Multiply(matrix, x);
    };
    space.restrict = [&to = restrictions_[i - 1]](const Eigen::MatrixXd& x) {
      return Multiply(to, x);
    };
    space.interpolate =
        [&from = spaces_.interpolations[i - 1]](const Eigen::MatrixXd& x) {
          return Multiply(from, x);
        };
    const Eigen::MatrixXd blocks = DiagonalBlocks(matrix);
    const Eigen::RowVectorXd diagonal = DiagonalOf(blocks);
    // Blocks of coarse spaces may be singular, as their modes may be.
    space.inverse_blocks = InverseBlocks(
        i + 1 == num_spaces ? blocks : Eigen::MatrixXd(diagonal),
        (diagonal.array() > 0).cast<double>().matrix().transpose());
    int num_products = 0;
    space.largest_eigenvalue =
        LargestEigenvalue(space.multiply, space.inverse_blocks, num_products);
    if (!(space.largest_eigenvalue > 0)) {
      return false;
    }
  }
  return true;
}

std::optional<Eigen::MatrixXd> AlgebraicMultigrid::Solve(
    const Eigen::MatrixXd& right_hand_sides, double tolerance) {
  const BlockMatrix& finest = spaces_.matrices.back();
  Eigen::MatrixXd forces =
      Eigen::MatrixXd::Zero(finest.NumRows(), right_hand_sides.cols());
  forces(spaces_.row_of_free, Eigen::all) = right_hand_sides;
  ConjugateGradientOptions options;
  options.tolerance = tolerance;
  options.most_iterations = kMostIterations;
  options.smallest_eigenvalue = smallest_eigenvalue_;
  const ConjugateGradientResult result = SolveByConjugateGradients(
      [&](const Eigen::MatrixXd& x) { return MultiplyAccurately(finest, x); },
      [&](const Eigen::MatrixXd& x) {
        return VCycle(
            cycle_,
            [&](const Eigen::MatrixXd& coarsest) {
              return Eigen::MatrixXd(coarsest_.solve(coarsest));
            },
            x);
      },
      forces, {}, options);
  num_iterations_ += result.iterations;
  if (!result.has_converged) {
    return std::nullopt;
  }
  smallest_eigenvalue_ = result.smallest_eigenvalue;
  return result.solution(spaces_.row_of_free, Eigen::all);
}

}  // namespace elastimate
