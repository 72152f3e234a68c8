#ifndef ELASTIMATE_ESTIMATORS_DISPLACEMENT_FIT_OBSERVED_DISPLACEMENTS_H_
#define ELASTIMATE_ESTIMATORS_DISPLACEMENT_FIT_OBSERVED_DISPLACEMENTS_H_

#include <Eigen/Core>
#include <vector>

#include "elastimate/core/scene/scene.h"

namespace elastimate {

/// The measured displacements of a scene as one vector: the observed free
/// components of all load cases, weighted by 1 / noise_sd where it is known,
/// and normalised so that the first such vector has norm 1.
class ObservedDisplacements {
 public:
  /// The observed components of one node in one load case: rows
  /// [first, first + count) of the vector.
  struct Node {
    Eigen::Index node;
    Eigen::Index load_case;
    Eigen::Index first;
    int count;
  };

  /// Precondition: what Estimator::Run checks.
  explicit ObservedDisplacements(const Scene& scene);

  /// Takes the measured displacements of a scene that differs in nothing else,
  /// with the normalisation as it was.
  void Remeasure(const Scene& scene);

  int Dimension() const { return dimension_; }
  const std::vector<Node>& Nodes() const { return nodes_; }
  Eigen::Index Size() const { return measured_.size(); }
  const Eigen::VectorXd& Measured() const { return measured_; }
  /// The norm of the first weighted measurement, which is the unit here.
  double Norm() const { return norm_; }
  /// The component (0, 1 and, in three dimensions, 2) of a row.
  int Component(Eigen::Index row) const {
    return static_cast<int>(places_[row] % dimension_);
  }

  /// The rows of load case `k` are [CaseStart(k), CaseStart(k + 1)).
  Eigen::Index CaseStart(Eigen::Index k) const { return case_start_[k]; }

  /// The same rows of other displacements, num_dofs x num_load_cases,
  /// with the same weights and normalisation.
  Eigen::VectorXd Restrict(const Eigen::MatrixXd& displacements) const;
  /// For each of the degrees of freedom the largest of its weights
  /// over the load cases, normalisation included; zero where none observes it.
  Eigen::VectorXd LargestWeights() const;
  /// The rows of load case `k` of one displacement, num_dofs values.
  Eigen::VectorXd RestrictToCase(Eigen::Index k,
                                 const Eigen::VectorXd& displacement) const;

 private:
  int dimension_;
  std::vector<Node> nodes_;
  std::vector<Eigen::Index> case_start_;
  /// For each row its place in num_dofs x num_load_cases, by columns.
  std::vector<Eigen::Index> places_;
  Eigen::VectorXd weights_;
  Eigen::VectorXd measured_;
  double norm_;
  Eigen::Index num_dofs_;
};

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_DISPLACEMENT_FIT_OBSERVED_DISPLACEMENTS_H_
