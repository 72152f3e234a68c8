#include "elastimate/core/mechanics/stiffness_assembly.h"

#include "elastimate/core/mechanics/law_products.h"

namespace elastimate {

StiffnessAssembly::StiffnessAssembly(const Mesh& mesh,
                                     const DegreesOfFreedom& degrees_of_freedom)
    : mesh_(mesh), graph_(mesh), free_components_(mesh.NumNodes(), 0) {
  for (const Eigen::Index dof : degrees_of_freedom.free) {
    free_components_[dof / degrees_of_freedom.dimension] |=
        1U << (dof % degrees_of_freedom.dimension);
  }
  BuildPattern(degrees_of_freedom);
  h_ = Assemble({1, 0});
  j_ = Assemble({0, 1});
}

Eigen::VectorXd StiffnessAssembly::Assemble(
    const Eigen::Vector2d& coefficients) const {
  return ValuesOf(StiffnessBlocks(
      mesh_, graph_, coefficients.replicate(1, mesh_.NumElements())));
}

void StiffnessAssembly::Combine(double poisson_ratio,
                                Eigen::VectorXd& values) const {
  if (HasBases()) {
    values = h_ + poisson_ratio * j_;
  } else {
    values = Assemble({1, poisson_ratio});
  }
}

void StiffnessAssembly::ForgetBases() {
  h_.resize(0);
  j_.resize(0);
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

}  // namespace elastimate
