#include "elastimate/estimators/interface/parameter_judge.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "elastimate/core/materials/isotropic_law.h"
#include "elastimate/core/text/numbers.h"
#include "elastimate/estimators/interface/axis_estimate.h"
#include "elastimate/estimators/interface/finding_sentences.h"
#include "elastimate/estimators/interface/limits.h"
#include "elastimate/estimators/interface/statistics.h"
#include "elastimate/estimators/interface/stiffness_estimate.h"

namespace elastimate {

std::string NameOfBound(const ParameterEstimate& parameter, bool is_lower) {
  if (parameter.regions.empty() && parameter.name == "youngs_modulus") {
    return is_lower ? "youngs_min" : "youngs_max";
  }
  if (parameter.regions.empty() && parameter.name == "poisson_ratio") {
    return is_lower ? "nu_min" : "nu_max";
  }
  return parameter.Label() + (is_lower ? " (lower)" : " (upper)");
}

std::vector<ParameterEstimate> DescribeParameters(
    const Scene& scene, const MaterialParameters& parameters,
    const Eigen::VectorXd& values) {
  const Eigen::VectorXd units = parameters.UnitsOfErrors(values);
  std::vector<ParameterEstimate> all;
  for (const MaterialParameters::Parameter& parameter : parameters.All()) {
    const auto place = Eigen::Index(all.size());
    ParameterEstimate estimate;
    estimate.value = values(place);
    if (parameter.law_parameter->beside) {
      estimate.beside = units(place);
    }
    estimate.name = parameter.law_parameter->name;
    estimate.symbol = parameter.law_parameter->symbol;
    estimate.is_modulus = parameter.law_parameter->is_modulus;
    estimate.is_known = parameter.known.has_value();
    // The stiffness as a whole says what is physical for other laws.
    const Law& law = parameters.LawOf(parameter.material);
    if (law.Name() == IsotropicLaw::kName || law.ForLargeStrains() != nullptr) {
      if (estimate.is_modulus) {
        estimate.limits.lower = 0;
      } else if (!estimate.beside) {
        estimate.limits = {-1, 0.5};
      }
    }
    if (!scene.materials.empty()) {
      estimate.regions = scene.materials[parameter.material].regions;
    }
    all.push_back(estimate);
  }
  return all;
}

namespace {

// J C J^T, where what is unknown or infinite of a variable stays with the
// parameters that depend on it.
Eigen::MatrixXd Transformed(const Eigen::MatrixXd& covariance,
                            const Eigen::MatrixXd& jacobian) {
  std::vector<std::vector<Eigen::Index>> variables(jacobian.rows());
  for (Eigen::Index i = 0; i < jacobian.rows(); ++i) {
    for (Eigen::Index a = 0; a < jacobian.cols(); ++a) {
      if (jacobian(i, a) != 0) {
        variables[i].push_back(a);
      }
    }
  }
  Eigen::MatrixXd transformed =
      Eigen::MatrixXd::Zero(jacobian.rows(), jacobian.rows());
  for (Eigen::Index i = 0; i < jacobian.rows(); ++i) {
    for (Eigen::Index j = 0; j < jacobian.rows(); ++j) {
      for (const Eigen::Index a : variables[i]) {
        for (const Eigen::Index b : variables[j]) {
          transformed(i, j) +=
              jacobian(i, a) * covariance(a, b) * jacobian(j, b);
        }
      }
    }
  }
  return transformed;
}

bool HasFiniteVariance(const Estimate& estimate, std::size_t place) {
  const double variance =
      estimate.parameter_covariance(Eigen::Index(place), Eigen::Index(place));
  return std::isfinite(variance) && variance >= 0;
}

bool IsDetermined(const AxisEstimate& axis, const Estimate& estimate) {
  return axis.direction &&
         (axis.standard_error || !estimate.why_no_standard_error.empty());
}

// " (+- 24 degrees)"; of an error that is small enough, or unknown, nothing.
std::string ErrorInDegrees(const AxisEstimate& axis) {
  return axis.standard_error.value_or(0) > kLimits.largest_axis_error
             ? " (+- " + TwoDigits(*axis.standard_error * kDegreesOfRadian) +
                   " degrees)"
             : "";
}

// Whether there is an axis among what is not determined, and nothing else.
bool AreAxesOnly(const Estimate& estimate) {
  bool is_axis_determined = true;
  for (std::size_t i = 0; i < estimate.parameters.size(); ++i) {
    const ParameterEstimate& parameter = estimate.parameters[i];
    if (const AxisEstimate* const axis = AxisOfParameter(estimate, i)) {
      is_axis_determined = is_axis_determined && IsDetermined(*axis, estimate);
    } else if (!parameter.is_known &&
               !(HasFiniteVariance(estimate, i) && parameter.IsDetermined())) {
      return false;
    }
  }
  return !is_axis_determined;
}

// Names those that are not determined, with their errors where these are
// finite.
std::vector<std::string> Undetermined(const Estimate& estimate) {
  std::vector<std::string> undetermined;
  for (std::size_t i = 0; i < estimate.parameters.size(); ++i) {
    const ParameterEstimate& parameter = estimate.parameters[i];
    const double error = parameter.standard_error.value_or(0);
    if (const AxisEstimate* const axis = AxisOfParameter(estimate, i)) {
      if (axis->first_rotation == i && !IsDetermined(*axis, estimate)) {
        undetermined.push_back(axis->Label() + ErrorInDegrees(*axis));
      }
      continue;
    }
    if (parameter.is_known) {
      continue;
    }
    if (!HasFiniteVariance(estimate, i)) {
      if (estimate.why_no_standard_error.empty()) {
        undetermined.push_back(parameter.Label());
      }
    } else if (!parameter.IsDetermined()) {
      // What is relative to other parameters is no share of this one.
      undetermined.push_back(
          parameter.Label() + " (" +
          (parameter.beside ? ValueWithError(parameter.value, error)
           : parameter.is_modulus
               ? "+- " + Percent(error / parameter.ErrorUnit())
               : "+- " + TwoDigits(error)) +
          ")");
    }
  }
  return undetermined;
}

bool IsOnBound(const ParameterEstimate& parameter, const Estimate& estimate) {
  const std::vector<std::string>& active = estimate.active_bounds;
  return std::any_of(active.begin(), active.end(),
                     [&](const std::string& bound) {
                       return bound == NameOfBound(parameter, true) ||
                              bound == NameOfBound(parameter, false);
                     });
}

// Tells whether E and nu are all there is.
bool IsOfElasticity(const std::vector<ParameterEstimate>& parameters) {
  return parameters.size() == 2 && parameters[0].symbol == "E" &&
         parameters[1].symbol == "nu";
}

Finding FindingOfUndetermined(const Estimate& estimate) {
  const std::vector<std::string> undetermined = Undetermined(estimate);
  if (AreAxesOnly(estimate)) {
    return AxisUndetermined(undetermined);
  }
  if (estimate.shear_modulus) {
    return ShearModulusOnly(undetermined, *estimate.shear_modulus);
  }
  const auto is_on_bound = [&](const ParameterEstimate& parameter) {
    return parameter.is_modulus && parameter.standard_error &&
           !parameter.IsDetermined() && IsOnBound(parameter, estimate);
  };
  if (std::any_of(estimate.parameters.begin(), estimate.parameters.end(),
                  is_on_bound)) {
    return ParametersUndeterminedOnBounds(undetermined);
  }
  Finding finding = AreUndeterminedByElements(estimate)
                        ? ParametersUndeterminedByElements(undetermined)
                    : IsOfElasticity(estimate.parameters)
                        ? ParametersOfOneUndetermined(undetermined)
                        : ParametersUndetermined(undetermined);
  if (estimate.Has(FindingCode::kSupportsEndWithinElements)) {
    finding.advice = "give the supports as boxes";
  }
  return finding;
}

// The errors of those that are determined stay, and of others how large they
// are.
void FailUndetermined(Estimate& estimate) {
  const std::vector<ParameterEstimate> parameters = estimate.parameters;
  const Eigen::MatrixXd covariance = estimate.parameter_covariance;
  const ParameterErrors noise = estimate.error_budget.noise;
  const std::vector<AxisEstimate> axes = estimate.axes;
  estimate.Fail(FindingOfUndetermined(estimate));
  estimate.parameters = parameters;
  estimate.parameter_covariance = covariance;
  estimate.error_budget.noise = noise;
  estimate.axes = axes;
  const auto has_error = [](const ParameterEstimate& parameter) {
    return parameter.standard_error.has_value();
  };
  if (std::any_of(parameters.begin(), parameters.end(), has_error)) {
    estimate.why_no_standard_error.clear();
  }
}

// The interval of 95 % is symmetric in the logarithm of a modulus, which is
// what is fitted, and one-sided where a ratio reaches an end of its range.
Interval IntervalOf(const ParameterEstimate& parameter,
                    const Estimate& estimate) {
  const std::optional<double>& degrees = estimate.noise_degrees_of_freedom;
  const double value = parameter.value;
  const double width = TwoSidedErrors(degrees) * *parameter.standard_error;
  if (parameter.is_modulus) {
    const double factor = std::exp(width / value);
    return {value / factor, value * factor};
  }
  const auto& [lowest, highest] = parameter.limits;
  const double one_sided = OneSidedErrors(degrees) * *parameter.standard_error;
  if (value + one_sided > highest) {
    return {std::max(lowest, value - one_sided), highest};
  }
  if (value - one_sided < lowest) {
    return {lowest, value + one_sided};
  }
  return {std::max(lowest, value - width), std::min(highest, value + width)};
}

void EnterError(std::size_t place, Estimate& estimate) {
  ParameterEstimate& parameter = estimate.parameters[place];
  const auto i = Eigen::Index(place);
  parameter.standard_error = std::sqrt(estimate.parameter_covariance(i, i));
  parameter.interval = IntervalOf(parameter, estimate);
}

// What has no finite variance is not determined, unless it is known why there
// is none.
void EnterErrors(Estimate& estimate) {
  bool are_all_finite = true;
  for (std::size_t i = 0; i < estimate.parameters.size(); ++i) {
    if (estimate.parameters[i].is_known) {
      continue;
    }
    if (HasFiniteVariance(estimate, i)) {
      EnterError(i, estimate);
    } else {
      are_all_finite = false;
    }
  }
  if (!are_all_finite && estimate.why_no_standard_error.empty()) {
    FailUndetermined(estimate);
  }
}

// Says of each of several materials how many of its parameters are determined.
void EnterDetermination(Estimate& estimate) {
  for (MaterialEstimate& material : estimate.materials) {
    int num_determined = 0;
    int num_free = 0;
    for (const ParameterEstimate& parameter : estimate.parameters) {
      if (!parameter.is_known && parameter.regions == material.regions) {
        ++num_free;
        num_determined +=
            parameter.standard_error && parameter.IsDetermined() ? 1 : 0;
      }
    }
    material.determination = num_determined == num_free
                                 ? Determination::kDetermined
                             : num_determined == 0 ? Determination::kNot
                                                   : Determination::kWeakly;
  }
}

// Enters the materials of the parameters, where they are several.
void EnterMaterials(Estimate& estimate) {
  if (!estimate.materials.empty()) {
    return;
  }
  for (const ParameterEstimate& parameter : estimate.parameters) {
    if (!parameter.regions.empty() &&
        (estimate.materials.empty() ||
         estimate.materials.back().regions != parameter.regions)) {
      MaterialEstimate material;
      material.regions = parameter.regions;
      estimate.materials.push_back(material);
    }
  }
}

void JudgePhysicsOfParameters(Estimate& estimate) {
  std::vector<std::string> unphysical;
  for (const ParameterEstimate& parameter : estimate.parameters) {
    if (!std::isfinite(parameter.value)) {
      estimate.Fail(NotFinite());
      return;
    }
    if (!parameter.IsPhysical()) {
      unphysical.push_back(parameter.Label() + " = " +
                           NumberText(parameter.value));
    }
  }
  for (const StiffnessEstimate& stiffness : estimate.stiffnesses) {
    if (!IsPositiveDefinite(stiffness)) {
      unphysical.push_back(stiffness.Label() + " (not positive definite)");
    }
  }
  if (!unphysical.empty()) {
    estimate.Fail(
        UnphysicalParameters(unphysical, !estimate.displacement_residual));
  }
}

// Whether a modulus is determined, a parameter or the shear modulus, and the
// errors of all other parameters are finite.  An undetermined axis, or a
// parameter on a bound, makes all parameters doubtful.
bool AreSomeDetermined(const Estimate& estimate) {
  bool are_some = estimate.shear_modulus.has_value();
  for (std::size_t i = 0; i < estimate.parameters.size(); ++i) {
    const ParameterEstimate& parameter = estimate.parameters[i];
    if (const AxisEstimate* const axis = AxisOfParameter(estimate, i)) {
      if (!IsDetermined(*axis, estimate)) {
        return false;
      }
    } else if (!parameter.is_known) {
      if (!HasFiniteVariance(estimate, i) || IsOnBound(parameter, estimate)) {
        return false;
      }
      are_some = are_some || (parameter.is_modulus && parameter.IsDetermined());
    }
  }
  return are_some;
}

void JudgeDeterminationOfParameters(Estimate& estimate) {
  if (Undetermined(estimate).empty()) {
    return;
  }
  if (AreSomeDetermined(estimate)) {
    Finding finding = FindingOfUndetermined(estimate);
    finding.severity = Severity::kWarning;
    estimate.Replace(finding);
  } else {
    FailUndetermined(estimate);
  }
}

// Next to the ends of the range of nu, a linear model says little of its error.
void JudgeNearnessOfLimits(Estimate& estimate) {
  std::vector<std::string> near;
  for (const ParameterEstimate& parameter : estimate.parameters) {
    if (!parameter.IsStiffness() && parameter.interval &&
        !(parameter.interval->lower > parameter.limits.lower &&
          parameter.interval->upper < parameter.limits.upper)) {
      near.push_back(parameter.Label());
    }
  }
  if (near.empty()) {
    return;
  }
  // The balance of virtual work has spurious minima there.  A series has left
  // out frames that ended in one.
  if (estimate.displacement_residual || estimate.series) {
    estimate.Add(ParametersNearLimits(near, Severity::kWarning));
  } else {
    estimate.Fail(ParametersNearLimits(near, Severity::kError));
  }
}

// The parameter whose bias exceeds its limit by most decides.
void JudgeBiasOfParameters(Estimate& estimate) {
  const ParameterErrors bias = estimate.error_budget.bias;
  const ParameterErrors& noise = estimate.error_budget.noise;
  double largest = 0;
  std::optional<Finding> finding;
  for (Eigen::Index i = 0; i < bias.size(); ++i) {
    const ParameterEstimate& parameter = estimate.parameters[i];
    const double unusable = parameter.IsStiffness()
                                ? kLimits.unusable_error
                                : kLimits.unusable_poisson_ratio_bias;
    const double notable = parameter.IsStiffness()
                               ? kLimits.notable_youngs_modulus_error
                               : kLimits.notable_poisson_ratio_error;
    if (bias(i) > std::max(notable, noise(i)) && bias(i) / unusable > largest) {
      largest = bias(i) / unusable;
      finding = ParameterBias(
          parameter.Label(), bias(i), parameter.IsStiffness(),
          bias(i) > unusable ? Severity::kError : Severity::kWarning);
    }
  }
  if (!finding) {
    return;
  }
  if (finding->severity == Severity::kError) {
    estimate.Fail(*finding);
  } else {
    estimate.Add(*finding);
  }
}

}  // namespace

void EnterParameters(const Scene& scene, const FreeParameters& free,
                     const Eigen::VectorXd& values, Estimate& estimate) {
  estimate.element_order = scene.mesh.Order();
  estimate.parameters = DescribeParameters(scene, free.All(), values);
  estimate.parameter_covariance.setConstant(values.size(), values.size(),
                                            Estimate::kUnknown);
}

void EnterCovariance(const FreeParameters& free,
                     const Eigen::VectorXd& variables,
                     const Eigen::MatrixXd& covariance, Estimate& estimate) {
  estimate.parameter_covariance(free.All().Free(), free.All().Free()) =
      Transformed(covariance, free.ParameterJacobian(variables));
}

ParameterErrors ErrorsOfVariables(const FreeParameters& free,
                                  const Eigen::VectorXd& variables,
                                  const Eigen::MatrixXd& covariance) {
  ParameterErrors errors =
      ParameterErrors::Constant(free.All().NumParameters(), Estimate::kUnknown);
  errors(free.All().Free()) =
      Transformed(covariance, free.RelativeJacobian(variables))
          .diagonal()
          .cwiseSqrt();
  return errors;
}

Eigen::VectorXd LargestErrorsOfVariables(const FreeParameters& free) {
  Eigen::VectorXd errors(free.Size());
  for (Eigen::Index i = 0; i < errors.size(); ++i) {
    const LawParameter& parameter = *free.Free(i).law_parameter;
    errors(i) = parameter.is_modulus || parameter.beside
                    ? kLimits.largest_youngs_modulus_error
                    : kLimits.largest_poisson_ratio_error;
  }
  return errors;
}

bool AreUndeterminedByElements(const Estimate& estimate) {
  constexpr double kMostOfVariance = 0.5;
  const ParameterErrors& missed = estimate.error_budget.discretization;
  if (missed.size() != Eigen::Index(estimate.parameters.size())) {
    return false;
  }
  bool is_any_undetermined = false;
  for (std::size_t i = 0; i < estimate.parameters.size(); ++i) {
    const ParameterEstimate& parameter = estimate.parameters[i];
    if (!parameter.standard_error || parameter.IsDetermined()) {
      continue;
    }
    const double error = *parameter.standard_error / parameter.ErrorUnit();
    if (!(std::pow(missed(Eigen::Index(i)) / error, 2) > kMostOfVariance)) {
      return false;
    }
    is_any_undetermined = true;
  }
  return is_any_undetermined;
}

void JudgeParameters(Estimate& estimate) {
  EnterMaterials(estimate);
  for (const auto& judge :
       {JudgePhysicsOfParameters, EnterErrors, JudgeBiasOfParameters,
        JudgeDeterminationOfParameters, JudgeNearnessOfLimits}) {
    if (estimate.IsUsable()) {
      judge(estimate);
    }
  }
  if (estimate.IsUsable() ||
      estimate.IsRefusedFor(FindingCode::kParametersUndetermined)) {
    EnterDetermination(estimate);
  }
}

void JudgeGrownErrors(Estimate& estimate) {
  for (std::size_t i = 0; i < estimate.parameters.size(); ++i) {
    if (estimate.parameters[i].standard_error) {
      EnterError(i, estimate);
    }
  }
  if (estimate.IsUsable()) {
    JudgeDeterminationOfParameters(estimate);
  }
  EnterDetermination(estimate);
}

void EnterElasticity(Estimate& estimate) {
  const std::vector<ParameterEstimate>& parameters = estimate.parameters;
  if (!IsOfElasticity(parameters)) {
    return;
  }
  estimate.elasticity = {parameters[0].value, parameters[1].value};
  if (estimate.parameter_covariance.size() != 0) {
    estimate.covariance = estimate.parameter_covariance;
  }
  if (parameters[1].interval) {
    estimate.poisson_ratio_interval = parameters[1].interval;
  }
}

void EnterParametersOfElasticity(const Scene& scene,
                                 const EstimatorOptions& options,
                                 Estimate& estimate) {
  estimate.parameters =
      DescribeParameters(scene, FreeParameters(scene, options).All(),
                         Eigen::Vector2d(estimate.elasticity.youngs_modulus,
                                         estimate.elasticity.poisson_ratio));
  estimate.parameter_covariance = estimate.covariance;
}

}  // namespace elastimate
