#include "elastimate/core/equilibrium/nested_stiffness.h"

#include <Eigen/LU>
#include <limits>
#include <random>

#include "elastimate/core/solvers/conjugate_gradients.h"

namespace elastimate {
namespace {

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

template <int kDimension>
void MultiplyEach(const Eigen::MatrixXd& blocks, const Eigen::MatrixXd& columns,
                  Eigen::MatrixXd& products) {
  for (Eigen::Index k = 0; k < columns.cols(); ++k) {
    for (Eigen::Index i = 0; i < columns.rows(); i += kDimension) {
      products.col(k).segment<kDimension>(i) =
          blocks.middleCols<kDimension>(i)
              .template topRows<kDimension>()
              .lazyProduct(columns.col(k).segment<kDimension>(i));
    }
  }
}

template <int kDimension>
void AddEach(const Eigen::MatrixXd& blocks, const Eigen::MatrixXd& a,
             const Eigen::MatrixXd& b, double keep, double scale,
             Eigen::MatrixXd& x) {
  using Vector = Eigen::Matrix<double, kDimension, 1>;
  for (Eigen::Index k = 0; k < x.cols(); ++k) {
    for (Eigen::Index i = 0; i < x.rows(); i += kDimension) {
      const Vector difference = scale * (a.col(k).segment<kDimension>(i) -
                                         b.col(k).segment<kDimension>(i));
      auto of_node = x.col(k).segment<kDimension>(i);
      of_node = keep * of_node + (blocks.middleCols<kDimension>(i)
                                      .template topRows<kDimension>()
                                      .lazyProduct(difference));
    }
  }
}

// Returns signs that are the same in every run, and to which no mode of a
// specimen is orthogonal but by accident.
Eigen::VectorXd RandomSigns(Eigen::Index size) {
  std::minstd_rand random(1);
  return Eigen::VectorXd::NullaryExpr(
      size, [&] { return random() % 2 == 0 ? 1.0 : -1.0; });
}

bool BeginsWithNodesOf(const Mesh& coarse, const Mesh& fine) {
  return coarse.Dimension() == fine.Dimension() &&
         coarse.NumNodes() < fine.NumNodes() &&
         fine.NumElements() % coarse.NumElements() == 0 &&
         fine.nodes.leftCols(coarse.NumNodes()) == coarse.nodes;
}

}  // namespace

bool AreNested(const std::vector<const Scene*>& spaces) {
  if (spaces.size() < 2) {
    return false;
  }
  for (std::size_t i = 0; i < spaces.size(); ++i) {
    const Mesh& mesh = spaces[i]->mesh;
    if (IsCurved(mesh.kind) || (i > 0 && mesh.Order() != 2)) {
      return false;
    }
    if (i > 0 && !BeginsWithNodesOf(spaces[i - 1]->mesh, mesh)) {
      return false;
    }
  }
  return true;
}

NestedStiffness::NestedStiffness(const std::vector<const Scene*>& spaces)
    : finer_(spaces.size() - 1) {
  for (std::size_t i = 0; i < spaces.size(); ++i) {
    forces_.emplace_back(spaces[i]->mesh, spaces[i]->materials);
    if (i > 0) {
      nodes_after_.emplace_back(spaces[i - 1]->mesh, spaces[i]->mesh);
    }
  }
}

void NestedStiffness::SetModuli(const Eigen::VectorXd& moduli,
                                const NodeGraph& graph) {
  moduli_ = moduli;
  blocks_ = forces_[0].Blocks(moduli, graph);
  if (NumSpaces() == 1) {
    ++num_passes_;
  }
  for (std::size_t space = 1; space < NumSpaces(); ++space) {
    Finer& finer = finer_[space - 1];
    finer.diagonal_blocks = forces_[space].DiagonalBlocks(moduli);
    const Eigen::VectorXd every =
        Eigen::VectorXd::Ones(finer.diagonal_blocks.cols());
    const Eigen::MatrixXd inverses =
        InverseBlocks(finer.diagonal_blocks, every);
    ConjugateGradientOptions options;
    options.tolerance = 0;
    options.most_iterations = kSteps;
    const ConjugateGradientResult result = SolveByConjugateGradients(
        [&](const Eigen::MatrixXd& x) { return Multiply(space, x); },
        [&](const Eigen::MatrixXd& x) { return MultiplyBlocks(inverses, x); },
        MultiplyBlocks(finer.diagonal_blocks, RandomSigns(every.size())), {},
        options);
    // A few elements have fewer directions than there are steps.  Where not
    // even the first direction has a positive energy, K is not positive
    // definite.
    finer.largest_eigenvalue = result.iterations > 0
                                   ? result.largest_eigenvalue
                                   : std::numeric_limits<double>::quiet_NaN();
    if (space + 1 == NumSpaces()) {
      num_passes_ += 1 + result.products;
    }
  }
}

Eigen::MatrixXd InverseBlocks(const Eigen::MatrixXd& blocks,
                              const Eigen::VectorXd& is_free) {
  Eigen::MatrixXd inverses(blocks.rows(), blocks.cols());
  if (blocks.rows() == 3) {
    InvertFree<3>(blocks, is_free, inverses);
  } else {
    InvertFree<2>(blocks, is_free, inverses);
  }
  return inverses;
}

Eigen::MatrixXd MultiplyBlocks(const Eigen::MatrixXd& blocks,
                               const Eigen::MatrixXd& columns) {
  Eigen::MatrixXd products(columns.rows(), columns.cols());
  if (blocks.rows() == 3) {
    MultiplyEach<3>(blocks, columns, products);
  } else {
    MultiplyEach<2>(blocks, columns, products);
  }
  return products;
}

void RelaxByBlocks(const Eigen::MatrixXd& blocks, const Eigen::MatrixXd& a,
                   const Eigen::MatrixXd& b, double keep, double scale,
                   Eigen::MatrixXd& x) {
  if (blocks.rows() == 3) {
    AddEach<3>(blocks, a, b, keep, scale, x);
  } else {
    AddEach<2>(blocks, a, b, keep, scale, x);
  }
}

}  // namespace elastimate
