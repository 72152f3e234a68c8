#include "elastimate/core/mechanics/stiffness_assembly.h"

#include "elastimate/core/mechanics/law_products.h"

namespace elastimate {
namespace {

bool HasBit(unsigned bits, int place) {
  return (bits >> unsigned(place) & 1U) != 0;
}

}  // namespace

StiffnessAssembly::StiffnessAssembly(const Mesh& mesh,
                                     const DegreesOfFreedom& degrees_of_freedom)
    : mesh_(mesh),
      graph_(mesh),
      dimension_(degrees_of_freedom.dimension),
      free_components_(mesh.NumNodes(), 0) {
  for (const Eigen::Index dof : degrees_of_freedom.free) {
    free_components_[dof / degrees_of_freedom.dimension] |=
        1U << (dof % degrees_of_freedom.dimension);
  }
  VisitValues([&](auto...) { ++num_values_; });
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
  pattern_ = {};
}

template <class Visitor>
void StiffnessAssembly::VisitValues(const Visitor& visit) const {
  for (Eigen::Index node = 0; node + 1 < Eigen::Index(graph_.start.size());
       ++node) {
    for (int component = 0; component < dimension_; ++component) {
      if (!HasBit(free_components_[node], component)) {
        continue;
      }
      for (Eigen::Index k = graph_.start[node]; k < graph_.start[node + 1];
           ++k) {
        // Above the diagonal there is nothing to store.
        const int first = graph_.row[k] == node ? component : 0;
        for (int i = first; i < dimension_; ++i) {
          if (HasBit(free_components_[graph_.row[k]], i)) {
            visit(node, k, component, i);
          }
        }
      }
    }
  }
}

const SymmetricPattern& StiffnessAssembly::Pattern() const {
  if (!pattern_.column_start.empty()) {
    return pattern_;
  }
  std::vector<std::int64_t> place(free_components_.size() * dimension_, -1);
  std::int64_t num_free = 0;
  for (std::size_t i = 0; i < place.size(); ++i) {
    if (HasBit(free_components_[i / dimension_], int(i % dimension_))) {
      place[i] = num_free++;
    }
  }
  pattern_.row.reserve(num_values_);
  pattern_.column_start.reserve(num_free + 1);
  Eigen::Index last = -1;
  VisitValues([&](Eigen::Index node, Eigen::Index k, int component, int i) {
    const Eigen::Index column = dimension_ * node + component;
    if (column != last) {
      pattern_.column_start.push_back(std::int64_t(pattern_.row.size()));
      last = column;
    }
    pattern_.row.push_back(place[dimension_ * Eigen::Index(graph_.row[k]) + i]);
  });
  pattern_.column_start.push_back(std::int64_t(pattern_.row.size()));
  return pattern_;
}

Eigen::VectorXd StiffnessAssembly::ValuesOf(
    const Eigen::MatrixXd& blocks) const {
  Eigen::VectorXd values(num_values_);
  double* value = values.data();
  VisitValues([&](Eigen::Index /*node*/, Eigen::Index k, int component, int i) {
    *value++ = blocks(i, dimension_ * k + component);
  });
  return values;
}

}  // namespace elastimate
