#include "elastimate/estimators/material_fit/merge_plan.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "elastimate/core/algebra/dense_algebra.h"

namespace elastimate {
namespace {

// The variables of each material.
std::vector<std::vector<Eigen::Index>> VariablesOfMaterials(
    const MaterialParameters& parameters) {
  std::vector<std::vector<Eigen::Index>> variables(parameters.NumMaterials());
  for (std::size_t i = 0; i < parameters.Free().size(); ++i) {
    const MaterialParameters::Parameter& parameter =
        parameters.All()[parameters.Free()[i]];
    variables[parameter.material].push_back(Eigen::Index(i));
  }
  return variables;
}

// Groups of materials, and the variables and their covariance as they follow
// from those of the materials apart.
struct State {
  MaterialGroups groups;
  std::vector<std::vector<Eigen::Index>> variables;  // Of each group.
  VariableEstimate estimate;

  Eigen::VectorXd Difference(std::size_t a, std::size_t b) const {
    return estimate.variables(variables[a]) - estimate.variables(variables[b]);
  }
  // R C, of the rows x_a - x_b.
  Eigen::MatrixXd CovarianceRows(std::size_t a, std::size_t b) const {
    return estimate.covariance(variables[a], Eigen::all) -
           estimate.covariance(variables[b], Eigen::all);
  }
  Eigen::MatrixXd Precision(std::size_t a, std::size_t b) const {
    const Eigen::MatrixXd rows = CovarianceRows(a, b);
    return Inverse(rows(Eigen::all, variables[a]) -
                   rows(Eigen::all, variables[b]));
  }
  double ChiSquare(std::size_t a, std::size_t b) const {
    const Eigen::VectorXd difference = Difference(a, b);
    return difference.dot(Precision(a, b) * difference);
  }
  void Merge(std::size_t a, std::size_t b);
  Eigen::VectorXd Variables() const;
};

void State::Merge(std::size_t a, std::size_t b) {
  const Eigen::MatrixXd rows = CovarianceRows(a, b);
  const Eigen::MatrixXd gain = rows.transpose() * Precision(a, b);
  estimate.variables -= gain * Difference(a, b);
  estimate.covariance -= gain * rows;
  groups[a].insert(groups[a].end(), groups[b].begin(), groups[b].end());
  std::sort(groups[a].begin(), groups[a].end());
  groups.erase(groups.begin() + std::ptrdiff_t(b));
  variables.erase(variables.begin() + std::ptrdiff_t(b));
}

Eigen::VectorXd State::Variables() const {
  std::vector<Eigen::Index> all;
  for (const std::vector<Eigen::Index>& of_group : variables) {
    all.insert(all.end(), of_group.begin(), of_group.end());
  }
  return estimate.variables(all);
}

bool AreOfOneKind(const Material& a, const Material& b) {
  Material other = b;
  other.regions = a.regions;
  return a == other;
}

// Two groups, the second after the first.
struct Pair {
  std::size_t a;
  std::size_t b;
  double chi_square;
  double limit;
};

std::optional<Pair> NearestPair(const std::vector<Material>& materials,
                                const State& state, double log_observations) {
  std::optional<Pair> nearest;
  for (std::size_t b = 0; b < state.groups.size(); ++b) {
    for (std::size_t a = 0; a < b; ++a) {
      if (state.variables[a].empty() ||
          !AreOfOneKind(materials[state.groups[a][0]],
                        materials[state.groups[b][0]])) {
        continue;
      }
      const Pair pair = {
          a, b, state.ChiSquare(a, b),
          static_cast<double>(state.variables[a].size()) * log_observations};
      if (!nearest ||
          pair.chi_square - pair.limit < nearest->chi_square - nearest->limit) {
        nearest = pair;
      }
    }
  }
  return nearest;
}

}  // namespace

MergePlan PlanMerges(const std::vector<Material>& materials,
                     const MaterialParameters& parameters,
                     VariableEstimate estimate, double num_observations) {
  State state = {{}, VariablesOfMaterials(parameters), std::move(estimate)};
  for (std::size_t i = 0; i < materials.size(); ++i) {
    state.groups.push_back({i});
  }
  MergePlan plan;
  double criterion = 0;
  double least = 0;
  while (const std::optional<Pair> pair =
             NearestPair(materials, state, std::log(num_observations))) {
    PlannedMerge merge = {state.groups[pair->a],
                          state.groups[pair->b],
                          pair->chi_square,
                          pair->limit,
                          {},
                          {}};
    state.Merge(pair->a, pair->b);
    merge.groups = state.groups;
    merge.variables = state.Variables();
    plan.path.push_back(merge);
    criterion += pair->chi_square - pair->limit;
    if (criterion < least) {
      least = criterion;
      plan.num_taken = plan.path.size();
    }
  }
  return plan;
}

double ChiSquareOfGroups(const MaterialGroups& groups,
                         const MaterialParameters& parameters,
                         const VariableEstimate& estimate) {
  const std::vector<std::vector<Eigen::Index>> variables =
      VariablesOfMaterials(parameters);
  std::vector<Eigen::Index> first;
  std::vector<Eigen::Index> second;
  for (const std::vector<std::size_t>& group : groups) {
    for (std::size_t i = 1; i < group.size(); ++i) {
      const auto& of_first = variables[group[0]];
      const auto& of_other = variables[group[i]];
      first.insert(first.end(), of_first.begin(), of_first.end());
      second.insert(second.end(), of_other.begin(), of_other.end());
    }
  }
  const Eigen::VectorXd difference =
      estimate.variables(first) - estimate.variables(second);
  const Eigen::MatrixXd rows = estimate.covariance(first, Eigen::all) -
                               estimate.covariance(second, Eigen::all);
  return difference.dot(
      SolveLeastSquares(rows(Eigen::all, first) - rows(Eigen::all, second),
                        difference)
          .col(0));
}

std::vector<Material> MaterialsOfGroups(const std::vector<Material>& materials,
                                        const MaterialGroups& groups) {
  std::vector<Material> merged;
  for (const std::vector<std::size_t>& group : groups) {
    Material material = materials[group[0]];
    material.regions.clear();
    for (const std::size_t member : group) {
      material.regions.insert(material.regions.end(),
                              materials[member].regions.begin(),
                              materials[member].regions.end());
    }
    std::sort(material.regions.begin(), material.regions.end());
    merged.push_back(material);
  }
  if (merged.size() == 1) {
    merged[0].regions.clear();
    if (IsOneIsotropicMaterial(merged)) {
      merged.clear();
    }
  }
  return merged;
}

}  // namespace elastimate
