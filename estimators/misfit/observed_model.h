#ifndef ELASTIMATE_ESTIMATORS_MISFIT_OBSERVED_MODEL_H_
#define ELASTIMATE_ESTIMATORS_MISFIT_OBSERVED_MODEL_H_

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <string>

#include "elastimate/core/equilibrium/forward_model.h"
#include "elastimate/core/materials/elasticity.h"
#include "elastimate/core/scene/observed_displacements.h"
#include "elastimate/core/scene/scene.h"
#include "elastimate/estimators/interface/estimator.h"

namespace elastimate {

/// The finite element model of a scene at one nu, by its observed components:
/// the rows of u = t w + v.
class ObservedModel {
 public:
  /// `scene` must outlive this object.
  ObservedModel(const Scene& scene, const EstimatorOptions& options);

  /// Factorises the stiffness, unless it is at this nu.  False when it is
  /// singular to working precision.
  bool SetPoissonRatio(double poisson_ratio);

  // All that follows is at the nu of the last SetPoissonRatio, which succeeded.

  /// The rows of w, of dw/dnu and of v.
  const Eigen::VectorXd& UnitLoadResponse() const {
    return unit_load_response_;
  }
  Eigen::VectorXd UnitLoadResponseDerivative();
  Eigen::VectorXd SupportResponse() const;

  /// u of all nodes, num_dofs x num_load_cases.
  Eigen::MatrixXd Displacement(double youngs_modulus) const {
    return model_.Displacement(youngs_modulus);
  }
  /// The rows of du / d (ln E, nu).
  Eigen::Matrix<double, Eigen::Dynamic, 2> Sensitivities(double youngs_modulus);
  /// The rows of du/dnu: at fixed E, or else at fixed t.
  Eigen::VectorXd PoissonRatioSlope(const IsotropicElasticity& elasticity,
                                    bool at_fixed_youngs_modulus);
  SectionModel Section() const { return section_model_; }
  const ObservedDisplacements& Observed() const { return observed_; }
  const NodeGraph& Graph() const { return model_.Graph(); }
  Work WorkDone() const { return model_.WorkDone(); }
  const std::string& SolverNotice() const { return model_.Notice(); }

 private:
  SectionModel section_model_;
  ForwardModel model_;
  Eigen::Index num_load_cases_;
  ObservedDisplacements observed_;
  std::function<void(int)> on_factorization_;
  int num_factorizations_ = 0;
  Eigen::VectorXd unit_load_response_;
};

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_MISFIT_OBSERVED_MODEL_H_
