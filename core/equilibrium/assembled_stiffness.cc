#include "elastimate/core/equilibrium/assembled_stiffness.h"

#include <vector>

namespace elastimate {

AssembledStiffness::AssembledStiffness(const Mesh& mesh,
                                       const Supports& supports,
                                       SolverKind solver,
                                       const StiffnessSolver* shared)
    : SupportedStiffness(supports),
      mesh_(mesh),
      supports_(supports),
      kind_(solver) {
  if (shared != nullptr) {
    solver_ = std::make_unique<StiffnessSolver>(shared->Sharing());
  }
}

StiffnessSolver& AssembledStiffness::Solver() const {
  if (!solver_) {
    solver_ = std::make_unique<StiffnessSolver>(mesh_, supports_, kind_);
  }
  return *solver_;
}

const std::string& AssembledStiffness::Notice() const {
  static const std::string none;
  return solver_ ? solver_->Notice() : none;
}

bool AssembledStiffness::Factorize(const NestedStiffness& stiffness,
                                   bool with_held_rows) {
  const auto make_blocks = [&stiffness, this] {
    return stiffness.Blocks(0, Solver().Graph());
  };
  if (!Solver().FactorizeBlocks(make_blocks)) {
    return false;
  }
  if (with_held_rows) {
    AssembleHeldRows(make_blocks());
  }
  return true;
}

void AssembledStiffness::AssembleHeldRows(const Eigen::MatrixXd& blocks) {
  const NodeGraph& graph = Solver().Graph();
  const Eigen::Index d = blocks.rows();
  const auto is_held = supports_.held.reshaped();
  std::vector<Eigen::Triplet<double>> entries;
  const auto add = [&](Eigen::Index row, Eigen::Index column, double value) {
    if (is_held(row)) {
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
  rows_.resize(is_held.size(), is_held.size());
  rows_.setFromTriplets(entries.begin(), entries.end());
}

}  // namespace elastimate
