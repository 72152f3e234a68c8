#ifndef ELASTIMATE_CORE_SCENE_OBSERVED_DISPLACEMENTS_H_
#define ELASTIMATE_CORE_SCENE_OBSERVED_DISPLACEMENTS_H_

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <array>
#include <optional>
#include <vector>

#include "elastimate/core/scene/scene.h"

namespace elastimate {

/// The measured displacements of a scene as one vector of rows, the load cases
/// below each other:
///
///   q_i = sum_j N_j(x_i) u_j + noise of the standard deviation s_i,
///
/// where x_i is a node, or a point within an element of shape functions N_j.
/// Held degrees of freedom u_j whose displacement is given are known.  Their
/// part is subtracted from q_i, and a row that has no other part is left out;
/// but where a rigid motion of the whole specimen is free, known displacements
/// take part in that motion and all rows stay.  Rows are weighted by 1 / s_i
/// where it is known, and normalised so that the first vector of measurements
/// has norm 1.  The turn of a camera (TurnOfCamera), where a rigid motion is
/// free, does not count in that norm: it is no displacement of the specimen.
class ObservedDisplacements {
 public:
  /// The observed components of one node, or of another point, in one load
  /// case: rows [first, first + count) of the vector.
  struct Point {
    Eigen::Index load_case;
    /// The node; for a point, its number counted on behind all nodes.
    Eigen::Index index;
    Eigen::Index first;
    int count;
  };

  /// Precondition: a valid scene, with a measurement in each load case.
  /// O(num_rows), and where there are points O(num_points log num_points).
  explicit ObservedDisplacements(const Scene& scene);

  /// Takes the measured displacements of a scene that differs in nothing else,
  /// and keeps the normalisation.
  void Remeasure(const Scene& scene);

  int Dimension() const { return dimension_; }
  Eigen::Index NumLoadCases() const {
    return static_cast<Eigen::Index>(rows_.size());
  }
  /// Returns the points in the order of their rows.
  const std::vector<Point>& Points() const { return points_; }
  /// Returns pairs of points that are near each other and no nodes, as indices
  /// of Points.  The points of a pair are of one load case.
  const std::vector<std::array<Eigen::Index, 2>>& NeighbouringPoints() const {
    return neighbouring_points_;
  }
  Eigen::Index Size() const { return measured_.size(); }
  const Eigen::VectorXd& Measured() const { return measured_; }
  /// Returns what was measured without the turns of cameras.
  Eigen::VectorXd MeasuredWithoutTurn() const {
    return turn_.size() == 0 ? measured_ : measured_ - turn_;
  }
  /// Returns the norm of the first weighted measurement without turns, which is
  /// the unit here.
  double Norm() const { return norm_; }
  /// Returns the displacement that is 1 in each row [length].
  Eigen::VectorXd RowUnits() const { return weights_.cwiseInverse(); }
  /// Returns the component (0, 1 and, in three dimensions, 2) of a row.
  int Component(Eigen::Index row) const { return component_[row]; }
  /// Returns the root mean square of the standard deviations of the noise
  /// [length]; empty where they are not known.
  const std::optional<double>& GivenNoise() const { return given_noise_; }

  /// The rows of load case `k` are [CaseStart(k), CaseStart(k + 1)).
  Eigen::Index CaseStart(Eigen::Index k) const { return case_start_[k]; }

  /// Returns the rows of other displacements, num_dofs x num_load_cases, with
  /// the same weights and normalisation, without the part of held degrees of
  /// freedom.
  Eigen::VectorXd Restrict(const Eigen::MatrixXd& displacements) const;
  /// Returns the rows of load case `k` of one displacement, num_dofs values.
  Eigen::VectorXd RestrictToCase(Eigen::Index k,
                                 const Eigen::VectorXd& displacement) const;
  /// Multiplies by the transpose of Restrict: num_dofs x num_load_cases.
  Eigen::MatrixXd RestrictTransposed(const Eigen::VectorXd& rows) const;
  /// Returns a weight d for each degree of freedom, so that in no load case the
  /// norm of the rows of a displacement u is above the norm of d u, taken by
  /// components.  The two are equal where only nodes are observed, in one load
  /// case.
  Eigen::VectorXd BoundingWeights() const;

 private:
  /// The matrix of a load case, rows x num_dofs, with zeros for held
  /// components.
  using Rows = Eigen::SparseMatrix<double, Eigen::RowMajor, Eigen::Index>;

  int dimension_;
  std::vector<Point> points_;
  std::vector<std::array<Eigen::Index, 2>> neighbouring_points_;
  std::vector<Eigen::Index> case_start_ = {0};
  std::vector<int> component_;
  std::vector<Rows> rows_;
  Eigen::VectorXd weights_;
  /// The weighted part of the held degrees of freedom in each row.
  Eigen::VectorXd held_part_;
  Eigen::VectorXd measured_;
  /// The rows of the turns of cameras; empty where none is free.
  Eigen::VectorXd turn_;
  double norm_;
  std::optional<double> given_noise_;
};

/// Tells whether any component that was measured at a point of a load case,
/// rather than at a node, has a row in ObservedDisplacements.  O(num_points).
[[nodiscard]] bool AreFreePointsMeasured(const Scene& scene,
                                         Eigen::Index load_case);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_SCENE_OBSERVED_DISPLACEMENTS_H_
