#include "elastimate/core/equilibrium/supported_stiffness.h"

#include <vector>

namespace elastimate {

SupportedStiffness::SupportedStiffness(const Mesh& mesh,
                                       const Supports& supports,
                                       SolverKind solver)
    : solver_(mesh, supports, solver) {}

bool SupportedStiffness::Factorize(const Eigen::MatrixXd& blocks,
                                   bool with_held_rows) {
  if (!solver_.FactorizeBlocks(blocks)) {
    return false;
  }
  if (with_held_rows) {
    AssembleHeldRows(blocks);
  }
  return true;
}

void SupportedStiffness::AssembleHeldRows(const Eigen::MatrixXd& blocks) {
  const NodeGraph& graph = solver_.Graph();
  const DegreesOfFreedom& dofs = solver_.Dofs();
  const Eigen::Index d = blocks.rows();
  std::vector<Eigen::Triplet<double>> entries;
  const auto add = [&](Eigen::Index row, Eigen::Index column, double value) {
    if (dofs.place[row] < 0) {
      entries.emplace_back(row, column, value);
    }
  };
  for (Eigen::Index j = 0; j + 1 < Eigen::Index(graph.start.size()); ++j) {
    for (Eigen::Index pair = graph.start[j]; pair < graph.start[j + 1];
         ++pair) {
      const Eigen::Index i = graph.row[pair];
      for (Eigen::Index a = 0; a < d; ++a) {
        for (Eigen::Index b = 0; b < d; ++b) {
          const double value = blocks(a, d * pair + b);
          add(d * i + a, d * j + b, value);
          if (i != j) {
            add(d * j + b, d * i + a, value);
          }
        }
      }
    }
  }
  held_rows_.resize(dofs.NumAll(), dofs.NumAll());
  held_rows_.setFromTriplets(entries.begin(), entries.end());
}

Eigen::MatrixXd SupportedStiffness::Extend(const Eigen::MatrixXd& held) {
  return held - solver_.Solve(held_rows_.transpose() * held);
}

Eigen::MatrixXd SupportedStiffness::ExtendTransposed(
    const Eigen::MatrixXd& values) {
  return OfHeld(values) - held_rows_ * solver_.Solve(values);
}

Eigen::MatrixXd SupportedStiffness::OfHeld(Eigen::MatrixXd values) const {
  for (const Eigen::Index dof : solver_.Dofs().free) {
    values.row(dof).setZero();
  }
  return values;
}

}  // namespace elastimate
