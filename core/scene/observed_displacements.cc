#include "elastimate/core/scene/observed_displacements.h"

#include <cmath>

#include "elastimate/core/algebra/node_sums.h"
#include "elastimate/core/mesh/nearest_points.h"
#include "elastimate/core/scene/camera.h"

namespace elastimate {
namespace {

// A shape function below this is zero but for rounding.
constexpr double kNoPart = 1e-9;
// Returns the number of neighbours of a point in a regular grid along the axes.
int NumNeighbours(int dimension) { return 2 * dimension; }

// The measurement of one load case at its nodes, and behind them at its points.
class Measurement {
 public:
  Measurement(const Scene& scene, Eigen::Index k)
      : load_case_(scene.load_cases[k]), num_nodes_(scene.mesh.NumNodes()) {}

  bool Has(int component, Eigen::Index index) const {
    return index < num_nodes_ ? IsObserved(load_case_, component, index)
                              : !std::isnan(At(component, index));
  }
  double At(int component, Eigen::Index index) const {
    return index < num_nodes_
               ? load_case_.displacement(component, index)
               : load_case_.points.displacement(component, index - num_nodes_);
  }
  /// Returns 1 where the standard deviation is not known.
  double StandardDeviation(int component, Eigen::Index index) const {
    return index < num_nodes_ || load_case_.points.noise_sd.size() == 0
               ? load_case_.noise_sd.value_or(1)
               : load_case_.points.noise_sd(component, index - num_nodes_);
  }

 private:
  const LoadCase& load_case_;
  Eigen::Index num_nodes_;
};

// Tells whether a support says where a degree of freedom moves.
bool IsKnown(const Scene& scene, const Supports& supports, int component,
             Eigen::Index node) {
  return !scene.is_rigid_motion_free && supports.IsGiven(component, node);
}

// Collects the rows of all load cases.
struct RowList {
  const Scene& scene;
  std::vector<ObservedDisplacements::Point> points;
  std::vector<std::array<Eigen::Index, 2>> neighbouring_points;
  std::vector<int> component;
  std::vector<double> weights;
  std::vector<double> held_part;
  /// The entries of the present load case, which begins with row `first`.
  std::vector<Eigen::Triplet<double, Eigen::Index>> entries;
  Eigen::Index first = 0;

  Eigen::Index Size() const { return Eigen::Index(component.size()); }

  // Adds the components of a node or another point, each of which is the sum of
  // the components of `nodes` times `shape_functions`.
  template <class Nodes, class Values>
  void AddPoint(Eigen::Index k, Eigen::Index index, const Nodes& nodes,
                const Values& shape_functions) {
    const Measurement measurement(scene, k);
    const Supports& supports = SupportsOf(scene, k);
    ObservedDisplacements::Point point = {k, index, Size(), 0};
    for (int i = 0; i < scene.mesh.Dimension(); ++i) {
      if (!measurement.Has(i, index)) {
        continue;
      }
      const double weight = 1 / measurement.StandardDeviation(i, index);
      const std::size_t num_entries = entries.size();
      double held = 0;
      for (Eigen::Index j = 0; j < nodes.size(); ++j) {
        if (IsKnown(scene, supports, i, nodes(j))) {
          held += shape_functions(j) * supports.displacement(i, nodes(j));
        } else if (std::abs(shape_functions(j)) > kNoPart) {
          entries.emplace_back(
              Size() - first,
              scene.mesh.Dimension() * Eigen::Index(nodes(j)) + i,
              weight * shape_functions(j));
        }
      }
      if (entries.size() > num_entries) {
        component.push_back(i);
        weights.push_back(weight);
        held_part.push_back(weight * held);
        ++point.count;
      }
    }
    if (point.count > 0) {
      points.push_back(point);
    }
  }

  void AddLoadCase(Eigen::Index k) {
    const Mesh& mesh = scene.mesh;
    const LoadCase& load_case = scene.load_cases[k];
    entries.clear();
    first = Size();
    if (load_case.displacement.size() != 0) {
      const Eigen::Matrix<double, 1, 1> one(1);
      for (int node = 0; node < mesh.NumNodes(); ++node) {
        AddPoint(k, node, Eigen::Matrix<int, 1, 1>(node), one);
      }
    }
    AddPoints(k, load_case.points.points);
  }

  void AddPoints(Eigen::Index k, const MeshPoints& at) {
    const Mesh& mesh = scene.mesh;
    const std::size_t first_point = points.size();
    const Eigen::MatrixXd shape_functions = ShapeFunctionsOf(mesh, at);
    for (Eigen::Index point = 0; point < at.Size(); ++point) {
      AddPoint(k, mesh.NumNodes() + point,
               mesh.elements.col(at.elements(point)),
               shape_functions.col(point));
    }
    std::vector<Eigen::Index> with_rows;
    for (std::size_t i = first_point; i < points.size(); ++i) {
      with_rows.push_back(points[i].index - mesh.NumNodes());
    }
    const Eigen::MatrixXd positions = Interpolate(mesh, at, mesh.nodes);
    for (const auto& [a, b] : NearestPairs(positions(Eigen::all, with_rows),
                                           NumNeighbours(mesh.Dimension()))) {
      const Eigen::Index begin = Eigen::Index(first_point);
      neighbouring_points.push_back({begin + a, begin + b});
    }
  }
};

Eigen::VectorXd ToVector(const std::vector<double>& values) {
  return Eigen::Map<const Eigen::VectorXd>(values.data(),
                                           Eigen::Index(values.size()));
}

// Returns the displacements by which the cameras turn the nodes, num_dofs x
// num_load_cases.
Eigen::MatrixXd DisplacementsByTurns(const Scene& scene) {
  Eigen::MatrixXd displacements(scene.mesh.NumDofs(),
                                Eigen::Index(scene.load_cases.size()));
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(scene.mesh.NumDofs());
  for (Eigen::Index k = 0; k < displacements.cols(); ++k) {
    displacements.col(k) = TurnOfCamera(scene, scene.load_cases[k])
                               .SeenDisplacement(scene.mesh, none);
  }
  return displacements;
}

// Returns ObservedDisplacements::GivenNoise; `weights` are not normalised.
std::optional<double> GivenNoiseOf(const Scene& scene,
                                   const Eigen::VectorXd& weights) {
  const LoadCase& load_case = scene.load_cases.front();
  return load_case.points.noise_sd.size() == 0
             ? load_case.noise_sd
             : std::sqrt(weights.cwiseInverse().squaredNorm() /
                         static_cast<double>(weights.size()));
}

}  // namespace

ObservedDisplacements::ObservedDisplacements(const Scene& scene)
    : dimension_(scene.mesh.Dimension()) {
  RowList list = {scene, {}, {}, {}, {}, {}, {}};
  for (std::size_t k = 0; k < scene.load_cases.size(); ++k) {
    list.AddLoadCase(Eigen::Index(k));
    Rows& rows = rows_.emplace_back(list.Size() - case_start_.back(),
                                    scene.mesh.NumDofs());
    rows.setFromTriplets(list.entries.begin(), list.entries.end());
    case_start_.push_back(list.Size());
  }
  points_ = std::move(list.points);
  neighbouring_points_ = std::move(list.neighbouring_points);
  component_ = std::move(list.component);
  weights_ = ToVector(list.weights);
  held_part_ = ToVector(list.held_part);
  given_noise_ = GivenNoiseOf(scene, weights_);
  Remeasure(scene);
  if (scene.is_rigid_motion_free) {
    turn_ = Restrict(DisplacementsByTurns(scene));
  }
  norm_ = elastimate::Norm(MeasuredWithoutTurn());
  measured_ /= norm_;
  turn_ /= norm_;
  weights_ /= norm_;
  held_part_ /= norm_;
  for (Rows& rows : rows_) {
    rows /= norm_;
  }
}

void ObservedDisplacements::Remeasure(const Scene& scene) {
  measured_ = -held_part_;
  for (const Point& point : points_) {
    const Measurement measurement(scene, point.load_case);
    for (Eigen::Index row = point.first; row < point.first + point.count;
         ++row) {
      measured_(row) +=
          weights_(row) * measurement.At(component_[row], point.index);
    }
  }
}

Eigen::VectorXd ObservedDisplacements::Restrict(
    const Eigen::MatrixXd& displacements) const {
  Eigen::VectorXd rows(Size());
  for (Eigen::Index k = 0; k < displacements.cols(); ++k) {
    rows.segment(CaseStart(k), CaseStart(k + 1) - CaseStart(k)).noalias() =
        rows_[k] * displacements.col(k);
  }
  return rows;
}

Eigen::VectorXd ObservedDisplacements::RestrictToCase(
    Eigen::Index k, const Eigen::VectorXd& displacement) const {
  return rows_[k] * displacement;
}

Eigen::MatrixXd ObservedDisplacements::RestrictTransposed(
    const Eigen::VectorXd& rows) const {
  Eigen::MatrixXd displacements(rows_.front().cols(), NumLoadCases());
  for (Eigen::Index k = 0; k < NumLoadCases(); ++k) {
    displacements.col(k).noalias() =
        rows_[k].transpose() *
        rows.segment(CaseStart(k), CaseStart(k + 1) - CaseStart(k));
  }
  return displacements;
}

Eigen::VectorXd ObservedDisplacements::BoundingWeights() const {
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(rows_.front().cols());
  for (const Rows& rows : rows_) {
    // Each row b has (sum_j b_j u_j)^2 <= sum_j |b_j| sum_j |b_j| u_j^2.
    const Rows sizes = rows.cwiseAbs();
    const Eigen::VectorXd of_rows = sizes * Eigen::VectorXd::Ones(sizes.cols());
    weights = weights.cwiseMax((sizes.transpose() * of_rows).cwiseSqrt());
  }
  return weights;
}

bool AreFreePointsMeasured(const Scene& scene, Eigen::Index load_case) {
  const PointDisplacements& measured = scene.load_cases[load_case].points;
  const Supports& supports = SupportsOf(scene, load_case);
  const Eigen::MatrixXd shape_functions =
      ShapeFunctionsOf(scene.mesh, measured.points);
  for (Eigen::Index point = 0; point < measured.points.Size(); ++point) {
    const auto nodes = scene.mesh.elements.col(measured.points.elements(point));
    for (int i = 0; i < scene.mesh.Dimension(); ++i) {
      if (std::isnan(measured.displacement(i, point))) {
        continue;
      }
      for (Eigen::Index j = 0; j < nodes.size(); ++j) {
        if (!IsKnown(scene, supports, i, nodes(j)) &&
            std::abs(shape_functions(j, point)) > kNoPart) {
          return true;
        }
      }
    }
  }
  return false;
}

}  // namespace elastimate
