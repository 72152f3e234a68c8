#include "elastimate/core/materials/stiffness_factors.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

namespace elastimate {
namespace {

struct BlockFactors {
  Eigen::MatrixXd lower;     ///< L.
  Eigen::VectorXd diagonal;  ///< D.
};

Eigen::Index NumModes(const std::vector<BlockEntry>& entries) {
  int num_modes = 0;
  for (const BlockEntry& entry : entries) {
    num_modes = std::max(num_modes, entry.column + 1);
  }
  return num_modes;
}

BlockFactors FactorsAt(const std::vector<BlockEntry>& entries,
                       const Eigen::VectorXd& factors) {
  const Eigen::Index size = NumModes(entries);
  BlockFactors blocks = {Eigen::MatrixXd::Identity(size, size),
                         Eigen::VectorXd(size)};
  for (Eigen::Index k = 0; k < factors.size(); ++k) {
    const BlockEntry& entry = entries[k];
    if (entry.row == entry.column) {
      blocks.diagonal(entry.row) = std::exp(factors(k));
    } else {
      blocks.lower(entry.column, entry.row) = factors(k);
    }
  }
  return blocks;
}

}  // namespace

Eigen::VectorXd ModuliOfFactors(const std::vector<BlockEntry>& entries,
                                const Eigen::VectorXd& factors) {
  const auto [lower, diagonal] = FactorsAt(entries, factors);
  return ModuliOfBlocks(entries,
                        lower * diagonal.asDiagonal() * lower.transpose());
}

Eigen::MatrixXd ModuliOfFactorsJacobian(const std::vector<BlockEntry>& entries,
                                        const Eigen::VectorXd& factors) {
  const auto [lower, diagonal] = FactorsAt(entries, factors);
  Eigen::MatrixXd jacobian(factors.size(), factors.size());
  for (Eigen::Index k = 0; k < factors.size(); ++k) {
    // S = sum of D_a l_a l_a^T over the columns l_a of L.
    const int a = entries[k].row;
    const int b = entries[k].column;
    const Eigen::VectorXd column = diagonal(a) * lower.col(a);
    Eigen::MatrixXd slope = Eigen::MatrixXd::Zero(lower.rows(), lower.cols());
    if (a == b) {
      slope = column * lower.col(a).transpose();
    } else {
      slope.col(b) += column;
      slope.row(b) += column.transpose();
    }
    jacobian.col(k) = ModuliOfBlocks(entries, slope);
  }
  return jacobian;
}

bool IsStiffnessPositiveDefinite(const Law& law,
                                 const Eigen::VectorXd& parameters,
                                 SectionModel model) {
  return law.BlockEntries().empty() ||
         FactorsOfModuli(law.BlockEntries(), law.Moduli(parameters, model))
             .allFinite();
}

Eigen::MatrixXd BlocksOfModuli(const std::vector<BlockEntry>& entries,
                               const Eigen::VectorXd& moduli) {
  const Eigen::Index size = NumModes(entries);
  Eigen::MatrixXd blocks = Eigen::MatrixXd::Zero(size, size);
  for (Eigen::Index k = 0; k < moduli.size(); ++k) {
    const BlockEntry& entry = entries[k];
    blocks(entry.row, entry.column) = blocks(entry.column, entry.row) =
        entry.factor * moduli(k);
  }
  return blocks;
}

Eigen::VectorXd ModuliOfBlocks(const std::vector<BlockEntry>& entries,
                               const Eigen::MatrixXd& blocks) {
  Eigen::VectorXd moduli(Eigen::Index(entries.size()));
  for (Eigen::Index k = 0; k < moduli.size(); ++k) {
    moduli(k) = blocks(entries[k].row, entries[k].column) / entries[k].factor;
  }
  return moduli;
}

Eigen::VectorXd FactorsOfModuli(const std::vector<BlockEntry>& entries,
                                const Eigen::VectorXd& moduli) {
  const Eigen::LLT<Eigen::MatrixXd> cholesky(BlocksOfModuli(entries, moduli));
  Eigen::VectorXd factors = Eigen::VectorXd::Constant(
      moduli.size(), std::numeric_limits<double>::quiet_NaN());
  if (cholesky.info() != Eigen::Success || !moduli.allFinite()) {
    return factors;
  }
  const Eigen::MatrixXd root = cholesky.matrixL();
  for (Eigen::Index k = 0; k < moduli.size(); ++k) {
    const int a = entries[k].row;
    factors(k) = a == entries[k].column
                     ? 2 * std::log(root(a, a))
                     : root(entries[k].column, a) / root(a, a);
  }
  return factors;
}

}  // namespace elastimate
