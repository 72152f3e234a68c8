#include "elastimate/core/solvers/v_cycle.h"

#include <Eigen/LU>
#include <cassert>
#include <limits>
#include <random>

namespace elastimate {
namespace {

// The smoother damps eigenvalues of D^-1 K between these shares of the largest
// one, which is an estimate.  The rest is left to the coarser space.
constexpr double kUpper = 1.2;
constexpr double kLower = 0.1;

// After so many steps the largest Ritz value is 6 to 10 % too small.
constexpr int kSteps = 6;

template <int kDimension>
void InvertFree(const Eigen::MatrixXd& blocks, const Eigen::VectorXd& is_free,
                Eigen::MatrixXd& inverses) {
  using Block = Eigen::Matrix<double, kDimension, kDimension>;
  for (Eigen::Index i = 0; i < blocks.cols(); i += kDimension) {
    const auto free = is_free.segment<kDimension>(i);
    Block block = free.asDiagonal() * Block(blocks.middleCols<kDimension>(i)) *
                  free.asDiagonal();
    block.diagonal() += Eigen::Matrix<double, kDimension, 1>::Ones() - free;
    inverses.middleCols<kDimension>(i) =
        free.asDiagonal() * Block(block.inverse()) * free.asDiagonal();
  }
}

// Sets x to keep x + B v for such blocks B, in one pass over memory.
template <int kDimension, class Columns>
void AddEach(const Eigen::MatrixXd& blocks, const Columns& v, double keep,
             Eigen::MatrixXd& x) {
  // A thread takes about as long to start as so many rows.
  constexpr Eigen::Index kFewRows = 20000;
  const Eigen::Index num_rows = x.rows();
  for (Eigen::Index k = 0; k < x.cols(); ++k) {
#pragma omp parallel for schedule(static) if (num_rows > kFewRows)
    for (Eigen::Index i = 0; i < num_rows; i += kDimension) {
      const Eigen::Matrix<double, kDimension, 1> of_node =
          v.col(k).template segment<kDimension>(i);
      auto sum = x.col(k).segment<kDimension>(i);
      sum = keep * sum + (blocks.middleCols<kDimension>(i)
                              .template topRows<kDimension>()
                              .lazyProduct(of_node));
    }
  }
}

template <class Columns>
void AddBlocksTimes(const Eigen::MatrixXd& blocks, const Columns& v,
                    double keep, Eigen::MatrixXd& x) {
  if (blocks.rows() == 3) {
    AddEach<3>(blocks, v, keep, x);
  } else if (blocks.rows() == 2) {
    AddEach<2>(blocks, v, keep, x);
  } else {
    AddEach<1>(blocks, v, keep, x);
  }
}

template <class Columns>
Eigen::MatrixXd MultiplyBlocks(const Eigen::MatrixXd& blocks,
                               const Columns& v) {
  Eigen::MatrixXd products = Eigen::MatrixXd::Zero(v.rows(), v.cols());
  AddBlocksTimes(blocks, v, 1, products);
  return products;
}

// Returns what two steps of Chebyshev's iteration for K x = force make of
// x = 0.
Eigen::MatrixXd Smooth(const CycleSpace& space, const Eigen::MatrixXd& force) {
  const double middle = (kUpper + kLower) / 2 * space.largest_eigenvalue;
  const double radius = (kUpper - kLower) / 2 * space.largest_eigenvalue;
  // The three-term recurrence is that of [Saad, Iterative Methods for Sparse
  // Linear Systems, algorithm 12.1].
  const double share = 1 / (2 * middle / radius - radius / middle);
  Eigen::MatrixXd x = MultiplyBlocks(space.inverse_blocks, force / middle);
  const Eigen::MatrixXd product = space.multiply(x);
  AddBlocksTimes(space.inverse_blocks, 2 * share / radius * (force - product),
                 1 + share * radius / middle, x);
  return x;
}

// Returns force - K x.
Eigen::MatrixXd Rest(const CycleSpace& space, const Eigen::MatrixXd& force,
                     const Eigen::MatrixXd& x) {
  Eigen::MatrixXd rest = space.multiply(x);
  rest = force - rest;
  return rest;
}

Eigen::MatrixXd CycleFrom(const std::vector<CycleSpace>& spaces,
                          std::size_t num_spaces,
                          const ColumnOperator& solve_coarsest,
                          const Eigen::MatrixXd& force) {
  if (num_spaces == 0) {
    return solve_coarsest(force);
  }
  const CycleSpace& space = spaces[num_spaces - 1];
  Eigen::MatrixXd x = Smooth(space, force);
  // The rest of the force is computed twice rather than kept, because a column
  // of a fine space needs much memory.
  Eigen::MatrixXd coarse = space.restrict(Rest(space, force, x));
  coarse = CycleFrom(spaces, num_spaces - 1, solve_coarsest, coarse);
  x += space.interpolate(coarse);
  x += Smooth(space, Rest(space, force, x));
  return x;
}

// Returns signs that are the same in every run, and to which no mode of a
// specimen is orthogonal but by accident.
Eigen::VectorXd RandomSigns(Eigen::Index size, const Ranks* ranks) {
  std::minstd_rand random(ranks == nullptr ? 1 : 1 + ranks->Rank());
  return Eigen::VectorXd::NullaryExpr(
      size, [&] { return random() % 2 == 0 ? 1.0 : -1.0; });
}

}  // namespace

Eigen::MatrixXd VCycle(const std::vector<CycleSpace>& spaces,
                       const ColumnOperator& solve_coarsest,
                       const Eigen::MatrixXd& force) {
  return CycleFrom(spaces, spaces.size(), solve_coarsest, force);
}

Eigen::MatrixXd InverseBlocks(const Eigen::MatrixXd& blocks,
                              const Eigen::VectorXd& is_free) {
  Eigen::MatrixXd inverses(blocks.rows(), blocks.cols());
  if (blocks.rows() == 3) {
    InvertFree<3>(blocks, is_free, inverses);
  } else if (blocks.rows() == 2) {
    InvertFree<2>(blocks, is_free, inverses);
  } else {
    assert(blocks.rows() == 1);
    InvertFree<1>(blocks, is_free, inverses);
  }
  return inverses;
}

double LargestEigenvalue(const ColumnOperator& multiply,
                         const Eigen::MatrixXd& inverse_blocks,
                         int& num_products, const Ranks* ranks) {
  ConjugateGradientOptions options;
  options.ranks = ranks;
  options.tolerance = 0;
  options.most_iterations = kSteps;
  const ConjugateGradientResult result = SolveByConjugateGradients(
      multiply,
      [&](const Eigen::MatrixXd& x) {
        return MultiplyBlocks(inverse_blocks, x);
      },
      multiply(RandomSigns(inverse_blocks.cols(), ranks)), {}, options);
  num_products += 1 + result.products;
  // A few elements have fewer directions than there are steps.  Where not even
  // the first direction has a positive energy, K is not positive definite.
  return result.iterations > 0 ? result.largest_eigenvalue
                               : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace elastimate
