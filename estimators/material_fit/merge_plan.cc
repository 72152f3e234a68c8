#include "elastimate/estimators/material_fit/merge_plan.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "elastimate/core/algebra/dense_algebra.h"
#include "elastimate/estimators/interface/limits.h"
#include "elastimate/estimators/interface/statistics.h"

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
  // Whether there are variables of a group, all within these errors.
  bool IsDetermined(std::size_t a, const Eigen::VectorXd& largest_errors) const;
  void Merge(std::size_t a, std::size_t b);
  Eigen::VectorXd Variables() const;
};

bool State::IsDetermined(std::size_t a,
                         const Eigen::VectorXd& largest_errors) const {
  return !variables[a].empty() &&
         std::all_of(
             variables[a].begin(), variables[a].end(), [&](Eigen::Index i) {
               return std::sqrt(estimate.covariance(i, i)) <= largest_errors(i);
             });
}

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
  double information;  // k ln n
  double limit;
};

// What the distance of two groups of k variables may be.  What is nearest
// became one before, which leaves most of the scatter of all members to the
// last steps: none is larger than all of it, of k (num_members - 1) degrees of
// freedom [Scheffe].
double LimitOfDistance(double num_variables, std::size_t num_members,
                       double num_observations) {
  // By chance, of groups that are the same.
  constexpr double kSignificance = 0.01;
  return std::max(
      num_variables * std::log(num_observations),
      ChiSquaredQuantile(num_variables * static_cast<double>(num_members - 1),
                         kSignificance));
}

std::optional<Pair> NearestPair(const std::vector<Material>& materials,
                                const Eigen::VectorXd& largest_errors,
                                const State& state, double num_observations) {
  std::optional<Pair> nearest;
  for (std::size_t b = 0; b < state.groups.size(); ++b) {
    for (std::size_t a = 0; a < b; ++a) {
      if (!state.IsDetermined(a, largest_errors) ||
          !state.IsDetermined(b, largest_errors) ||
          !AreOfOneKind(materials[state.groups[a][0]],
                        materials[state.groups[b][0]])) {
        continue;
      }
      const auto num_variables = static_cast<double>(state.variables[a].size());
      const Pair pair = {
          a, b, state.ChiSquare(a, b),
          num_variables * std::log(num_observations),
          LimitOfDistance(num_variables,
                          state.groups[a].size() + state.groups[b].size(),
                          num_observations)};
      if (!nearest || pair.chi_square - pair.information <
                          nearest->chi_square - nearest->information) {
        nearest = pair;
      }
    }
  }
  return nearest;
}

// R of the rows x_a - x_b, where a is the first member of a group and b another
// one.
class Constraints {
 public:
  Constraints(const MaterialGroups& groups,
              const std::vector<std::vector<Eigen::Index>>& variables) {
    for (const std::vector<std::size_t>& group : groups) {
      for (std::size_t i = 1; i < group.size(); ++i) {
        const auto& of_first = variables[group[0]];
        const auto& of_other = variables[group[i]];
        first_.insert(first_.end(), of_first.begin(), of_first.end());
        second_.insert(second_.end(), of_other.begin(), of_other.end());
      }
    }
  }
  Eigen::Index Size() const { return Eigen::Index(first_.size()); }
  /// R times some columns.
  Eigen::MatrixXd Differences(const Eigen::MatrixXd& columns) const {
    return columns(first_, Eigen::all) - columns(second_, Eigen::all);
  }

 private:
  std::vector<Eigen::Index> first_;
  std::vector<Eigen::Index> second_;
};

// By how much two variables differ, and 1.96 of the error of that.
double LargestDifference(const VariableEstimate& estimate, Eigen::Index i,
                         Eigen::Index j) {
  const Eigen::MatrixXd& covariance = estimate.covariance;
  const double variance =
      covariance(i, i) + covariance(j, j) - 2 * covariance(i, j);
  return std::abs(estimate.variables(i) - estimate.variables(j)) +
         kTwoSidedErrors * std::sqrt(std::max(variance, 0.0));
}

// What follows where the member at `place` of a group may be another than the
// rest of it.
struct DoubtOfMember {
  Eigen::VectorXd squared_errors;  ///< MemberSpread::errors, squared.
  /// w (x_rest - x)^2, by what it pulls the others.
  Eigen::VectorXd squared_pull;
};

DoubtOfMember DoubtMember(
    const std::vector<std::size_t>& group, std::size_t place,
    const std::vector<std::vector<Eigen::Index>>& variables,
    const VariableEstimate& estimate, double num_observations) {
  State state = {{}, {}, estimate};
  for (std::size_t i = 0; i < group.size(); ++i) {
    const std::size_t member = group[(place + 1 + i) % group.size()];
    state.groups.push_back({member});
    state.variables.push_back(variables[member]);
  }
  while (state.groups.size() > 2) {
    state.Merge(0, 1);
  }
  const std::vector<Eigen::Index>& own = variables[group[place]];
  const double information =
      static_cast<double>(own.size()) * std::log(num_observations);
  const double apart =
      1 / (1 + std::exp((information - state.ChiSquare(0, 1)) / 2));
  const Eigen::ArrayXd rest = state.estimate.variables(state.variables[0]);
  state.Merge(0, 1);
  const Eigen::ArrayXd all = state.estimate.variables(state.variables[0]);
  const Eigen::ArrayXd together =
      state.estimate.covariance.diagonal()(state.variables[0]).array();
  const Eigen::ArrayXd alone = estimate.covariance.diagonal()(own).array() +
                               (estimate.variables(own).array() - all).square();
  return {(1 - apart) * together + apart * alone,
          apart * (rest - all).square()};
}

}  // namespace

MergePlan PlanMerges(const std::vector<Material>& materials,
                     const MaterialParameters& parameters,
                     const Eigen::VectorXd& largest_errors,
                     VariableEstimate estimate, double num_observations) {
  State state = {{}, VariablesOfMaterials(parameters), std::move(estimate)};
  for (std::size_t i = 0; i < materials.size(); ++i) {
    state.groups.push_back({i});
  }
  MergePlan plan;
  double criterion = 0;
  double least = 0;
  while (const std::optional<Pair> pair =
             NearestPair(materials, largest_errors, state, num_observations)) {
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

double DistanceOfGroups(const MaterialGroups& groups,
                        const MaterialParameters& parameters,
                        const VariableEstimate& estimate,
                        const Eigen::VectorXd& variables_of_groups) {
  const std::vector<std::vector<Eigen::Index>> variables =
      VariablesOfMaterials(parameters);
  Eigen::VectorXd difference = estimate.variables;
  Eigen::Index first = 0;
  for (const std::vector<std::size_t>& group : groups) {
    const auto size = Eigen::Index(variables[group[0]].size());
    for (const std::size_t member : group) {
      difference(variables[member]) -= variables_of_groups.segment(first, size);
    }
    first += size;
  }
  return difference.dot(Inverse(estimate.covariance) * difference);
}

std::vector<MemberSpread> SpreadOfMembers(
    const MaterialGroups& groups, const MaterialParameters& parameters,
    const VariableEstimate& estimate, const Eigen::MatrixXd& noise_covariance,
    double num_observations) {
  const std::vector<std::vector<Eigen::Index>> variables =
      VariablesOfMaterials(parameters);
  const Constraints constraints(groups, variables);
  const Eigen::MatrixXd& covariance = estimate.covariance;
  const Eigen::Index n = covariance.cols();
  // The part of x - x_0 that lies in x.
  Eigen::MatrixXd projection = Eigen::MatrixXd::Zero(n, n);
  if (constraints.Size() > 0) {
    const Eigen::MatrixXd rows = constraints.Differences(covariance);
    projection = rows.transpose() *
                 SolveLeastSquares(
                     constraints.Differences(rows.transpose()),
                     constraints.Differences(Eigen::MatrixXd::Identity(n, n)));
  }
  const Eigen::VectorXd distance = projection * estimate.variables;
  const Eigen::VectorXd by_noise =
      (projection * noise_covariance * projection.transpose()).diagonal();
  std::vector<MemberSpread> spreads;
  for (const std::vector<std::size_t>& group : groups) {
    const auto num_variables = Eigen::Index(variables[group[0]].size());
    const auto num_members = Eigen::Index(group.size());
    MemberSpread spread = {Eigen::VectorXd::Zero(num_variables),
                           Eigen::VectorXd::Zero(num_variables),
                           Eigen::MatrixXd::Zero(num_variables, num_members)};
    Eigen::VectorXd squared_pull = Eigen::VectorXd::Zero(num_variables);
    for (Eigen::Index i = 0; num_members > 1 && i < num_members; ++i) {
      const DoubtOfMember doubt = DoubtMember(group, std::size_t(i), variables,
                                              estimate, num_observations);
      spread.errors.col(i) = doubt.squared_errors.cwiseSqrt();
      squared_pull = squared_pull.cwiseMax(doubt.squared_pull);
    }
    for (Eigen::Index k = 0; k < num_variables; ++k) {
      double sum = 0;
      double sum_of_weights = 0;
      for (const std::size_t member : group) {
        const Eigen::Index i = variables[member][k];
        const double weight = 1 / covariance(i, i);
        sum += weight * (distance(i) * distance(i) - by_noise(i));
        sum_of_weights += weight;
        for (const std::size_t other : group) {
          spread.largest_differences(k) =
              std::max(spread.largest_differences(k),
                       LargestDifference(estimate, i, variables[other][k]));
        }
      }
      spread.variance(k) =
          std::max({0.0, sum / sum_of_weights, squared_pull(k)});
    }
    spreads.push_back(spread);
  }
  return spreads;
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
