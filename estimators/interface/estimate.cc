#include "elastimate/estimators/interface/estimate.h"

#include <cmath>
#include <utility>

namespace elastimate {
namespace {

std::optional<double> FiniteOrNothing(double value) {
  return std::isfinite(value) ? std::optional<double>(value) : std::nullopt;
}

}  // namespace

std::string_view StatusName(Status status) {
  switch (status) {
    case Status::kOk:
      return "ok";
    case Status::kNotIdentifiable:
      return "not_identifiable";
    case Status::kUnphysical:
      return "unphysical";
    case Status::kIterationLimit:
      return "iteration_limit";
    case Status::kNumericalFailure:
      break;
  }
  return "numerical_failure";
}

void Estimate::Fail(Status why_not_ok, std::string what,
                    std::string why_no_error) {
  status = why_not_ok;
  message = std::move(what);
  covariance.setConstant(kUnknown);
  why_no_standard_error = std::move(why_no_error);
}

std::optional<double> Estimate::YoungsModulusStandardError() const {
  return FiniteOrNothing(std::sqrt(covariance(0, 0)));
}

std::optional<double> Estimate::PoissonRatioStandardError() const {
  return FiniteOrNothing(std::sqrt(covariance(1, 1)));
}

std::optional<double> Estimate::ShearModulusStandardError() const {
  const Eigen::RowVector2d row = ShearAndBulkJacobian(elasticity).row(0);
  return FiniteOrNothing(std::sqrt(row * covariance * row.transpose()));
}

std::optional<double> Estimate::BulkComplianceStandardError() const {
  const Eigen::RowVector2d row = ShearAndBulkJacobian(elasticity).row(1);
  return FiniteOrNothing(std::sqrt(row * covariance * row.transpose()));
}

std::optional<double> Estimate::Correlation() const {
  return FiniteOrNothing(covariance(0, 1) /
                         std::sqrt(covariance(0, 0) * covariance(1, 1)));
}

}  // namespace elastimate
