#include "elastimate/core/mechanics/stiffness_traces.h"

#include <cmath>
#include <cstdint>
#include <random>
#include <utility>

#include "elastimate/core/algebra/node_sums.h"

namespace elastimate {
namespace {

// Sets the rows and columns of the held degrees of freedom to zero.  A block of
// two different nodes stands for two blocks of the matrix, so it is multiplied
// by sqrt(2).
void WeighFreeBlocks(const NodeGraph& graph, const DegreesOfFreedom& dofs,
                     Eigen::MatrixXd& blocks) {
  const int dimension = dofs.dimension;
  const auto is_held = [&](Eigen::Index node, int component) {
    return dofs.place[dimension * node + component] < 0;
  };
  for (Eigen::Index j = 0; j + 1 < Eigen::Index(graph.start.size()); ++j) {
    for (Eigen::Index k = graph.start[j]; k < graph.start[j + 1]; ++k) {
      auto block = blocks.middleCols(dimension * k, dimension);
      if (graph.row[k] != j) {
        block *= std::sqrt(2);
      }
      for (int i = 0; i < dimension; ++i) {
        if (is_held(graph.row[k], i)) {
          block.row(i).setZero();
        }
        if (is_held(j, i)) {
          block.col(i).setZero();
        }
      }
    }
  }
}

}  // namespace

Eigen::MatrixXd StiffnessTraces(const Mesh& mesh, const InternalForces& forces,
                                const DegreesOfFreedom& degrees_of_freedom) {
  const NodeGraph graph(mesh);
  const Eigen::Index m = forces.Parameters().NumModuli();
  std::vector<Eigen::MatrixXd> blocks;
  for (Eigen::Index k = 0; k < m; ++k) {
    blocks.push_back(forces.Blocks(Eigen::VectorXd::Unit(m, k), graph));
  }
  return StiffnessTraces(graph, degrees_of_freedom, std::move(blocks));
}

Eigen::MatrixXd StiffnessTraces(const NodeGraph& graph,
                                const DegreesOfFreedom& degrees_of_freedom,
                                std::vector<Eigen::MatrixXd> blocks) {
  const auto m = Eigen::Index(blocks.size());
  for (Eigen::MatrixXd& of_modulus : blocks) {
    WeighFreeBlocks(graph, degrees_of_freedom, of_modulus);
  }
  Eigen::MatrixXd traces(m, m);
  for (Eigen::Index k = 0; k < m; ++k) {
    for (Eigen::Index l = 0; l <= k; ++l) {
      traces(k, l) = InnerProduct(blocks[k].reshaped(), blocks[l].reshaped());
      traces(l, k) = traces(k, l);
    }
  }
  return traces;
}

void SetTraceProbes(const ComponentMask& held,
                    Eigen::Ref<Eigen::MatrixXd> probes) {
  // The signs are looked up, since no processor could predict the branch.
  constexpr double kSigns[2] = {-1, 1};
  std::mt19937_64 generator(20071107);
  probes.setZero();
  for (auto probe : probes.colwise()) {
    // Each bit stands for a sign.
    std::uint64_t signs = 0;
    for (Eigen::Index dof = 0; dof < held.size(); ++dof, signs >>= 1U) {
      if (dof % 64 == 0) {
        signs = generator();
      }
      if (!held.data()[dof]) {
        probe(dof) = kSigns[signs & 1U];
      }
    }
  }
}

Eigen::MatrixXd EstimateStiffnessTraces(
    const DegreesOfFreedom& degrees_of_freedom,
    const std::vector<Eigen::MatrixXd>& products) {
  const auto m = Eigen::Index(products.size());
  Eigen::MatrixXd traces = Eigen::MatrixXd::Zero(m, m);
  Eigen::VectorXd row(m);
  for (Eigen::Index probe = 0; probe < products[0].cols(); ++probe) {
    for (const Eigen::Index dof : degrees_of_freedom.free) {
      for (Eigen::Index k = 0; k < m; ++k) {
        row(k) = products[k](dof, probe);
      }
      traces.noalias() += row * row.transpose();
    }
  }
  return traces / static_cast<double>(products[0].cols());
}

}  // namespace elastimate
