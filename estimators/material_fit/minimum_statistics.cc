#include "elastimate/estimators/material_fit/minimum_statistics.h"

#include <algorithm>
#include <cmath>

#include "elastimate/core/algebra/dense_algebra.h"
#include "elastimate/core/algebra/node_sums.h"
#include "elastimate/estimators/interface/limits.h"
#include "elastimate/estimators/interface/parameter_judge.h"
#include "elastimate/estimators/statistics/correlated_noise.h"
#include "elastimate/estimators/statistics/residual_statistics.h"

namespace elastimate {
namespace {

// The largest of stiffnesses and of ratios that a change of the variables
// makes.
Eigen::Vector2d LargestOf(const Eigen::VectorXd& change_of_variables,
                          const Eigen::VectorXd& variables,
                          const Estimate& estimate,
                          const FreeParameters& free) {
  const Eigen::VectorXd change =
      free.RelativeJacobian(variables) * change_of_variables;
  Eigen::Vector2d largest = Eigen::Vector2d::Zero();
  for (Eigen::Index i = 0; i < free.Size(); ++i) {
    const bool is_stiffness =
        estimate.parameters[free.All().Free()[i]].IsStiffness();
    double& value = largest(is_stiffness ? 0 : 1);
    if (std::abs(change(i)) > std::abs(value)) {
      value = change(i);
    }
  }
  return largest;
}

// The part of the variance of a row that the residual has: less than all only
// where more noise is given than there is, as on data that were computed.
double ShareOfResidual(const Eigen::VectorXd& residual, Eigen::Index num_fitted,
                       double variance) {
  const auto redundancy = static_cast<double>(
      std::max<Eigen::Index>(residual.size() - num_fitted, 1));
  return variance > 0
             ? std::min(1.0, SquaredNorm(residual) / redundancy / variance)
             : 1;
}

// The covariance that the correlation of the residual adds to that of
// independent noise, over the variance of a row: that of correlated noise, of
// which the residual has this share, and where the model misses something
// smooth, an error of its size along the sensitivities.
Eigen::MatrixXd AddedByCorrelation(const Scene& scene,
                                   const Eigen::VectorXd& residual,
                                   const Eigen::MatrixXd& sensitivities,
                                   const Eigen::MatrixXd& inverse,
                                   double variance, double share,
                                   double smooth_part,
                                   const ObservedDisplacements& observed,
                                   Evidence& evidence, Estimate& estimate) {
  const CorrelatedResiduals correlated =
      DescribeCorrelation(scene, observed, residual, sensitivities);
  estimate.correlation_length = correlated.length;
  const double smooth = correlated.share_of_model * smooth_part;
  evidence.smooth_part = std::sqrt(smooth) / Norm(observed.Measured());
  return share * inverse * correlated.gram * inverse +
         (variance > 0 ? smooth / variance : 0) * inverse;
}

// Weighs the resultants beside noise of this variance, rather than of what they
// were weighed beside in the fit, which is the least where data are exact.
void WeighResultants(const DisplacementMisfit& misfit, double& variance,
                     Eigen::MatrixXd& sensitivities) {
  if (misfit.NumResultants() == 0) {
    return;
  }
  variance = std::max(variance, kLeastNoise * kLeastNoise);
  sensitivities.bottomRows(misfit.NumResultants()) *=
      std::sqrt(variance) / misfit.Noise();
}

// Whether there are too few rows to know the noise from what is left of them.
bool AreTooFew(const ObservedDisplacements& observed, Eigen::Index num_fitted,
               Evidence& evidence) {
  if (observed.GivenNoise() ||
      observed.Size() - num_fitted >= kLimits.least_redundancy) {
    return false;
  }
  evidence.too_few_components = observed.Size();
  return true;
}

// By how much the variance of the resultants is more than stated.
double ExcessOfResultants(const Eigen::VectorXd& rows,
                          const DisplacementMisfit& misfit,
                          Evidence& evidence) {
  if (misfit.NumResultants() == 0) {
    return 1;
  }
  evidence.resultant_misfit = {rows.tail(misfit.NumResultants()) /
                               misfit.Noise()};
  return std::max(1.0, evidence.resultant_misfit->Excess());
}

// The variance of a row, whatever the elements miss: as given, or what is left.
double VarianceOfRows(const ObservedDisplacements& observed,
                      const Eigen::VectorXd& rows, Eigen::Index num_fitted) {
  const double given =
      observed.GivenNoise() ? 1 / (observed.Norm() * observed.Norm()) : 0;
  return std::max(
      given, SquaredNorm(rows) / static_cast<double>(std::max<Eigen::Index>(
                                     observed.Size() - num_fitted, 1)));
}

// Of the errors up to which a variable is determined, how many it has
// beforehand, and how many say that the data added nothing.
constexpr double kErrorsBeforehand = 30;
constexpr double kUnknownErrors = 15;

// S^T S with what is known beforehand, which matters for no variable that is
// determined, in rows of this variance.
Eigen::MatrixXd InformationOf(const FreeParameters& free,
                              const Eigen::MatrixXd& sensitivities,
                              double variance) {
  const Eigen::ArrayXd error =
      kErrorsBeforehand * LargestErrorsOfVariables(free).array();
  Eigen::MatrixXd information = InnerProducts(sensitivities, sensitivities);
  information.diagonal().array() += variance / error.square();
  return information;
}

// What elements miss of these rows; empty where it is not known.
std::optional<ElementErrors> FindElementErrors(
    const Scene& scene, const Eigen::VectorXd& rows,
    Eigen::MatrixXd sensitivities, const std::optional<RowChange>& change,
    Eigen::Index num_fitted, bool is_on_bound, DisplacementMisfit& misfit) {
  if (!change) {
    return std::nullopt;
  }
  const Eigen::Index num_resultants = misfit.NumResultants();
  Eigen::VectorXd residual = rows;
  RowChange weighed_change = *change;
  double variance = VarianceOfRows(misfit.Observed(), rows, num_fitted);
  if (num_resultants > 0) {
    WeighResultants(misfit, variance, sensitivities);
    const double weight = std::sqrt(variance) / misfit.Noise();
    residual.tail(num_resultants) *= weight;
    weighed_change.rows.tail(num_resultants) *= weight;
    weighed_change.by_noise.tail(num_resultants) *= weight;
  }
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(rows.size());
  const FreeFit fit = {residual,
                       sensitivities,
                       InformationOf(misfit.Free(), sensitivities, variance),
                       ones,
                       true,
                       is_on_bound};
  // What depends on the strain is of elements whose change is not known.
  const ElementErrors errors(scene, misfit.Model().Graph(), misfit.Observed(),
                             fit, weighed_change, {}, {});
  // What is not determined cannot be corrected.
  return errors.Correction()->allFinite() ? std::optional<ElementErrors>(errors)
                                          : std::nullopt;
}

// Of one isotropic material, in which either parameter may be known.
void EnterCorrection(const FreeParameters& free,
                     const Eigen::VectorXd& correction, Estimate& estimate) {
  Eigen::Vector2d of_both = Eigen::Vector2d::Zero();
  for (Eigen::Index i = 0; i < correction.size(); ++i) {
    of_both(free.All().Free()[i]) = correction(i);
  }
  estimate.discretization_correction = of_both;
  const ParameterErrors& errors = estimate.error_budget.discretization;
  if (std::isfinite(errors(0))) {
    estimate.discretization_error = errors(0);
  }
  if (std::isfinite(errors(1))) {
    estimate.poisson_ratio_discretization_error = errors(1);
  }
}

// The corrected variables, half of the way to a bound at most.
Eigen::VectorXd EnterElements(const Scene& scene, const FreeParameters& free,
                              const Eigen::VectorXd& variables,
                              const Eigen::MatrixXd& covariance,
                              const Eigen::VectorXd& correction,
                              Estimate& estimate) {
  Eigen::VectorXd corrected = variables + correction;
  for (Eigen::Index i = 0; i < corrected.size(); ++i) {
    const Bounds& bounds = free.VariableBounds()[i];
    if (bounds.lower) {
      corrected(i) = std::max(corrected(i), (variables(i) + *bounds.lower) / 2);
    }
    if (bounds.upper) {
      corrected(i) = std::min(corrected(i), (variables(i) + *bounds.upper) / 2);
    }
  }
  EnterParameters(scene, free, free.ParametersAt(corrected), estimate);
  estimate.error_budget.discretization =
      ErrorsOfVariables(free, corrected, covariance);
  if (IsOneIsotropicMaterial(scene.materials)) {
    EnterCorrection(free, corrected - variables, estimate);
  }
  return corrected;
}

// Enters what the elements change and leave uncertain, which adds to the
// covariance.
Eigen::VectorXd CorrectMinimum(const Scene& scene, const FreeParameters& free,
                               const Eigen::VectorXd& variables,
                               const ElementErrors& elements, double smooth,
                               const Eigen::MatrixXd& inverse,
                               Eigen::MatrixXd& covariance, Evidence& evidence,
                               Estimate& estimate) {
  const Eigen::MatrixXd by_elements =
      elements.CovarianceOfChange(smooth) +
      elements.MissedSquareSum(smooth) * inverse;
  covariance += by_elements;
  evidence.likely_element_change =
      LargestOf(elements.LikelyChange(), variables, estimate, free);
  return EnterElements(scene, free, variables, by_elements,
                       *elements.Correction(), estimate);
}

// Enters what outliers pull the variables by, which adds to the covariance.
void AddOutliers(const FreeParameters& free, const Eigen::VectorXd& variables,
                 const ObservedDisplacements& observed,
                 const Eigen::VectorXd& residual,
                 const Eigen::MatrixXd& sensitivities,
                 Eigen::MatrixXd& covariance, Evidence& evidence,
                 Estimate& estimate) {
  Eigen::VectorXd change = Eigen::VectorXd::Zero(free.Size());
  if (HasHeavyTails(residual)) {
    change = RobustChange(observed, residual, sensitivities);
    evidence.outlier_change = LargestOf(change, variables, estimate, free);
  }
  covariance += change * change.transpose();
  estimate.error_budget.outliers =
      ErrorsOfVariables(free, variables, change * change.transpose());
}

// Of variables that the data say nothing of, the errors are not known.
void EnterErrorsOfKnown(const FreeParameters& free, const MinimumErrors& errors,
                        Estimate& estimate) {
  const Eigen::ArrayXd limits = LargestErrorsOfVariables(free).array();
  Eigen::MatrixXd known = errors.total;
  for (Eigen::Index i = 0; i < known.cols(); ++i) {
    if (!(std::sqrt(errors.total(i, i)) < kUnknownErrors * limits(i))) {
      known.row(i).setConstant(Estimate::kUnknown);
      known.col(i).setConstant(Estimate::kUnknown);
    }
  }
  EnterCovariance(free, errors.corrected, known, estimate);
  ErrorBudget& budget = estimate.error_budget;
  for (const Eigen::Index place : free.All().Free()) {
    if (std::isfinite(estimate.parameter_covariance(place, place))) {
      continue;
    }
    for (ParameterErrors* const part :
         {&budget.noise, &budget.model, &budget.outliers,
          &budget.discretization}) {
      if (part->size() > 0) {
        (*part)(place) = Estimate::kUnknown;
      }
    }
  }
}

}  // namespace

MinimumErrors DescribeMinimum(const Scene& scene,
                              const Eigen::VectorXd& variables,
                              const std::optional<RowChange>& change_of_rows,
                              DisplacementMisfit& misfit, Evidence& evidence,
                              Estimate& estimate) {
  const FreeParameters& free = misfit.Free();
  const ObservedDisplacements& observed = misfit.Observed();
  MinimumErrors errors;
  errors.variables = variables;
  errors.corrected = variables;
  Eigen::VectorXd rows;
  Eigen::MatrixXd sensitivities;
  if (!misfit.Evaluate(variables, &rows, &sensitivities)) {
    evidence.end = End::kSingularStiffness;
    return errors;
  }
  errors.residual = rows.head(observed.Size());
  estimate.displacement_residual =
      Norm(errors.residual) / Norm(observed.Measured());
  const Eigen::Index num_fitted =
      free.Size() + misfit.NumAmounts() - misfit.NumResultants();
  if (AreTooFew(observed, num_fitted, evidence)) {
    return errors;
  }
  const double excess = ExcessOfResultants(rows, misfit, evidence);
  const std::optional<ElementErrors> elements =
      FindElementErrors(scene, rows, sensitivities, change_of_rows, num_fitted,
                        !estimate.active_bounds.empty(), misfit);
  const Eigen::VectorXd rest = elements ? elements->Rest() : rows;
  errors.residual = rest.head(observed.Size());
  ResidualVariance variance = EstimateVariance(observed, SquaredNorm(rest),
                                               num_fitted, evidence, estimate);
  WeighResultants(misfit, variance.variance, sensitivities);
  evidence.is_explained_by_given_noise = variance.is_explained_by_given_noise;
  const Eigen::MatrixXd of_rows = sensitivities.topRows(observed.Size());
  const Eigen::MatrixXd inverse =
      Inverse(InformationOf(free, sensitivities, variance.variance));
  const SmoothSquareSum smooth = MeasureSmoothPart(
      misfit.Model().Graph(), observed, errors.residual, estimate);
  const Eigen::MatrixXd by_correlation = AddedByCorrelation(
      scene, errors.residual, of_rows, inverse, variance.variance,
      ShareOfResidual(errors.residual, num_fitted, variance.variance),
      smooth.least, observed, evidence, estimate);
  const Eigen::MatrixXd by_model =
      variance.variance * (excess * by_correlation + (excess - 1) * inverse);
  errors.variance = variance.variance;
  errors.of_noise = variance.variance * inverse;
  errors.total = errors.of_noise + by_model;
  if (elements) {
    errors.corrected =
        CorrectMinimum(scene, free, variables, *elements, smooth.most, inverse,
                       errors.total, evidence, estimate);
    errors.share_of_finer = elements->Share();
  }
  estimate.error_budget.noise =
      ErrorsOfVariables(free, variables, errors.of_noise);
  estimate.error_budget.model = ErrorsOfVariables(free, variables, by_model);
  AddOutliers(free, variables, observed, errors.residual, of_rows, errors.total,
              evidence, estimate);
  if (!by_correlation.isZero(0)) {
    evidence.smooth_residual_error =
        std::sqrt(errors.total.diagonal().maxCoeff());
  }
  EnterErrorsOfKnown(free, errors, estimate);
  return errors;
}

}  // namespace elastimate
