#include "elastimate/core/solvers/node_blocks.h"

#include <algorithm>
#include <numeric>

namespace elastimate {

NodeBlocks::NodeBlocks(const NodeGraph& graph,
                       const DegreesOfFreedom& degrees_of_freedom,
                       const std::vector<int>& order)
    : graph_(graph),
      degrees_of_freedom_(degrees_of_freedom),
      of_node_(graph.start.size() - 1, -1) {
  for (const Eigen::Index dof : degrees_of_freedom.free) {
    of_node_[dof / Dimension()] = 0;
  }
  int num_blocks = 0;
  for (std::size_t i = 0; i < of_node_.size(); ++i) {
    int& block = of_node_[order.empty() ? i : std::size_t(order[i])];
    if (block == 0) {
      block = num_blocks++;
    }
  }
  start_.assign(std::size_t(num_blocks) + 1, 0);
  VisitPairs([&](int a, int b) {
    ++start_[a + 1];
    start_[b + 1] += a != b ? 1 : 0;
  });
  std::partial_sum(start_.begin(), start_.end(), start_.begin());
  column_.resize(start_.back());
  std::vector<Eigen::Index> next(start_.begin(), start_.end() - 1);
  // Each row first gets the nodes before its own, then its own, then the later
  // ones, so that columns ascend by node.
  VisitPairs([&](int a, int b) {
    column_[next[a]++] = b;
    if (a != b) {
      column_[next[b]++] = a;
    }
  });
}

template <class Visitor>
void NodeBlocks::VisitPairs(const Visitor& visit) const {
  for (std::size_t node = 0; node < of_node_.size(); ++node) {
    for (Eigen::Index k = graph_.start[node]; k < graph_.start[node + 1]; ++k) {
      if (of_node_[node] >= 0 && of_node_[graph_.row[k]] >= 0) {
        visit(of_node_[node], of_node_[graph_.row[k]]);
      }
    }
  }
}

std::vector<int> NodeBlocks::RowsOfFree() const {
  std::vector<int> rows;
  rows.reserve(degrees_of_freedom_.free.size());
  for (const Eigen::Index dof : degrees_of_freedom_.free) {
    rows.push_back(Dimension() * of_node_[dof / Dimension()] +
                   int(dof % Dimension()));
  }
  return rows;
}

template <class Visitor>
void NodeBlocks::VisitEntries(const Eigen::VectorXd& values,
                              const Visitor& visit) const {
  std::vector<Eigen::Index> next(start_.begin(), start_.end() - 1);
  const double* value = values.data();
  for (Eigen::Index node = 0; node < Eigen::Index(of_node_.size()); ++node) {
    const int a = of_node_[node];
    if (a < 0) {
      continue;
    }
    const Eigen::Index diagonal = next[a];
    double scale = 0;
    for (int j = 0; j < Dimension(); ++j) {
      if (!IsFree(node, j)) {
        continue;
      }
      Eigen::Index own = diagonal;
      for (Eigen::Index k = graph_.start[node]; k < graph_.start[node + 1];
           ++k) {
        const int row = graph_.row[k];
        const int b = of_node_[row];
        if (b < 0) {
          continue;
        }
        for (int i = b == a ? j : 0; i < Dimension(); ++i) {
          if (!IsFree(row, i)) {
            continue;
          }
          visit(own, j, i, *value);
          if (b != a) {
            visit(next[b], i, j, *value);
          } else if (i != j) {
            visit(own, i, j, *value);
          } else {
            scale = std::max(scale, *value);
          }
          ++value;
        }
        ++own;
      }
    }
    for (int j = 0; j < Dimension(); ++j) {
      if (!IsFree(node, j)) {
        visit(diagonal, j, j, scale);
      }
    }
    for (Eigen::Index k = graph_.start[node]; k < graph_.start[node + 1]; ++k) {
      const int b = of_node_[graph_.row[k]];
      if (b >= 0 && b != a) {
        ++next[b];
      }
    }
  }
}

BlockMatrix NodeBlocks::MatrixOf(const Eigen::VectorXd& values) const {
  BlockMatrix matrix;
  matrix.block_rows = matrix.block_columns = Dimension();
  matrix.num_columns = Eigen::Index{Dimension()} * NumBlocks();
  matrix.start = start_;
  matrix.column = column_;
  const int size = Dimension() * Dimension();
  matrix.entries.assign(column_.size() * std::size_t(size), 0);
  matrix.rest.assign(matrix.entries.size(), 0);
  VisitEntries(values, [&](Eigen::Index block, int i, int j, double value) {
    const Eigen::Index at = block * size + Eigen::Index{j} * Dimension() + i;
    matrix.entries[at] = static_cast<float>(value);
    matrix.rest[at] = static_cast<float>(value - double{matrix.entries[at]});
  });
  return matrix;
}

}  // namespace elastimate
