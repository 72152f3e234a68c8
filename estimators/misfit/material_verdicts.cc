#include "elastimate/estimators/misfit/material_verdicts.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

#include "elastimate/core/algebra/dense_algebra.h"
#include "elastimate/core/algebra/node_sums.h"
#include "elastimate/estimators/interface/finding_sentences.h"
#include "elastimate/estimators/interface/limits.h"
#include "elastimate/estimators/interface/parameter_judge.h"
#include "elastimate/estimators/statistics/residual_statistics.h"

namespace elastimate {
namespace {

// What the stresses of each material do on the displacements, in all load cases
// together: twice its strain energy where strains are small.
Eigen::VectorXd WorkOf(const ForwardModel& model, const Eigen::VectorXd& moduli,
                       const Eigen::MatrixXd& displacement) {
  const MaterialParameters& parameters = model.Parameters();
  const auto num_materials = Eigen::Index(parameters.NumMaterials());
  Eigen::VectorXd energies = Eigen::VectorXd::Zero(num_materials);
  for (const auto& u : displacement.colwise()) {
    const Eigen::VectorXd of_moduli =
        InnerProducts(model.ForceColumns(u), u).cwiseProduct(moduli);
    for (Eigen::Index i = 0; i < num_materials; ++i) {
      const Eigen::Index first = parameters.FirstModulus(i);
      energies(i) += of_moduli
                         .segment(first, (i + 1 < num_materials
                                              ? parameters.FirstModulus(i + 1)
                                              : parameters.NumModuli()) -
                                             first)
                         .sum();
    }
  }
  return energies;
}

// 1 in the rows of nodes of a material and of points in it, 0 in others.
Eigen::VectorXd RowsOf(const Scene& scene, const std::vector<int>& material_of,
                       int material, const ObservedDisplacements& observed) {
  const Eigen::Index num_nodes = scene.mesh.NumNodes();
  Eigen::VectorXd of_nodes = Eigen::VectorXd::Zero(num_nodes);
  for (Eigen::Index e = 0; e < scene.mesh.NumElements(); ++e) {
    if (material_of[e] == material) {
      of_nodes(scene.mesh.elements.col(e)).setOnes();
    }
  }
  Eigen::VectorXd rows = Eigen::VectorXd::Zero(observed.Size());
  for (const ObservedDisplacements::Point& point : observed.Points()) {
    bool is_of_it = false;
    if (point.index < num_nodes) {
      is_of_it = of_nodes(point.index) == 1;
    } else {
      const MeshPoints& points =
          scene.load_cases[point.load_case].points.points;
      is_of_it =
          material_of[points.elements(point.index - num_nodes)] == material;
    }
    rows.segment(point.first, point.count).setConstant(is_of_it ? 1 : 0);
  }
  return rows;
}

// The correlation of neighbours that are both in these rows: others add no
// product, and are not counted.
std::optional<NeighbourCorrelation> CorrelateWithin(
    const Eigen::VectorXd& rows, const NodeGraph& graph,
    const ObservedDisplacements& observed, const Eigen::VectorXd& residual) {
  const Eigen::VectorXd within = rows.cwiseProduct(residual);
  const std::optional<NeighbourCorrelation> products =
      CorrelateNeighbours(graph, observed, within);
  const std::optional<NeighbourCorrelation> pairs =
      CorrelateNeighbours(graph, observed, rows);
  if (!products || !pairs || !(pairs->correlation > 0)) {
    return std::nullopt;
  }
  // Both are sums over the same number of pairs, over mean squares of all rows.
  const double num_all = 1 / std::pow(pairs->standard_deviation, 2);
  const double num_pairs = pairs->correlation * num_all * rows.mean();
  return NeighbourCorrelation{products->correlation / pairs->correlation,
                              1 / std::sqrt(num_pairs)};
}

// Enters the residuals of each material, and names the one that is least
// likely by chance.
void DescribeResiduals(const Scene& scene, const MinimumErrors& errors,
                       DisplacementMisfit& misfit, Estimate& estimate) {
  const ObservedDisplacements& observed = misfit.Observed();
  const std::vector<int> material_of =
      MaterialOfElements(scene.materials, scene.mesh);
  const double noise = observed.GivenNoise()
                           ? 1 / (observed.Norm() * observed.Norm())
                           : errors.variance;
  // What is left of exact displacements says nothing.
  constexpr double kRounding = 1e-9;
  const bool is_rounding =
      Norm(errors.residual) < kRounding * Norm(observed.MeasuredWithoutTurn());
  double highest_score = kLimits.significant_score;
  const MaterialEstimate* worst = nullptr;
  for (std::size_t i = 0; i < scene.materials.size(); ++i) {
    MaterialEstimate& material = estimate.materials[i];
    const Eigen::VectorXd rows =
        RowsOf(scene, material_of, static_cast<int>(i), observed);
    if (rows.isZero(0)) {
      continue;
    }
    if (noise > 0) {
      material.residual_chi_square =
          SquaredNorm(rows.cwiseProduct(errors.residual)) / rows.sum() / noise;
    }
    const std::optional<NeighbourCorrelation> neighbours =
        CorrelateWithin(rows, misfit.Neighbours(), observed, errors.residual);
    if (!neighbours) {
      continue;
    }
    material.residual_correlation =
        std::clamp(neighbours->correlation, -1.0, 1.0);
    const double score =
        neighbours->correlation / neighbours->standard_deviation;
    if (score > highest_score && !is_rounding) {
      highest_score = score;
      worst = &material;
    }
  }
  if (worst != nullptr) {
    estimate.Add(ResidualInRegion(RegionsLabel(worst->regions),
                                  *worst->residual_correlation));
  }
}

// Groups those that take part in the same directions, which are orthonormal
// columns.
std::vector<std::vector<Eigen::Index>> TogetherIn(
    const Eigen::MatrixXd& directions) {
  // An entry of the projector that is larger is there.
  constexpr double kLeast = 0.2;
  const Eigen::MatrixXd projector = directions * directions.transpose();
  std::vector<std::vector<Eigen::Index>> groups;
  std::vector<bool> is_taken(projector.cols(), false);
  for (Eigen::Index i = 0; i < projector.cols(); ++i) {
    if (is_taken[i] || projector(i, i) < kLeast) {
      continue;
    }
    is_taken[i] = true;
    std::vector<Eigen::Index> group = {i};
    for (std::size_t k = 0; k < group.size(); ++k) {
      for (Eigen::Index j = 0; j < projector.cols(); ++j) {
        if (!is_taken[j] && std::abs(projector(group[k], j)) > kLeast) {
          is_taken[j] = true;
          group.push_back(j);
        }
      }
    }
    std::sort(group.begin(), group.end());
    groups.push_back(group);
  }
  return groups;
}

// "E of region 1, E of region 2 and 4 more".
std::string ListOf(const std::vector<std::string>& names) {
  constexpr std::size_t kMostNamed = 3;
  const std::size_t num_named =
      names.size() > kMostNamed ? kMostNamed - 1 : names.size() - 1;
  std::string text;
  for (std::size_t i = 0; i < num_named; ++i) {
    text += (i == 0 ? "" : ", ") + names[i];
  }
  return text + " and " +
         (num_named + 1 == names.size()
              ? names.back()
              : std::to_string(names.size() - num_named) + " more");
}

// What is determined of logarithms that this direction leaves free.
std::string OfTwoModuli(const std::string& first, const std::string& second,
                        const Eigen::Vector2d& free) {
  // Exponents within a fifth of each other are about the same.
  constexpr double kAlike = 0.8;
  const Eigen::Vector2d size = free.cwiseAbs();
  if (size.minCoeff() < kAlike * size.maxCoeff()) {
    return "one combination of " + first + " and " + second;
  }
  return free(0) * free(1) > 0 ? "the ratio of " + first + " to " + second
                               : "the product of " + first + " and " + second;
}

}  // namespace

std::vector<std::string> DeterminedCombinations(
    const Eigen::MatrixXd& covariance, const Eigen::VectorXd& largest_errors,
    const std::vector<std::string>& labels,
    const std::vector<bool>& is_logarithm) {
  const Eigen::VectorXd scale = largest_errors.cwiseInverse();
  const Eigen::MatrixXd scaled =
      scale.asDiagonal() * covariance * scale.asDiagonal();
  const Eigen::VectorXd information = Inverse(scaled).diagonal();
  std::vector<Eigen::Index> places;
  for (Eigen::Index i = 0; i < information.size(); ++i) {
    if (information(i) > 1 && scaled(i, i) > 1) {
      places.push_back(i);
    }
  }
  std::vector<std::string> combinations;
  if (places.empty() || !scaled.allFinite()) {
    return combinations;
  }
  const Eigen::MatrixXd of_places = scaled(places, places);
  const SymmetricEigenDecomposition eigen = DecomposeSymmetric(of_places);
  const Eigen::Index num_free = (eigen.values.array() > 1).count();
  const Eigen::MatrixXd directions = eigen.vectors.rightCols(num_free);
  for (const std::vector<Eigen::Index>& group : TogetherIn(directions)) {
    std::vector<std::string> names;
    bool are_logarithms = true;
    for (const Eigen::Index i : group) {
      names.push_back(labels[places[i]]);
      are_logarithms = are_logarithms && is_logarithm[places[i]];
    }
    const Eigen::MatrixXd of_group = directions(group, Eigen::all);
    const auto num_left = Eigen::Index(group.size()) -
                          Eigen::Index(std::lround(SquaredNorm(of_group)));
    if (num_left < 1 || group.size() < 2) {
      continue;
    }
    if (group.size() == 2 && are_logarithms) {
      Eigen::Index largest = 0;
      of_group.colwise().squaredNorm().maxCoeff(&largest);
      combinations.push_back(
          OfTwoModuli(names[0], names[1], of_group.col(largest)));
    } else {
      combinations.push_back(
          (num_left == 1 ? "one combination of "
                         : std::to_string(num_left) + " combinations of ") +
          ListOf(names));
    }
  }
  return combinations;
}

void DescribeMaterials(const Scene& scene, const MinimumErrors& errors,
                       DisplacementMisfit& misfit, Estimate& estimate) {
  if (scene.materials.size() < 2 || errors.total.size() == 0) {
    return;
  }
  const FreeParameters& free = misfit.Free();
  const Eigen::VectorXd energies = WorkOf(
      misfit.Model(), free.ModuliAt(errors.variables), misfit.Displacement());
  estimate.materials.clear();
  for (std::size_t i = 0; i < scene.materials.size(); ++i) {
    MaterialEstimate material;
    material.regions = scene.materials[i].regions;
    if (energies.sum() > 0) {
      material.energy_share = energies(Eigen::Index(i)) / energies.sum();
    }
    estimate.materials.push_back(material);
  }
  DescribeResiduals(scene, errors, misfit, estimate);
  std::vector<std::string> labels;
  std::vector<bool> is_logarithm;
  for (const Eigen::Index i : free.All().Free()) {
    labels.push_back(estimate.parameters[i].Label());
    is_logarithm.push_back(estimate.parameters[i].is_modulus);
  }
  const Eigen::MatrixXd jacobian = free.RelativeJacobian(errors.corrected);
  estimate.combinations = DeterminedCombinations(
      jacobian * errors.total * jacobian.transpose(),
      LargestErrorsOfVariables(free), labels, is_logarithm);
  if (!estimate.combinations.empty()) {
    estimate.Add(CombinationsOnly(estimate.combinations));
  }
}

}  // namespace elastimate
