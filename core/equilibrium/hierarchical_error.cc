#include "elastimate/core/equilibrium/hierarchical_error.h"

#include <Eigen/LU>
#include <vector>

#include "elastimate/core/materials/elasticity.h"
#include "elastimate/core/mesh/shape_functions.h"
#include "elastimate/core/scene/degrees_of_freedom.h"
#include "elastimate/core/scene/finer_scene.h"
#include "elastimate/core/scene/loads.h"

namespace elastimate {
namespace {

constexpr int kMostIterations = 150;
// The energy that the last kDelay steps added tells how much the next ones will
// add.
constexpr int kDelay = 4;
// Rounding alone leaves an error of this share of the energy of a response.
constexpr double kRoundingEnergy = 1e-20;

// Returns the product of each column of `a` with the same column of `b`.
Eigen::RowVectorXd ColumnProducts(const Eigen::MatrixXd& a,
                                  const Eigen::MatrixXd& b) {
  return a.cwiseProduct(b).colwise().sum();
}

// Adds the products of blocks, which stand side by side, with the rows of x
// from `first` on.
template <int kDimension>
void AddBlockProducts(const Eigen::MatrixXd& blocks, const Eigen::MatrixXd& x,
                      Eigen::Index first, Eigen::MatrixXd& sum) {
  for (Eigen::Index k = 0; k < x.cols(); ++k) {
    for (Eigen::Index i = 0; i < blocks.cols(); i += kDimension) {
      sum.col(k).segment<kDimension>(first + i).noalias() +=
          blocks.block<kDimension, kDimension>(0, i) *
          x.col(k).segment<kDimension>(first + i);
    }
  }
}

template <int kDimension>
void InvertBlocks(Eigen::MatrixXd& blocks) {
  for (Eigen::Index i = 0; i < blocks.cols(); i += kDimension) {
    auto block = blocks.block<kDimension, kDimension>(0, i);
    const Eigen::Matrix<double, kDimension, kDimension> copy = block;
    block = copy.inverse();
  }
}

// Divides each pair of numbers.  The quotient is zero where a column is exact
// and has no direction left.
Eigen::RowVectorXd Quotients(const Eigen::RowVectorXd& of,
                             const Eigen::RowVectorXd& by) {
  return (by.array() > 0).select(of.array() / by.array(), 0.0);
}

}  // namespace

HierarchicalError::HierarchicalError(const Scene& scene)
    : finer_(FinerScene(scene)),
      nodes_(scene.mesh, finer_.mesh),
      stiffness_(finer_.mesh),
      is_free_((!finer_.supports.held).cast<double>().matrix().reshaped()),
      held_(HeldDisplacement(finer_.supports)),
      force_(AssembleLoadCases(finer_)) {}

std::optional<Eigen::MatrixXd> HierarchicalError::Find(
    double poisson_ratio, const Eigen::MatrixXd& responses,
    StiffnessSolver& solver) {
  Eigen::MatrixXd start = is_free_.asDiagonal() * nodes_.Interpolate(responses);
  start.rightCols(responses.cols() - force_.cols()).colwise() += held_;
  Eigen::MatrixXd product = Multiply(poisson_ratio, start);
  // This energy takes the forces of all rows: those of the free rows balance,
  // so that the free rows alone hold no energy for a response to held
  // displacements.
  const Eigen::RowVectorXd rounding =
      kRoundingEnergy *
      ColumnProducts(start, products_.h + poisson_ratio * products_.j);
  Eigen::MatrixXd residual = -product;
  residual.leftCols(force_.cols()) += is_free_.asDiagonal() * force_;
  const Eigen::MatrixXd inverses = InverseBlocks(poisson_ratio);

  std::vector<Eigen::RowVectorXd> energies = {
      BeginWithLast(poisson_ratio, residual)};
  Eigen::MatrixXd direction;
  Eigen::RowVectorXd previous;
  for (int step = 0; step < kMostIterations; ++step) {
    const Eigen::MatrixXd z = Precondition(inverses, residual, solver);
    const Eigen::RowVectorXd rz = ColumnProducts(residual, z);
    if ((rz.array() <= rounding.array()).all()) {
      return Eigen::MatrixXd(error_.topRows(responses.rows()));
    }
    if (step == 0) {
      direction = z;
    } else {
      direction = z + direction * Quotients(rz, previous).asDiagonal();
    }
    previous = rz;
    product = Multiply(poisson_ratio, direction);
    const Eigen::RowVectorXd length =
        Quotients(rz, ColumnProducts(direction, product));
    error_ += direction * length.asDiagonal();
    residual -= product * length.asDiagonal();
    energies.push_back(energies.back() + length.cwiseProduct(rz));
    if (step >= kDelay &&
        ((energies.back() - energies[step + 1 - kDelay]).array() <=
         kTolerance * kTolerance * energies.back().array())
            .all()) {
      return Eigen::MatrixXd(error_.topRows(responses.rows()));
    }
  }
  error_.resize(0, 0);
  return std::nullopt;
}

Eigen::RowVectorXd HierarchicalError::BeginWithLast(double poisson_ratio,
                                                    Eigen::MatrixXd& residual) {
  if (error_.size() != residual.size()) {
    error_ = Eigen::MatrixXd::Zero(residual.rows(), residual.cols());
    return Eigen::RowVectorXd::Zero(residual.cols());
  }
  const Eigen::MatrixXd product = Multiply(poisson_ratio, error_);
  const Eigen::RowVectorXd of_residual = ColumnProducts(error_, residual);
  const Eigen::RowVectorXd scale =
      Quotients(of_residual, ColumnProducts(error_, product));
  error_ = error_ * scale.asDiagonal();
  residual -= product * scale.asDiagonal();
  return scale.cwiseProduct(of_residual);
}

Eigen::MatrixXd HierarchicalError::Multiply(double poisson_ratio,
                                            const Eigen::MatrixXd& x) {
  ++num_passes_;
  stiffness_.Multiply(x, products_);
  return is_free_.asDiagonal() * (products_.h + poisson_ratio * products_.j);
}

Eigen::MatrixXd HierarchicalError::Precondition(const Eigen::MatrixXd& inverses,
                                                const Eigen::MatrixXd& residual,
                                                StiffnessSolver& solver) const {
  const int dimension = finer_.mesh.Dimension();
  Eigen::MatrixXd z =
      nodes_.Interpolate(solver.Solve(nodes_.Restrict(residual), kTolerance));
  const Eigen::Index first = dimension * nodes_.NumNodes();
  if (dimension == 3) {
    AddBlockProducts<3>(inverses, residual, first, z);
  } else {
    AddBlockProducts<2>(inverses, residual, first, z);
  }
  return is_free_.asDiagonal() * z;
}

Eigen::MatrixXd HierarchicalError::InverseBlocks(double poisson_ratio) const {
  const Mesh& mesh = finer_.mesh;
  const int dimension = mesh.Dimension();
  const double shear_share = ShearShareOfJ(mesh.section.model);
  Eigen::MatrixXd blocks =
      Eigen::MatrixXd::Zero(dimension, dimension * nodes_.NumMidEdges());
  VisitElementKind(mesh.kind, [&](auto kind) {
    for (Eigen::Index e = 0; e < mesh.NumElements(); ++e) {
      VisitPoints<kind>(
          mesh, e, StiffnessRule<kind>(),
          [&](const ElementPoint<kind>& point, const auto&) {
            for (int i = ElementSizes<kind>::kVertices;
                 i < ElementSizes<kind>::kNodes; ++i) {
              const auto gradient = point.gradient.col(i);
              const auto outer = (gradient * gradient.transpose()).eval();
              // A unit displacement c of the node has e = sym(c grad(N)^T); the
              // block is e grad(N).
              auto h = (0.5 * outer).eval();
              h.diagonal().array() += 0.5 * gradient.squaredNorm();
              blocks.middleCols(
                  dimension * (mesh.elements(i, e) - nodes_.NumNodes()),
                  dimension) += point.volume *
                                (h + poisson_ratio * (outer - shear_share * h));
            }
          });
    }
  });
  if (dimension == 3) {
    InvertBlocks<3>(blocks);
  } else {
    InvertBlocks<2>(blocks);
  }
  return blocks;
}

}  // namespace elastimate
