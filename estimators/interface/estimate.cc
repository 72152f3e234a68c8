#include "elastimate/estimators/interface/estimate.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "elastimate/estimators/interface/limits.h"

namespace elastimate {
namespace {

std::optional<double> FiniteOrNothing(double value) {
  return std::isfinite(value) ? std::optional<double>(value) : std::nullopt;
}

template <typename Predicate>
void RemoveFindings(const Predicate& predicate,
                    std::vector<Finding>& findings) {
  findings.erase(std::remove_if(findings.begin(), findings.end(), predicate),
                 findings.end());
}

}  // namespace

std::string_view DeterminationName(Determination determination) {
  switch (determination) {
    case Determination::kDetermined:
      return "determined";
    case Determination::kWeakly:
      return "weakly";
    case Determination::kNot:
      return "not";
  }
  return "";
}

std::string ParameterEstimate::Label() const {
  if (regions.empty()) {
    return symbol;
  }
  return symbol + " of " + RegionsLabel(regions);
}

bool ParameterEstimate::IsDetermined() const {
  return is_known ||
         (standard_error &&
          *standard_error / ErrorUnit() <=
              (IsStiffness() ? kLimits.largest_youngs_modulus_error
                             : kLimits.largest_poisson_ratio_error));
}

bool ModulusEstimate::IsDetermined() const {
  return RelativeError() <= kLimits.largest_youngs_modulus_error;
}

ParameterEstimate ModulusEstimate::AsParameter() const {
  ParameterEstimate parameter;
  parameter.name = "shear_modulus";
  parameter.symbol = "mu";
  parameter.is_modulus = true;
  parameter.value = value;
  parameter.standard_error = standard_error;
  return parameter;
}

std::string RegionsLabel(const std::vector<int>& regions) {
  constexpr std::size_t kMostNamed = 3;
  const std::size_t num_named =
      regions.size() > kMostNamed ? 2 : regions.size();
  std::string ids;
  for (std::size_t i = 0; i < num_named; ++i) {
    ids += (i == 0 ? "" : ", ") + std::to_string(regions[i]);
  }
  if (num_named < regions.size()) {
    ids += " and " + std::to_string(regions.size() - num_named) + " more";
  }
  return (regions.size() == 1 ? "region " : "regions ") + ids;
}

std::string StiffnessEstimate::Label() const {
  return regions.empty() ? "the stiffness"
                         : "the stiffness of " + RegionsLabel(regions);
}

std::string AxisEstimate::Label() const {
  return regions.empty() ? "the axis" : "the axis of " + RegionsLabel(regions);
}

bool Estimate::Has(FindingCode code) const {
  return std::any_of(
      findings.begin(), findings.end(),
      [code](const Finding& finding) { return finding.code == code; });
}

bool Estimate::IsRefusedFor(FindingCode code) const {
  return std::any_of(
      findings.begin(), findings.end(), [code](const Finding& finding) {
        return finding.code == code && finding.severity == Severity::kError;
      });
}

bool Estimate::DeterminesAll() const {
  return IsUsable() &&
         std::none_of(
             findings.begin(), findings.end(), [](const Finding& finding) {
               return finding.code == FindingCode::kParametersUndetermined &&
                      finding.severity == Severity::kWarning;
             });
}

std::vector<std::string> Estimate::Sentences(Severity severity) const {
  std::vector<std::string> sentences;
  for (const Finding& finding : findings) {
    if (finding.severity == severity) {
      sentences.push_back(Sentence(finding));
    }
  }
  return sentences;
}

void Estimate::Add(const Finding& finding) {
  assert(finding.severity != Severity::kError);
  if (!Has(finding.code)) {
    findings.push_back(finding);
  }
}

void Estimate::Replace(const Finding& finding) {
  RemoveFindings(
      [&](const Finding& other) { return other.code == finding.code; },
      findings);
  Add(finding);
}

void Estimate::Accept() {
  status = Status::kOk;
  message = "";
  RemoveFindings(
      [](const Finding& finding) {
        return finding.severity == Severity::kError;
      },
      findings);
}

void Estimate::Fail(const Finding& finding) {
  assert(finding.severity == Severity::kError);
  Accept();
  RemoveFindings(
      [&](const Finding& other) { return other.code == finding.code; },
      findings);
  findings.insert(findings.begin(), finding);
  status = StatusOf(finding.code);
  message = Sentence(finding);
  covariance.setConstant(kUnknown);
  parameter_covariance.setConstant(kUnknown);
  for (ParameterEstimate& parameter : parameters) {
    parameter.standard_error.reset();
    parameter.interval.reset();
  }
  for (AxisEstimate& axis : axes) {
    axis.standard_error.reset();
  }
  shear_modulus.reset();
  error_budget.noise.resize(0);
  why_no_standard_error = "the estimate is not usable";
}

Eigen::VectorXd Estimate::ParameterValues() const {
  return Eigen::VectorXd::NullaryExpr(
      Eigen::Index(parameters.size()),
      [this](Eigen::Index i) { return parameters[i].value; });
}

std::vector<ParameterEstimate> Estimate::ParametersAndShearModulus() const {
  std::vector<ParameterEstimate> all = parameters;
  if (shear_modulus) {
    all.push_back(shear_modulus->AsParameter());
  }
  return all;
}

Eigen::MatrixXd Estimate::CovarianceWithGiven() const {
  Eigen::MatrixXd covariance_of_all = parameter_covariance;
  for (Eigen::Index i = 0; i < covariance_of_all.rows(); ++i) {
    if (parameters[i].is_known) {
      covariance_of_all.row(i).setZero();
      covariance_of_all.col(i).setZero();
    }
  }
  return covariance_of_all;
}

std::optional<double> Estimate::YoungsModulusStandardError() const {
  return FiniteOrNothing(std::sqrt(covariance(0, 0)));
}

std::optional<double> Estimate::PoissonRatioStandardError() const {
  return FiniteOrNothing(std::sqrt(covariance(1, 1)));
}

double Estimate::ShearModulus() const {
  return shear_modulus ? shear_modulus->value : elasticity.ShearModulus();
}

std::optional<double> Estimate::ShearModulusStandardError() const {
  if (shear_modulus) {
    return shear_modulus->standard_error;
  }
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
