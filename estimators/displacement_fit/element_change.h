#ifndef ELASTIMATE_ESTIMATORS_DISPLACEMENT_FIT_ELEMENT_CHANGE_H_
#define ELASTIMATE_ESTIMATORS_DISPLACEMENT_FIT_ELEMENT_CHANGE_H_

#include <Eigen/Core>
#include <limits>
#include <memory>
#include <optional>

#include "elastimate/core/equilibrium/hierarchical_error.h"
#include "elastimate/core/scene/scene.h"
#include "elastimate/core/solvers/stiffness_solver.h"
#include "elastimate/estimators/displacement_fit/observed_displacements.h"

namespace elastimate {

/// How much the displacements of a scene depend on the order of its elements:
/// for linear simplices what quadratic ones change (HierarchicalError), for
/// quadratic ones what they changed against linear ones of the same vertices.
/// For other elements it is not known.
class ElementChange {
 public:
  /// `scene` must outlive this object.
  explicit ElementChange(const Scene& scene) : scene_(scene) {}

  /// Of the responses to the load cases and, behind them, to held displacements
  /// where there are any (ForwardModel), at nu: num_dofs x num_responses, for
  /// quadratic elements minus for linear ones.  Empty where it is not known.
  ///
  /// `solver` is of the mesh of the scene, factorised at or near nu.  Found
  /// once for all nu whose stiffness is about the same.
  /// Cost: that of HierarchicalError; for quadratic elements that of a
  /// ForwardModel of linear ones.
  const std::optional<Eigen::MatrixXd>& Find(double poisson_ratio,
                                             const Eigen::MatrixXd& responses,
                                             StiffnessSolver& solver);

  /// Whether it is what finer elements change, not what these changed.
  bool IsOfFinerElements() const { return scene_.mesh.Order() == 1; }

  Work WorkDone() const { return work_; }

 private:
  std::optional<Eigen::MatrixXd> OfLinearElements(
      double poisson_ratio, const Eigen::MatrixXd& responses,
      StiffnessSolver& solver);
  std::optional<Eigen::MatrixXd> OfQuadraticElements(
      double poisson_ratio, const Eigen::MatrixXd& responses);

  const Scene& scene_;
  std::unique_ptr<HierarchicalError> hierarchical_;
  /// NaN before the first call of Find.
  double poisson_ratio_ = std::numeric_limits<double>::quiet_NaN();
  std::optional<Eigen::MatrixXd> change_;
  Work work_;
};

/// The rows of the change of u = t w + v, of the changes of w and v; empty
/// where those are.
std::optional<Eigen::VectorXd> RowsOfChange(
    const ObservedDisplacements& observed,
    const std::optional<Eigen::MatrixXd>& of_responses, double compliance_scale,
    Eigen::Index num_load_cases);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_DISPLACEMENT_FIT_ELEMENT_CHANGE_H_
