#ifndef ELASTIMATE_ESTIMATORS_MISFIT_ELEMENT_CHANGE_H_
#define ELASTIMATE_ESTIMATORS_MISFIT_ELEMENT_CHANGE_H_

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "elastimate/core/equilibrium/hierarchical_error.h"
#include "elastimate/core/materials/elasticity.h"
#include "elastimate/core/scene/observed_displacements.h"
#include "elastimate/core/scene/scene.h"
#include "elastimate/core/solvers/stiffness_solver.h"

namespace elastimate {

/// What finer elements change in the displacements of a scene: quadratic
/// simplices of its nodes (FinerScene, HierarchicalError), which for
/// quadratic elements are of half the size.
class ElementChange {
 public:
  /// `scene` must outlive this object.
  explicit ElementChange(const Scene& scene) : scene_(scene) {}

  /// A model of the scene at some nu: w and v, as those of ForwardModel, and a
  /// solver of its mesh that is factorised there or near there; null where
  /// there is none.
  struct Model {
    Eigen::MatrixXd responses;
    StiffnessSolver* solver;
  };
  using ModelAt = std::function<Model(double poisson_ratio)>;

  /// Of the observed rows of u = t w + v, for the finer elements minus for
  /// those of the scene; empty where it is not known.  `model_at` is asked only
  /// where there is something to solve.
  ///
  /// Found once for all nu whose stiffness is about the same; where it is known
  /// at another nu nearby, it is linear in nu between the two.  Next to nu =
  /// 1/2, where iterations would not end, that of quadratic elements, which do
  /// not lock, is taken as it is at 0.495.  Cost: that of HierarchicalError.
  std::optional<Eigen::VectorXd> Rows(const ObservedDisplacements& observed,
                                      const IsotropicElasticity& elasticity,
                                      const ModelAt& model_at);

  Work WorkDone() const { return work_; }

 private:
  // At one nu.
  struct Found {
    double poisson_ratio;
    /// Of w and v.
    std::optional<Eigen::MatrixXd> change;
  };

  // Of those found, but for one, at most this far in LogStiffnessRatio; null
  // where there is none.
  const Found* Nearest(double nu, double within, const Found* but) const;
  // Of u.  Precondition: found.change.
  Eigen::MatrixXd ChangeOf(const Found& found, double youngs_modulus) const;
  std::optional<Eigen::MatrixXd> Find(double poisson_ratio,
                                      const ModelAt& model_at);

  const Scene& scene_;
  std::unique_ptr<HierarchicalError> hierarchical_;
  std::vector<Found> found_;
  Work work_;
};

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_MISFIT_ELEMENT_CHANGE_H_
