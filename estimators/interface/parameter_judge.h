#ifndef ELASTIMATE_ESTIMATORS_INTERFACE_PARAMETER_JUDGE_H_
#define ELASTIMATE_ESTIMATORS_INTERFACE_PARAMETER_JUDGE_H_

#include <Eigen/Core>
#include <string>
#include <vector>

#include "elastimate/core/scene/scene.h"
#include "elastimate/estimators/interface/estimate.h"
#include "elastimate/estimators/interface/estimator.h"
#include "elastimate/estimators/interface/free_parameters.h"

namespace elastimate {

/// The name of a bound that an estimate lies on: "nu_max" of one material, as
/// the options have it, else as "nu of region 3 (upper)".
std::string NameOfBound(const ParameterEstimate& parameter, bool is_lower);

/// The parameters of the materials of a scene with these values, without
/// errors.
std::vector<ParameterEstimate> DescribeParameters(
    const Scene& scene, const MaterialParameters& parameters,
    const Eigen::VectorXd& values);

/// Enters all parameters with these values, without errors.
void EnterParameters(const Scene& scene, const FreeParameters& free,
                     const Eigen::VectorXd& values, Estimate& estimate);

/// Enters the covariance of the variables as that of the parameters.
void EnterCovariance(const FreeParameters& free,
                     const Eigen::VectorXd& variables,
                     const Eigen::MatrixXd& covariance, Estimate& estimate);

/// The errors of the parameters by a covariance of the variables at these, in
/// the units of the error budget.
ParameterErrors ErrorsOfVariables(const FreeParameters& free,
                                  const Eigen::VectorXd& variables,
                                  const Eigen::MatrixXd& covariance);

/// The errors up to which each variable is determined: of ln of moduli, and of
/// ratios (Limits).
Eigen::VectorXd LargestErrorsOfVariables(const FreeParameters& free);

/// For materials other than one isotropic one: enters standard errors and
/// intervals from the covariance of the parameters, and turns an estimate that
/// claims to be ok into what it is, where a parameter is not physical, not
/// determined, or biased by noise.  Where some are not determined, the errors
/// of the others stay.  Says of each of several materials how many are.
void JudgeParameters(Estimate& estimate);

/// Enters standard errors and intervals again from a covariance that has grown,
/// and judges again what is determined.
void JudgeGrownErrors(Estimate& estimate);

/// Whether most of the errors of all parameters that are not determined is what
/// the elements miss.
bool AreUndeterminedByElements(const Estimate& estimate);

/// Where the parameters are E and nu of one isotropic material: enters them,
/// their covariance and the interval of nu beside the parameters.
void EnterElasticity(Estimate& estimate);

/// Enters E and nu of one isotropic material, and their covariance, as its
/// parameters.
void EnterParametersOfElasticity(const Scene& scene,
                                 const EstimatorOptions& options,
                                 Estimate& estimate);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_INTERFACE_PARAMETER_JUDGE_H_
