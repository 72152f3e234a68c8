#include "elastimate/core/mechanics/stiffness_assembly.h"

#include <algorithm>

#include "elastimate/core/mechanics/gradient_products.h"

namespace elastimate {

StiffnessAssembly::StiffnessAssembly(const Mesh& mesh,
                                     const DegreesOfFreedom& degrees_of_freedom)
    : graph_(mesh), free_components_(mesh.NumNodes(), 0) {
  for (const Eigen::Index dof : degrees_of_freedom.free) {
    free_components_[dof / degrees_of_freedom.dimension] |=
        1U << (dof % degrees_of_freedom.dimension);
  }
  BuildPattern(degrees_of_freedom);
  PlanStages(mesh);
  Assemble(mesh);
}

void StiffnessAssembly::PlanStages(const Mesh& mesh) {
  constexpr Eigen::Index kElementsPerStage = 1024;
  Eigen::Index end = mesh.NumElements();
  Eigen::Index num_complete_nodes = mesh.NumNodes();
  while (end > 0) {
    stages_.push_back({end, num_complete_nodes});
    const Eigen::Index first =
        (end - 1) / kElementsPerStage * kElementsPerStage;
    num_complete_nodes = std::min<Eigen::Index>(
        num_complete_nodes,
        mesh.elements.middleCols(first, end - first).minCoeff());
    end = first;
  }
  std::reverse(stages_.begin(), stages_.end());

  // Each pair is counted at its smaller node.
  Eigen::Index most_pairs = 0;
  Eigen::Index end_node = 0;
  Eigen::Index first = 0;
  Eigen::Index first_node = 0;
  for (const Stage& stage : stages_) {
    end_node = std::max<Eigen::Index>(
        end_node,
        mesh.elements.middleCols(first, stage.end_element - first).maxCoeff() +
            1);
    most_pairs =
        std::max(most_pairs, graph_.start[end_node] - graph_.start[first_node]);
    first = stage.end_element;
    first_node = stage.num_complete_nodes;
  }
  Eigen::Index size = 1;
  while (size < most_pairs) {
    size *= 2;
  }
  pair_mask_ = size < graph_.NumPairs() ? size - 1 : kEveryPair;
  products_.setZero(ProductRows(mesh.Dimension()),
                    mesh.Dimension() * std::min(size, graph_.NumPairs()));
}

void StiffnessAssembly::BuildPattern(
    const DegreesOfFreedom& degrees_of_freedom) {
  const int dimension = degrees_of_freedom.dimension;
  const Eigen::Index num_nodes = Eigen::Index(free_components_.size());
  pattern_.column_start.assign(1, 0);
  pattern_.column_start.reserve(degrees_of_freedom.NumFree() + 1);
  pair_values_.assign(dimension * graph_.NumPairs(), -1);
  for (Eigen::Index node = 0; node < num_nodes; ++node) {
    for (int component = 0; component < dimension; ++component) {
      if (degrees_of_freedom.place[dimension * node + component] < 0) {
        continue;
      }
      for (Eigen::Index k = graph_.start[node]; k < graph_.start[node + 1];
           ++k) {
        pair_values_[dimension * k + component] =
            static_cast<std::int64_t>(pattern_.row.size());
        const Eigen::Index first = dimension * Eigen::Index(graph_.row[k]);
        // Above the diagonal there is nothing to store.
        const int first_component = graph_.row[k] == node ? component : 0;
        for (int i = first_component; i < dimension; ++i) {
          if (degrees_of_freedom.place[first + i] >= 0) {
            pattern_.row.push_back(degrees_of_freedom.place[first + i]);
          }
        }
      }
      pattern_.column_start.push_back(
          static_cast<std::int64_t>(pattern_.row.size()));
    }
  }
}

void StiffnessAssembly::Assemble(const Mesh& mesh) {
  if (mesh.Dimension() == 3) {
    AssembleOfDimension<3>(mesh);
  } else {
    AssembleOfDimension<2>(mesh);
  }
}

template <int kDimension>
void StiffnessAssembly::AssembleOfDimension(const Mesh& mesh) {
  h_.resize(static_cast<Eigen::Index>(pattern_.row.size()));
  j_.resize(h_.size());
  const double shear_share = ShearShareOfJ(mesh.section.model);
  Eigen::Index first = 0;
  Eigen::Index node = 0;
  for (const Stage& stage : stages_) {
    AddGradientProducts(mesh, graph_, first, stage.end_element, pair_mask_,
                        products_);
    first = stage.end_element;
    for (; node < stage.num_complete_nodes; ++node) {
      WriteColumns<kDimension>(node, shear_share);
    }
  }
}

Eigen::VectorXd StiffnessAssembly::ValuesOf(
    const Eigen::MatrixXd& blocks) const {
  const Eigen::Index dimension = blocks.rows();
  Eigen::VectorXd values(Eigen::Index(pattern_.row.size()));
  for (Eigen::Index node = 0; node + 1 < Eigen::Index(graph_.start.size());
       ++node) {
    for (Eigen::Index k = graph_.start[node]; k < graph_.start[node + 1]; ++k) {
      const int row = graph_.row[k];
      for (Eigen::Index component = 0; component < dimension; ++component) {
        Eigen::Index next = pair_values_[dimension * k + component];
        if (next < 0) {
          continue;
        }
        for (Eigen::Index i = row == node ? component : 0; i < dimension; ++i) {
          if ((free_components_[row] >> unsigned(i) & 1U) != 0) {
            values(next++) = blocks(i, dimension * k + component);
          }
        }
      }
    }
  }
  return values;
}

template <int kDimension>
void StiffnessAssembly::WriteColumns(Eigen::Index node, double shear_share) {
  constexpr unsigned kAllFree = (1U << unsigned(kDimension)) - 1;
  for (Eigen::Index k = graph_.start[node]; k < graph_.start[node + 1]; ++k) {
    auto product = products_.block<kDimension, kDimension>(
        0, kDimension * (k & pair_mask_));
    const NodeBlock<kDimension> m = product;
    product.setZero();
    const NodeBlock<kDimension> block_h = StiffnessBlockH<kDimension>(m);
    const NodeBlock<kDimension> block_j =
        StiffnessBlockJ<kDimension>(m, shear_share);
    const int row = graph_.row[k];
    const bool is_whole = row != node && free_components_[row] == kAllFree;
    for (int component = 0; component < kDimension; ++component) {
      const Eigen::Index value = pair_values_[kDimension * k + component];
      if (value < 0) {
        continue;
      }
      // Nearly all blocks are whole: no component of the row is held or above
      // the diagonal.
      if (is_whole) {
        h_.segment<kDimension>(value) = block_h.col(component);
        j_.segment<kDimension>(value) = block_j.col(component);
        continue;
      }
      Eigen::Index next = value;
      for (int i = row == node ? component : 0; i < kDimension; ++i) {
        if ((free_components_[row] >> i & 1U) != 0) {
          h_(next) = block_h(i, component);
          j_(next) = block_j(i, component);
          ++next;
        }
      }
    }
  }
}

}  // namespace elastimate
