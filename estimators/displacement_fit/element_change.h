#ifndef ELASTIMATE_ESTIMATORS_DISPLACEMENT_FIT_ELEMENT_CHANGE_H_
#define ELASTIMATE_ESTIMATORS_DISPLACEMENT_FIT_ELEMENT_CHANGE_H_

#include <Eigen/Core>
#include <functional>
#include <limits>
#include <memory>
#include <optional>

#include "elastimate/core/equilibrium/hierarchical_error.h"
#include "elastimate/core/materials/elasticity.h"
#include "elastimate/core/scene/observed_displacements.h"
#include "elastimate/core/scene/scene.h"
#include "elastimate/core/solvers/stiffness_solver.h"

namespace elastimate {

/// How much the displacements of a scene depend on the order of its elements:
/// for linear ones, of any shape, what quadratic simplices of their nodes
/// change (SimplicialScene, HierarchicalError), for quadratic ones what they
/// changed against linear ones of the same vertices.
class ElementChange {
 public:
  /// `scene` must outlive this object.
  explicit ElementChange(const Scene& scene) : scene_(scene) {}

  /// Of the observed rows of u = t w + v, for quadratic elements minus for
  /// linear ones; empty where it is not known.  `responses` are w and v at nu,
  /// as those of ForwardModel.  `solver_near` gives a solver of the mesh of the
  /// scene that is factorised at or near a nu, or null; it is asked only where
  /// there is something to solve.
  ///
  /// Found once for all nu whose stiffness is about the same.  Cost: that of
  /// HierarchicalError; for quadratic elements that of a ForwardModel of linear
  /// ones.
  std::optional<Eigen::VectorXd> Rows(
      const ObservedDisplacements& observed,
      const IsotropicElasticity& elasticity, const Eigen::MatrixXd& responses,
      const std::function<StiffnessSolver*(double poisson_ratio)>& solver_near);

  Work WorkDone() const { return work_; }

 private:
  std::optional<Eigen::MatrixXd> OfLinearElements(
      double poisson_ratio, const Eigen::MatrixXd& responses,
      StiffnessSolver* solver);
  std::optional<Eigen::MatrixXd> OfQuadraticElements(
      double poisson_ratio, const Eigen::MatrixXd& responses);

  const Scene& scene_;
  std::unique_ptr<HierarchicalError> hierarchical_;
  /// NaN before it was found.
  double poisson_ratio_ = std::numeric_limits<double>::quiet_NaN();
  /// Of w and v.
  std::optional<Eigen::MatrixXd> change_;
  Work work_;
};

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_DISPLACEMENT_FIT_ELEMENT_CHANGE_H_
