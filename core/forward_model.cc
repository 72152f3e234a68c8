#include "elastimate/core/forward_model.h"

#include <cassert>
#include <limits>
#include <stdexcept>

#include "elastimate/core/stiffness_product.h"

namespace elastimate {

ForwardModel::ForwardModel(const Mesh& mesh, const Supports& supports,
                           const Eigen::MatrixXd& force)
    : mesh_(mesh),
      degrees_of_freedom_(supports),
      force_(force),
      held_displacement_(HeldDisplacement(supports)),
      has_held_displacement_(!held_displacement_.isZero(0)),
      poisson_ratio_(std::numeric_limits<double>::quiet_NaN()) {
  const std::string why_not_held = WhyNotHeld(mesh, supports);
  if (!why_not_held.empty()) {
    throw std::invalid_argument(why_not_held);
  }
  assembly_ = std::make_unique<StiffnessAssembly>(mesh, degrees_of_freedom_);
  ++work_.element_passes;
  cholesky_ = std::make_unique<Cholesky>(*assembly_, degrees_of_freedom_);
  support_response_ = held_displacement_;
  support_response_derivative_ =
      Eigen::VectorXd::Zero(held_displacement_.size());
  if (has_held_displacement_) {
    const StiffnessProducts products =
        MultiplyStiffnessBasis(mesh, held_displacement_);
    ++work_.element_passes;
    held_h_ = products.h;
    held_j_ = products.j;
  }
}

Eigen::MatrixXd ForwardModel::SolveFree(const Eigen::MatrixXd& all) {
  work_.solves += static_cast<int>(all.cols());
  return degrees_of_freedom_.Extend(
      cholesky_->Solve(degrees_of_freedom_.Restrict(all)));
}

bool ForwardModel::SetPoissonRatio(double poisson_ratio) {
  if (poisson_ratio == poisson_ratio_) {
    return true;
  }
  poisson_ratio_ = std::numeric_limits<double>::quiet_NaN();
  has_derivatives_ = false;
  if (!(poisson_ratio > -1 && poisson_ratio < 0.5)) {
    return false;
  }
  ++work_.factorizations;
  if (!cholesky_->Factorize(assembly_->Combine(poisson_ratio))) {
    return false;
  }
  load_response_ = SolveFree(force_);
  if (has_held_displacement_) {
    support_response_ =
        held_displacement_ - SolveFree(held_h_ + poisson_ratio * held_j_);
  }
  poisson_ratio_ = poisson_ratio;
  return true;
}

Eigen::MatrixXd ForwardModel::Displacement(double youngs_modulus) const {
  const double compliance_scale =
      IsotropicElasticity{youngs_modulus, poisson_ratio_}.ComplianceScale();
  return (compliance_scale * load_response_).colwise() + support_response_;
}

DisplacementSensitivities ForwardModel::Sensitivities(double youngs_modulus) {
  assert(poisson_ratio_ == poisson_ratio_);
  if (!has_derivatives_) {
    Eigen::MatrixXd responses = load_response_;
    if (has_held_displacement_) {
      responses.conservativeResize(Eigen::NoChange, responses.cols() + 1);
      responses.rightCols<1>() = support_response_;
    }
    ++work_.element_passes;
    responses = -SolveFree(MultiplyStiffnessBasis(mesh_, responses).j);
    load_response_derivative_ = responses.leftCols(load_response_.cols());
    if (has_held_displacement_) {
      support_response_derivative_ = responses.rightCols<1>();
    }
    has_derivatives_ = true;
  }
  const double t =
      IsotropicElasticity{youngs_modulus, poisson_ratio_}.ComplianceScale();
  const double dt_dnu = -(1 + 4 * poisson_ratio_) / youngs_modulus;
  DisplacementSensitivities sensitivities;
  sensitivities.log_youngs_modulus = -t * load_response_;
  sensitivities.poisson_ratio =
      (dt_dnu * load_response_ + t * load_response_derivative_).colwise() +
      support_response_derivative_;
  return sensitivities;
}

}  // namespace elastimate
