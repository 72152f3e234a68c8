#include "elastimate/core/equilibrium/forward_model.h"

#include <cassert>

#include "elastimate/core/mechanics/stiffness_product.h"

namespace elastimate {

ForwardModel::ForwardModel(const Mesh& mesh, const Supports& supports,
                           const Eigen::MatrixXd& force, SolverKind solver)
    : mesh_(mesh),
      solver_(mesh, supports, solver),
      force_(force),
      held_displacement_(HeldDisplacement(supports)),
      has_held_displacement_(!held_displacement_.isZero(0)),
      support_response_(held_displacement_),
      support_response_derivative_(
          Eigen::VectorXd::Zero(held_displacement_.size())) {
  if (has_held_displacement_) {
    const StiffnessProducts products =
        MultiplyStiffnessBasis(mesh, held_displacement_);
    ++element_passes_;
    held_h_ = products.h;
    held_j_ = products.j;
  }
}

bool ForwardModel::SetPoissonRatio(double poisson_ratio) {
  if (poisson_ratio == PoissonRatio()) {
    return true;
  }
  has_derivatives_ = false;
  if (!solver_.Factorize(poisson_ratio)) {
    return false;
  }
  load_response_ = solver_.Solve(force_);
  if (has_held_displacement_) {
    support_response_ =
        held_displacement_ - solver_.Solve(held_h_ + poisson_ratio * held_j_);
  }
  return solver_.PoissonRatio() == poisson_ratio;
}

Eigen::MatrixXd ForwardModel::Displacement(double youngs_modulus) const {
  const double compliance_scale =
      IsotropicElasticity{youngs_modulus, PoissonRatio()}.ComplianceScale(
          mesh_.section.model);
  return (compliance_scale * load_response_).colwise() + support_response_;
}

Eigen::MatrixXd ForwardModel::Responses() const {
  Eigen::MatrixXd responses = load_response_;
  if (has_held_displacement_) {
    responses.conservativeResize(Eigen::NoChange, responses.cols() + 1);
    responses.rightCols<1>() = support_response_;
  }
  return responses;
}

DisplacementSensitivities ForwardModel::Sensitivities(double youngs_modulus) {
  assert(PoissonRatio() == PoissonRatio());
  if (!has_derivatives_) {
    ++element_passes_;
    const Eigen::MatrixXd responses =
        -solver_.Solve(MultiplyStiffnessBasis(mesh_, Responses()).j);
    load_response_derivative_ = responses.leftCols(load_response_.cols());
    if (has_held_displacement_) {
      support_response_derivative_ = responses.rightCols<1>();
    }
    has_derivatives_ = true;
  }
  const double t =
      IsotropicElasticity{youngs_modulus, PoissonRatio()}.ComplianceScale(
          mesh_.section.model);
  const double dt_dnu =
      t * LogYoungsModulusSlope(PoissonRatio(), mesh_.section.model);
  DisplacementSensitivities sensitivities;
  sensitivities.log_youngs_modulus = -t * load_response_;
  sensitivities.poisson_ratio =
      (dt_dnu * load_response_ + t * load_response_derivative_).colwise() +
      support_response_derivative_;
  return sensitivities;
}

Work ForwardModel::WorkDone() const {
  Work work = solver_.WorkDone();
  work.element_passes += element_passes_;
  return work;
}

}  // namespace elastimate
