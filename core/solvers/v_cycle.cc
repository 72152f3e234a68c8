#include "elastimate/core/solvers/v_cycle.h"

#include <Eigen/LU>
#include <cassert>
#include <limits>
#include <random>
#include <utility>

#include "elastimate/core/algebra/tall_columns.h"

namespace elastimate {
namespace {

// The smoother damps eigenvalues of D^-1 K between these shares of the largest
// one, which is an estimate.  The rest is left to the coarser space.
constexpr double kUpper = 1.2;
constexpr double kLower = 0.1;

// After so many steps the largest Ritz value is 6 to 10 % too small.
constexpr int kSteps = 6;

template <int kDimension>
void InvertEach(const Eigen::MatrixXd& blocks, Eigen::MatrixXf& inverses) {
  using Block = Eigen::Matrix<double, kDimension, kDimension>;
  for (Eigen::Index i = 0; i < blocks.cols(); i += kDimension) {
    const Block block = blocks.middleCols<kDimension>(i);
    inverses.middleCols<kDimension>(i) =
        Block(block.inverse()).template cast<float>();
  }
}

// Sets x to keep x + B v for such blocks B, in one pass over memory.
template <int kDimension, class Columns>
void AddEach(const Eigen::MatrixXf& blocks, const Columns& v, double keep,
             Eigen::MatrixXd& x) {
  for (Eigen::Index k = 0; k < x.cols(); ++k) {
    ForRowBlocks(
        x.rows() / kDimension, [&](Eigen::Index first, Eigen::Index count) {
          for (Eigen::Index node = first; node < first + count; ++node) {
            const Eigen::Index i = kDimension * node;
            const Eigen::Matrix<double, kDimension, 1> of_node =
                v.col(k).template segment<kDimension>(i);
            auto sum = x.col(k).segment<kDimension>(i);
            sum = keep * sum + (blocks.middleCols<kDimension>(i)
                                    .template topRows<kDimension>()
                                    .template cast<double>()
                                    .lazyProduct(of_node));
          }
        });
  }
}

template <class Columns>
void AddBlocksTimes(const Eigen::MatrixXf& blocks, const Columns& v,
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
Eigen::MatrixXd MultiplyBlocks(const Eigen::MatrixXf& blocks,
                               const Columns& v) {
  Eigen::MatrixXd products = Eigen::MatrixXd::Zero(v.rows(), v.cols());
  AddBlocksTimes(blocks, v, 1, products);
  return products;
}

// Chebyshev's iteration of two steps for K x = force: the three-term recurrence
// [Saad, Iterative Methods for Sparse Linear Systems, algorithm 12.1]
//
//   x1 = x0 + D^-1 (force - K x0) / middle,
//   x2 = x1 + momentum (x1 - x0) + length D^-1 (force - K x1).
struct Chebyshev {
  double middle;
  double momentum;
  double length;

  explicit Chebyshev(double largest_eigenvalue)
      : middle((kUpper + kLower) / 2 * largest_eigenvalue) {
    const double radius = (kUpper - kLower) / 2 * largest_eigenvalue;
    const double share = 1 / (2 * middle / radius - radius / middle);
    momentum = share * radius / middle;
    length = 2 * share / radius;
  }
};

// Returns what Chebyshev's iteration makes of x = 0.
Eigen::MatrixXd SmoothFromZero(const CycleSpace& space,
                               const Eigen::MatrixXd& force) {
  const Chebyshev steps(space.largest_eigenvalue);
  Eigen::MatrixXd x =
      MultiplyBlocks(space.inverse_blocks, force / steps.middle);
  const Eigen::MatrixXd product = space.multiply(x);
  AddBlocksTimes(space.inverse_blocks, steps.length * (force - product),
                 1 + steps.momentum, x);
  return x;
}

void Smooth(const CycleSpace& space, const Eigen::MatrixXd& force,
            Eigen::MatrixXd& x) {
  const Chebyshev steps(space.largest_eigenvalue);
  Eigen::MatrixXd product = space.multiply(x);
  Eigen::MatrixXd change =
      MultiplyBlocks(space.inverse_blocks, (force - product) / steps.middle);
  AddTo(x, change);
  product.resize(0, 0);  // A column of a fine space needs much memory.
  product = space.multiply(x);
  AddBlocksTimes(space.inverse_blocks, steps.length * (force - product),
                 steps.momentum, change);
  AddTo(x, change);
}

// Returns force - K x.
Eigen::MatrixXd Rest(const CycleSpace& space, const Eigen::MatrixXd& force,
                     const Eigen::MatrixXd& x) {
  Eigen::MatrixXd rest = space.multiply(x);
  ForRowBlocks(rest.rows(), [&](Eigen::Index first, Eigen::Index count) {
    rest.middleRows(first, count) =
        force.middleRows(first, count) - rest.middleRows(first, count);
  });
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
  Eigen::MatrixXd x = SmoothFromZero(space, force);
  Eigen::MatrixXd coarse = space.restrict(Rest(space, force, x));
  coarse = CycleFrom(spaces, num_spaces - 1, solve_coarsest, coarse);
  AddTo(x, space.interpolate(coarse));
  Smooth(space, force, x);
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

Eigen::MatrixXf InverseBlocks(const Eigen::MatrixXd& blocks) {
  const Eigen::Index size = blocks.rows();
  Eigen::MatrixXf inverses(blocks.rows(), blocks.cols());
  if (size == 3) {
    InvertEach<3>(blocks, inverses);
  } else if (size == 2) {
    InvertEach<2>(blocks, inverses);
  } else {
    assert(size == 1);
    InvertEach<1>(blocks, inverses);
  }
  return inverses;
}

void HoldInInverses(const std::vector<Eigen::Index>& held,
                    Eigen::MatrixXf& inverse_blocks) {
  const Eigen::Index size = inverse_blocks.rows();
  for (const Eigen::Index row : held) {
    const Eigen::Index i = row % size;
    auto block = inverse_blocks.middleCols(row - i, size);
    const Eigen::VectorXf column = block.col(i);
    block -= column * column.transpose() / column(i);
    block.row(i).setZero();
    block.col(i).setZero();
  }
}

double LargestEigenvalue(const ColumnOperator& multiply,
                         const Eigen::MatrixXf& inverse_blocks,
                         int& num_products, const Ranks* ranks) {
  ConjugateGradientOptions options;
  options.ranks = ranks;
  options.tolerance = 0;
  options.most_iterations = kSteps;
  Eigen::MatrixXd force = multiply(RandomSigns(inverse_blocks.cols(), ranks));
  const ConjugateGradientResult result = SolveByConjugateGradients(
      multiply,
      [&](const Eigen::MatrixXd& x) {
        return MultiplyBlocks(inverse_blocks, x);
      },
      std::move(force), {}, options);
  num_products += 1 + result.products;
  // A few elements have fewer directions than there are steps.  Where not even
  // the first direction has a positive energy, K is not positive definite.
  return result.iterations > 0 ? result.largest_eigenvalue
                               : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace elastimate
