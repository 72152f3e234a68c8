#include "elastimate/estimators/interface/parameter_judge.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>
#include <vector>

#include "elastimate/estimators/interface/finding_sentences.h"
#include "elastimate/estimators/interface/limits.h"
#include "elastimate/estimators/interface/statistics.h"
#include "elastimate/estimators/interface/stiffness_estimate.h"

namespace elastimate {
std::vector<ParameterEstimate> ParametersWithoutValues(
    const Scene& scene, const MaterialParameters& parameters) {
  std::vector<ParameterEstimate> all;
  for (const MaterialParameters::Parameter& parameter : parameters.All()) {
    ParameterEstimate estimate;
    estimate.name = parameter.law_parameter->name;
    estimate.symbol = parameter.law_parameter->symbol;
    estimate.is_modulus = parameter.law_parameter->is_modulus;
    estimate.is_known = parameter.known.has_value();
    // Of other laws the stiffness as a whole says what is physical.
    if (parameters.LawOf(parameter.material).BlockEntries().empty()) {
      estimate.limits = estimate.is_modulus ? Interval{0, estimate.limits.upper}
                                            : Interval{-1, 0.5};
    }
    if (!scene.materials.empty()) {
      estimate.regions = scene.materials[parameter.material].regions;
    }
    all.push_back(estimate);
  }
  return all;
}

namespace {

// J C J^T, where what is infinite of one variable stays with that.
Eigen::MatrixXd Transformed(const Eigen::MatrixXd& covariance,
                            const Eigen::MatrixXd& jacobian) {
  if (jacobian.isDiagonal(0)) {
    return jacobian.diagonal().asDiagonal() * covariance *
           jacobian.diagonal().asDiagonal();
  }
  return jacobian * covariance * jacobian.transpose();
}

// What has no finite variance is not determined, unless it is known why there
// is none.
void EnterErrors(Estimate& estimate) {
  std::vector<std::string> undetermined;
  for (std::size_t i = 0; i < estimate.parameters.size(); ++i) {
    const double variance =
        estimate.parameter_covariance(Eigen::Index(i), Eigen::Index(i));
    if (!estimate.parameters[i].is_known &&
        !(std::isfinite(variance) && variance >= 0)) {
      undetermined.push_back(estimate.parameters[i].Label());
    } else if (!estimate.parameters[i].is_known) {
      ParameterEstimate& parameter = estimate.parameters[i];
      const double error = std::sqrt(variance);
      parameter.standard_error = error;
      const double width =
          TwoSidedErrors(estimate.noise_degrees_of_freedom) * error;
      parameter.interval = {parameter.value - width, parameter.value + width};
      if (parameter.is_modulus) {
        // Symmetric in the logarithm, which is what is fitted.
        const double factor = std::exp(width / parameter.value);
        parameter.interval = {parameter.value / factor,
                              parameter.value * factor};
      }
    }
  }
  if (!undetermined.empty() && estimate.why_no_standard_error.empty()) {
    estimate.Fail(ParametersUndetermined(undetermined));
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
      std::ostringstream text;
      text << parameter.Label() << " = " << parameter.value;
      unphysical.push_back(text.str());
    }
  }
  for (const StiffnessEstimate& stiffness : estimate.stiffnesses) {
    if (!IsPositiveDefinite(stiffness)) {
      unphysical.push_back(stiffness.Label() + " (not positive definite)");
    }
  }
  if (!unphysical.empty()) {
    estimate.Fail(UnphysicalParameters(unphysical));
  }
}

void JudgeDeterminationOfParameters(Estimate& estimate) {
  std::vector<std::string> undetermined;
  for (const ParameterEstimate& parameter : estimate.parameters) {
    const double error = parameter.standard_error.value_or(0);
    const double relative = error / parameter.ErrorUnit();
    if (parameter.IsStiffness() &&
        relative > kLimits.largest_youngs_modulus_error) {
      undetermined.push_back(parameter.Label() + " (" +
                             TwoDigits(100 * relative) + " %)");
    } else if (!parameter.IsStiffness() &&
               error > kLimits.largest_poisson_ratio_error) {
      undetermined.push_back(parameter.Label() + " (" + TwoDigits(error) + ")");
    }
  }
  if (!undetermined.empty()) {
    estimate.Fail(ParametersUndetermined(undetermined));
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
  // The balance of virtual work has spurious minima there.
  if (estimate.displacement_residual) {
    estimate.Add(ParametersNearLimits(near, Severity::kWarning));
  } else {
    estimate.Fail(ParametersNearLimits(near, Severity::kError));
  }
}

// Of the parameter whose bias exceeds its limit by most.
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
  estimate.parameters = ParametersWithoutValues(scene, free.All());
  const Eigen::VectorXd units = free.All().UnitsOfErrors(values);
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    estimate.parameters[i].value = values(i);
    if (free.All().All()[i].law_parameter->beside) {
      estimate.parameters[i].beside = units(i);
    }
  }
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

void JudgeParameters(Estimate& estimate) {
  for (const auto& judge :
       {JudgePhysicsOfParameters, EnterErrors, JudgeBiasOfParameters,
        JudgeDeterminationOfParameters, JudgeNearnessOfLimits}) {
    if (estimate.IsUsable()) {
      judge(estimate);
    }
  }
}

void DescribeOneIsotropicMaterial(const Scene& scene,
                                  const EstimatorOptions& options,
                                  Estimate& estimate) {
  estimate.parameters = ParametersWithoutValues(
      scene, MaterialParameters(scene.materials, scene.mesh.section.model));
  estimate.parameter_covariance = estimate.covariance;
  ParameterEstimate& youngs_modulus = estimate.parameters[0];
  ParameterEstimate& poisson_ratio = estimate.parameters[1];
  youngs_modulus.value = estimate.elasticity.youngs_modulus;
  youngs_modulus.standard_error = estimate.YoungsModulusStandardError();
  if (youngs_modulus.standard_error) {
    const double width = TwoSidedErrors(estimate.noise_degrees_of_freedom) *
                         *youngs_modulus.standard_error;
    youngs_modulus.interval = {youngs_modulus.value - width,
                               youngs_modulus.value + width};
  }
  poisson_ratio.value = estimate.elasticity.poisson_ratio;
  poisson_ratio.is_known = options.known_poisson_ratio.has_value();
  poisson_ratio.standard_error = estimate.PoissonRatioStandardError();
  poisson_ratio.interval = estimate.poisson_ratio_interval;
}

}  // namespace elastimate
