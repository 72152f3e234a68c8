#include "elastimate/estimators/validation/folds.h"

#include <algorithm>
#include <functional>
#include <stdexcept>
#include <utility>

#include "elastimate/core/mesh/axis_names.h"
#include "elastimate/core/mesh/mesh_points.h"
#include "elastimate/core/text/numbers.h"
#include "elastimate/estimators/material_fit/outliers.h"

namespace elastimate {
namespace {

bool IsNodeMeasured(const LoadCase& load_case, Eigen::Index node,
                    int dimension) {
  for (int i = 0; i < dimension; ++i) {
    if (IsObserved(load_case, i, node)) {
      return true;
    }
  }
  return false;
}

bool MovesAsMeasured(const Supports& supports, Eigen::Index node) {
  return supports.unknown.size() != 0 && supports.unknown.col(node).any();
}

// Returns the fold of each load case, by `fold_of` the nodes and the points
// that are measured in it.
void AssignFolds(const Scene& scene,
                 const std::function<int(Eigen::Index, Eigen::Index)>& of_node,
                 const std::function<int(Eigen::Index, Eigen::Index)>& of_point,
                 Folds& folds) {
  for (std::size_t k = 0; k < scene.load_cases.size(); ++k) {
    const LoadCase& load_case = scene.load_cases[k];
    const Eigen::Index number = Eigen::Index(k);
    Eigen::VectorXi nodes =
        Eigen::VectorXi::Constant(scene.mesh.NumNodes(), -1);
    for (Eigen::Index node = 0; node < nodes.size(); ++node) {
      if (IsNodeMeasured(load_case, node, scene.mesh.Dimension()) &&
          !MovesAsMeasured(SupportsOf(scene, number), node)) {
        nodes(node) = of_node(number, node);
      }
    }
    Eigen::VectorXi points(load_case.points.points.Size());
    for (Eigen::Index point = 0; point < points.size(); ++point) {
      points(point) = of_point(number, point);
    }
    folds.of_nodes.push_back(std::move(nodes));
    folds.of_points.push_back(std::move(points));
  }
}

// Positions at which anything is measured, dimension x n.
Eigen::MatrixXd MeasuredPositions(const Scene& scene) {
  std::vector<Eigen::VectorXd> positions;
  for (std::size_t k = 0; k < scene.load_cases.size(); ++k) {
    const LoadCase& load_case = scene.load_cases[k];
    const Supports& supports = SupportsOf(scene, Eigen::Index(k));
    for (Eigen::Index node = 0; node < scene.mesh.NumNodes(); ++node) {
      if (IsNodeMeasured(load_case, node, scene.mesh.Dimension()) &&
          !supports.held.col(node).all()) {
        positions.emplace_back(scene.mesh.nodes.col(node));
      }
    }
    const Eigen::MatrixXd points =
        Interpolate(scene.mesh, load_case.points.points, scene.mesh.nodes);
    for (Eigen::Index point = 0; point < points.cols(); ++point) {
      positions.emplace_back(points.col(point));
    }
  }
  Eigen::MatrixXd all(scene.mesh.Dimension(), Eigen::Index(positions.size()));
  for (std::size_t i = 0; i < positions.size(); ++i) {
    all.col(Eigen::Index(i)) = positions[i];
  }
  return all;
}

Folds DividePoints(const Scene& scene, int num_folds) {
  const Eigen::MatrixXd positions = MeasuredPositions(scene);
  if (positions.cols() < num_folds) {
    const std::string most = std::to_string(positions.cols());
    throw std::invalid_argument("the measurement has " + most +
                                " points, which cannot be divided into " +
                                std::to_string(num_folds) +
                                " parts; give --folds=N of at most " + most);
  }
  Eigen::Index axis = 0;
  (positions.rowwise().maxCoeff() - positions.rowwise().minCoeff())
      .maxCoeff(&axis);
  std::vector<double> sorted(positions.cols());
  Eigen::VectorXd::Map(sorted.data(), positions.cols()) = positions.row(axis);
  std::sort(sorted.begin(), sorted.end());
  // The first coordinate of each fold but the first one.
  std::vector<double> starts;
  for (int i = 1; i < num_folds; ++i) {
    starts.push_back(sorted[sorted.size() * i / num_folds]);
  }
  // On a grid, several folds may begin at the same plane.
  starts.erase(std::unique(starts.begin(), starts.end()), starts.end());
  starts.erase(starts.begin(),
               std::upper_bound(starts.begin(), starts.end(), sorted.front()));
  if (starts.empty()) {
    throw std::invalid_argument(
        "all measured points lie in one plane across the longest direction, "
        "so that they cannot be divided");
  }
  const auto fold_at = [&](double x) {
    return static_cast<int>(std::upper_bound(starts.begin(), starts.end(), x) -
                            starts.begin());
  };
  Folds folds;
  for (std::size_t i = 0; i <= starts.size(); ++i) {
    const double first = i == 0 ? sorted.front() : starts[i - 1];
    const double last = i == starts.size() ? sorted.back() : starts[i];
    folds.names.push_back(std::string(kAxisNames[axis]) +
                          (first == last ? " = " + NumberText(first, 3)
                                         : " from " + NumberText(first, 3) +
                                               " to " + NumberText(last, 3)));
  }
  std::vector<Eigen::MatrixXd> points;
  for (const LoadCase& load_case : scene.load_cases) {
    points.push_back(
        Interpolate(scene.mesh, load_case.points.points, scene.mesh.nodes));
  }
  AssignFolds(
      scene,
      [&](Eigen::Index /*k*/, Eigen::Index node) {
        return fold_at(scene.mesh.nodes(axis, node));
      },
      [&](Eigen::Index k, Eigen::Index point) {
        return fold_at(points[k](axis, point));
      },
      folds);
  return folds;
}

Folds DivideLoadCases(const Scene& scene, int num_folds) {
  const int num_cases = static_cast<int>(scene.load_cases.size());
  if (num_cases < 2) {
    throw std::invalid_argument(
        "one load case cannot be divided; hold out points instead, or measure "
        "another load case");
  }
  num_folds = std::min(num_folds, num_cases);
  const auto first_of = [&](int fold) { return num_cases * fold / num_folds; };
  Folds folds;
  std::vector<int> fold_of_case;
  for (int fold = 0; fold < num_folds; ++fold) {
    const int first = first_of(fold);
    const int end = first_of(fold + 1);
    fold_of_case.insert(fold_of_case.end(), end - first, fold);
    folds.names.push_back(end - first == 1
                              ? "load case " + std::to_string(first + 1)
                              : "load cases " + std::to_string(first + 1) +
                                    " to " + std::to_string(end));
  }
  const auto of_case = [&](Eigen::Index k, Eigen::Index /*index*/) {
    return fold_of_case[k];
  };
  AssignFolds(scene, of_case, of_case, folds);
  return folds;
}

// Returns the scene with the measurement of those nodes and points whose folds
// are kept.
PartOfScene Part(const Scene& scene, const Folds& folds,
                 const std::function<bool(int)>& is_kept) {
  std::vector<Outlier> left_out;
  std::vector<bool> has_any(scene.load_cases.size(), false);
  const auto sort = [&](std::size_t k, const Eigen::VectorXi& of,
                        bool is_point) {
    for (Eigen::Index i = 0; i < of.size(); ++i) {
      if (of(i) >= 0 && is_kept(of(i))) {
        has_any[k] = true;
      } else if (of(i) >= 0) {
        left_out.push_back({Eigen::Index(k), i, is_point});
      }
    }
  };
  for (std::size_t k = 0; k < scene.load_cases.size(); ++k) {
    sort(k, folds.of_nodes[k], false);
    sort(k, folds.of_points[k], true);
  }
  PartOfScene part = {WithoutOutliers(scene, left_out), {}};
  std::vector<LoadCase> load_cases = std::move(part.scene.load_cases);
  part.scene.load_cases.clear();
  for (std::size_t k = 0; k < load_cases.size(); ++k) {
    if (has_any[k]) {
      part.scene.load_cases.push_back(std::move(load_cases[k]));
      part.load_cases.push_back(Eigen::Index(k));
    }
  }
  return part;
}

}  // namespace

Folds DivideMeasurement(const Scene& scene, HeldOutPart part, int num_folds) {
  if (num_folds < 2) {
    throw std::invalid_argument(
        "a measurement is divided into 2 parts or more, "
        "not " +
        std::to_string(num_folds));
  }
  for (std::size_t k = 0; k < scene.load_cases.size(); ++k) {
    if (!IsMeasured(scene.load_cases[k])) {
      throw std::invalid_argument(
          "load case " + std::to_string(k + 1) +
          " has no measured displacements to predict; leave it out");
    }
  }
  const bool by_load_cases =
      part == HeldOutPart::kLoadCases ||
      (part == HeldOutPart::kAutomatic && scene.load_cases.size() > 1);
  return by_load_cases ? DivideLoadCases(scene, num_folds)
                       : DividePoints(scene, num_folds);
}

PartOfScene WithoutFold(const Scene& scene, const Folds& folds, int fold) {
  return Part(scene, folds, [fold](int other) { return other != fold; });
}

PartOfScene OnlyFold(const Scene& scene, const Folds& folds, int fold) {
  PartOfScene part =
      Part(scene, folds, [fold](int other) { return other == fold; });
  for (LoadCase& load_case : part.scene.load_cases) {
    load_case.resultants.clear();
  }
  return part;
}

}  // namespace elastimate
