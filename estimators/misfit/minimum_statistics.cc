#include "elastimate/estimators/misfit/minimum_statistics.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "elastimate/core/algebra/dense_algebra.h"
#include "elastimate/core/algebra/node_sums.h"
#include "elastimate/estimators/interface/limits.h"
#include "elastimate/estimators/interface/parameter_judge.h"
#include "elastimate/estimators/misfit/across_range.h"
#include "elastimate/estimators/misfit/axis_rotation.h"
#include "elastimate/estimators/misfit/curvature.h"
#include "elastimate/estimators/misfit/mesh_error.h"
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
  evidence.smooth_part =
      std::sqrt(smooth) / Norm(observed.MeasuredWithoutTurn());
  return share * inverse * correlated.gram * inverse +
         (variance > 0 ? smooth / variance : 0) * inverse;
}

// The square sum whose mean is the variance that (S^T S)^-1 has as a factor. By
// a loss the rows r count by psi(r) = w r, and the rows and S are multiplied by
// the root of w [Street, Carroll & Ruppert, Am. Stat. 42 (1988) 152].
double SquareSumOfNoise(const Eigen::VectorXd& rows,
                        const DisplacementMisfit::Weights& weights) {
  const Eigen::VectorXd& factors = weights.factors;
  return factors.size() == 0 ? SquaredNorm(rows)
                             : SquaredNorm(factors.cwiseProduct(rows)) *
                                   factors.array().square().mean() /
                                   (weights.mean_slope * weights.mean_slope);
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

// A variable has so many of the errors up to which it counts as determined
// beforehand, and so many say that the data added nothing.
constexpr double kErrorsBeforehand = 30;
constexpr double kUnknownErrors = 15;

// What is known beforehand, which without bounds matters for no variable that
// is determined, beside S^T S in rows of this variance.
Eigen::VectorXd KnownBeforehand(const FreeParameters& free,
                                const Eigen::VectorXd& variables,
                                double variance) {
  return variance / (kErrorsBeforehand * LargestErrorsOfVariables(free))
                        .cwiseMin(free.ErrorsByBounds(variables))
                        .array()
                        .square();
}

// What rows say of the variables, with what is known beforehand.
struct InverseInformation {
  /// The inverse of S^T S; without the combinations below.
  Eigen::MatrixXd inverse;
  /// Combinations that the rows say nothing of, up to rounding, as columns, and
  /// their covariance by what is known beforehand.
  Eigen::MatrixXd free_combinations;
  Eigen::MatrixXd of_free_combinations;
};

InverseInformation InvertInformation(const FreeParameters& free,
                                     const Eigen::VectorXd& variables,
                                     const Eigen::MatrixXd& sensitivities,
                                     double variance) {
  // The sine of the angle between columns below which rounding decides, which
  // comes from the square root of a difference.
  constexpr double kCollinear = 1e-6;
  // This stands for the norm of a column of zeros, and has a square.
  constexpr double kSmallest = 1e-150;
  const Eigen::Index n = free.Size();
  const Eigen::VectorXd scale =
      sensitivities.colwise().norm().cwiseMax(kSmallest).cwiseInverse();
  const Eigen::MatrixXd gram = InnerProducts(sensitivities, sensitivities);
  const SymmetricEigenDecomposition modes =
      DecomposeSymmetric(scale.asDiagonal() * gram * scale.asDiagonal());
  const Eigen::Index num_free =
      (modes.values.array() < kCollinear * kCollinear).count();
  InverseInformation information;
  information.free_combinations =
      scale.asDiagonal() * modes.vectors.leftCols(num_free);
  information.free_combinations.colwise().normalize();
  information.of_free_combinations.setZero(n, n);
  if (num_free == 0) {
    Eigen::MatrixXd known = gram;
    known.diagonal() += KnownBeforehand(free, variables, variance);
    information.inverse = Inverse(known);
    return information;
  }
  const Eigen::MatrixXd determined =
      scale.asDiagonal() * modes.vectors.rightCols(n - num_free);
  information.inverse =
      determined * modes.values.tail(n - num_free).cwiseInverse().asDiagonal() *
      determined.transpose();
  const Eigen::MatrixXd& combinations = information.free_combinations;
  information.of_free_combinations =
      combinations *
      Inverse(combinations.transpose() *
              KnownBeforehand(free, variables, 1).asDiagonal() * combinations) *
      combinations.transpose();
  return information;
}

// Notes what the rows of one isotropic material leave free, where what is known
// beforehand does not determine it.
void NoteFreeDirection(const Scene& scene, const FreeParameters& free,
                       const InverseInformation& information,
                       const Eigen::VectorXd& variables, Evidence& evidence) {
  const Eigen::MatrixXd& free_combinations = information.free_combinations;
  const Eigen::VectorXd parameters = free.ParametersAt(variables);
  if (HasPriors(scene.materials) || free_combinations.cols() != 1 ||
      free.Size() != 2 || parameters.size() != 2 ||
      !(information.of_free_combinations.diagonal().cwiseSqrt().array() >
        LargestErrorsOfVariables(free).array())
           .any()) {
    return;
  }
  evidence.free_direction = {{parameters(0), parameters(1)},
                             free_combinations.col(0)};
}

// Notes by how much a bound on a stiffness is contradicted: the rows r + S d
// are least without it.
void NoteBoundExcess(const FreeParameters& free, const BoundedMinimum& minimum,
                     const Eigen::VectorXd& rows,
                     const Eigen::MatrixXd& sensitivities,
                     const Eigen::MatrixXd& inverse, const Estimate& estimate,
                     Evidence& evidence) {
  const Eigen::VectorXd change = -inverse * InnerProducts(sensitivities, rows);
  const double least = SquaredNorm(rows + sensitivities * change);
  double largest = 0;
  for (Eigen::Index i = 0; i < free.Size(); ++i) {
    const ParameterEstimate& parameter =
        estimate.parameters[free.All().Free()[i]];
    if (minimum.on_bound[i] != Side::kNone && parameter.is_modulus &&
        std::abs(change(i)) > largest) {
      largest = std::abs(change(i));
      evidence.bound_excess = {SquaredNorm(rows) - least,
                               least / static_cast<double>(rows.size()),
                               parameter.value * std::exp(change(i)),
                               parameter.value, parameter.Label()};
    }
  }
}

// The angle between the sensitivities to ln E and to nu.
void EnterIdentifiabilityAngle(const FreeParameters& free,
                               const Eigen::MatrixXd& of_rows,
                               Estimate& estimate) {
  if (free.Size() == 2 && estimate.parameters.size() == 2) {
    const double cosine =
        std::abs(InnerProduct(of_rows.col(0), of_rows.col(1)));
    const double square =
        SquaredNorm(of_rows.col(0)) * SquaredNorm(of_rows.col(1));
    estimate.identifiability_angle =
        std::atan2(std::sqrt(std::max(0.0, square - cosine * cosine)), cosine);
  }
}

// Enters the correction of one isotropic material, in which either parameter
// may be known.
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

// Half of the way to a bound at most.
Eigen::VectorXd Corrected(const FreeParameters& free,
                          const Eigen::VectorXd& variables,
                          const Eigen::VectorXd& correction) {
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
  return corrected;
}

void EnterElements(const Scene& scene, const FreeParameters& free,
                   const MinimumErrors& errors,
                   const Eigen::MatrixXd& by_elements, Estimate& estimate) {
  EnterParameters(scene, free, free.ParametersAt(errors.corrected), estimate);
  estimate.uncorrected_parameters = free.ParametersAt(errors.variables);
  estimate.error_budget.discretization =
      ErrorsOfVariables(free, errors.corrected, by_elements);
  if (IsOneIsotropicMaterial(scene.materials)) {
    EnterCorrection(free, errors.corrected - errors.variables, estimate);
  }
}

// Corrects the minimum for the mesh error, which adds to the covariance.
void AddMeshError(const Scene& scene, const SpaceChange& change,
                  const Eigen::MatrixXd& sensitivities,
                  const Eigen::MatrixXd& inverse,
                  const DisplacementMisfit& misfit, Evidence& evidence,
                  MinimumErrors& errors, Estimate& estimate) {
  const FreeParameters& free = misfit.Free();
  SpaceChange weighed = change;
  if (misfit.NumResultants() > 0) {
    weighed.rows.tail(misfit.NumResultants()) *=
        std::sqrt(errors.variance) / misfit.Noise();
  }
  const MeshError mesh = MeshErrorOf(weighed, free, sensitivities, inverse,
                                     misfit.Observed().Size());
  errors.corrected = Corrected(free, errors.variables, mesh.correction);
  errors.of_mesh = mesh.covariance;
  errors.total += mesh.covariance;
  if (change.by_supports.size() != 0) {
    evidence.support_errors =
        ErrorsOfVariables(free, errors.corrected, mesh.of_supports);
  }
  EnterElements(scene, free, errors, mesh.covariance, estimate);
}

// Enters what outliers pull the variables by, which adds to the covariance.
// `residual` are the displacements of a minimum of all rows, those of
// `sensitivities` and of what is known beforehand.
void AddOutliers(const FreeParameters& free, const Eigen::VectorXd& variables,
                 const ObservedDisplacements& observed,
                 const Eigen::VectorXd& residual,
                 const Eigen::MatrixXd& sensitivities,
                 const Eigen::VectorXd& known_beforehand,
                 Eigen::MatrixXd& covariance, Evidence& evidence,
                 Estimate& estimate) {
  Eigen::VectorXd change = Eigen::VectorXd::Zero(free.Size());
  // What is left of exact displacements is rounding, which has no outliers.
  if (Norm(residual) >
          kLimits.exact_residual * Norm(observed.MeasuredWithoutTurn()) &&
      HasHeavyTails(residual)) {
    const Eigen::Index size = sensitivities.rows() + free.Size();
    Eigen::MatrixXd all(size, free.Size());
    all << sensitivities,
        Eigen::MatrixXd(known_beforehand.cwiseSqrt().asDiagonal());
    // At a minimum, the gradient of the other rows is that of the displacements
    // with its sign changed.
    const Eigen::Index num_others = size - residual.size();
    const Eigen::VectorXd of_others = -SolveLeastSquares(
        all.bottomRows(num_others).transpose(),
        InnerProducts(all.topRows(residual.size()), residual));
    Eigen::VectorXd left(size);
    left << residual, of_others;
    change = RobustChange(observed, left, all);
    evidence.outlier_change = LargestOf(change, variables, estimate, free);
  }
  covariance += change * change.transpose();
  estimate.error_budget.outliers =
      ErrorsOfVariables(free, variables, change * change.transpose());
}

// Enters what a rotation of the given axes would change, which adds to the
// covariance as far as it is more than chance.
void AddAxisRotation(const Scene& scene, const Eigen::VectorXd& variables,
                     const Eigen::VectorXd& rows,
                     const Eigen::MatrixXd& sensitivities,
                     const Eigen::MatrixXd& inverse, DisplacementMisfit& misfit,
                     MinimumErrors& errors, Evidence& evidence,
                     Estimate& estimate) {
  const std::optional<double> given =
      misfit.Observed().GivenNoise() ? std::optional<double>(errors.variance)
                                     : std::nullopt;
  const std::optional<AxisRotation> rotation = FindAxisRotation(
      scene, variables, rows, sensitivities, inverse, given, misfit);
  if (!rotation) {
    return;
  }
  const FreeParameters& free = misfit.Free();
  const Eigen::Vector2d largest =
      LargestOf(rotation->change, variables, estimate, free);
  const Eigen::ArrayXd by_noise = errors.of_noise.diagonal().array().sqrt();
  evidence.axis_turn = {
      rotation->angle,
      scene.materials.size() == 1
          ? ""
          : RegionsLabel(scene.materials[rotation->material].regions),
      rotation->Probability(), largest.cwiseAbs().maxCoeff(),
      (rotation->change.array().abs() / by_noise).maxCoeff()};
  const Eigen::MatrixXd added = rotation->BeyondChance() * rotation->change *
                                rotation->change.transpose();
  errors.total += added;
  const ParameterErrors of_axes = ErrorsOfVariables(free, variables, added);
  ParameterErrors& model = estimate.error_budget.model;
  model = (model.array().square() + of_axes.array().square()).sqrt();
}

// Adds the distance to the minimum of another model that may be the right one,
// as an error of the elements.
void AddOtherModel(const BoundedMinimum& found, const FreeParameters& free,
                   MinimumErrors& errors, Estimate& estimate) {
  const Eigen::VectorXd distance = found.of_other_model - found.variables;
  const Eigen::MatrixXd added = distance * distance.transpose();
  errors.total += added;
  const ParameterErrors of_model =
      ErrorsOfVariables(free, errors.variables, added);
  ParameterErrors& mesh = estimate.error_budget.discretization;
  mesh = mesh.size() == 0
             ? of_model
             : ParameterErrors(
                   (mesh.array().square() + of_model.array().square()).sqrt());
}

// Where resultants are weighed in the rows, these are not those of the misfit.
void AddCurvature(const CurvedMisfit& curved, MinimumErrors& errors,
                  Estimate& estimate) {
  if (curved.misfit.NumResultants() > 0) {
    return;
  }
  const FreeParameters& free = curved.misfit.Free();
  Eigen::MatrixXd added = CovarianceOfCurvature(
      curved.minimum, errors.total,
      KnownBeforehand(free, errors.variables, errors.variance), curved.misfit);
  added +=
      CovarianceAcrossRange(errors.corrected, errors.total + added,
                            errors.variance, curved.minimum, curved.misfit);
  errors.total += added;
  estimate.error_budget.curvature =
      ErrorsOfVariables(free, errors.corrected, added);
}

// A minimum, the rows of the misfit there, and their derivatives S.
struct Minimum {
  const BoundedMinimum& found;
  Eigen::VectorXd rows;
  Eigen::MatrixXd sensitivities;
};

// The errors of variables that the data say nothing of are not known, unless
// priors may say something.
void EnterErrorsOfKnown(const Scene& scene, const FreeParameters& free,
                        const MinimumErrors& errors, Estimate& estimate) {
  if (HasPriors(scene.materials)) {
    EnterCovariance(free, errors.corrected, errors.total, estimate);
    return;
  }
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
          &budget.discretization, &budget.curvature}) {
      if (part->size() > 0) {
        (*part)(place) = Estimate::kUnknown;
      }
    }
  }
}

// What is known of the minimum.
MinimumErrors Describe(const Scene& scene, const Minimum& minimum,
                       const SpaceChange* change, const CurvedMisfit* curved,
                       DisplacementMisfit& misfit, Evidence& evidence,
                       Estimate& estimate) {
  const FreeParameters& free = misfit.Free();
  const ObservedDisplacements& observed = misfit.Observed();
  const Eigen::VectorXd& rows = minimum.rows;
  Eigen::MatrixXd sensitivities = minimum.sensitivities;
  MinimumErrors errors;
  errors.variables = minimum.found.variables;
  errors.corrected = errors.variables;
  errors.residual = rows.head(observed.Size());
  estimate.displacement_residual =
      Norm(errors.residual) / Norm(observed.MeasuredWithoutTurn());
  const Eigen::Index num_fitted =
      free.Size() + misfit.NumAmounts() - misfit.NumResultants();
  if (AreTooFew(observed, num_fitted, evidence)) {
    return errors;
  }
  const double excess = ExcessOfResultants(rows, misfit, evidence);
  ResidualVariance variance =
      EstimateVariance(observed, SquareSumOfNoise(rows, misfit.RowWeights()),
                       num_fitted, evidence, estimate);
  WeighResultants(misfit, variance.variance, sensitivities);
  evidence.is_explained_by_given_noise = variance.is_explained_by_given_noise;
  const Eigen::MatrixXd of_rows = sensitivities.topRows(observed.Size());
  const InverseInformation information = InvertInformation(
      free, errors.variables, sensitivities, variance.variance);
  const Eigen::MatrixXd& inverse = information.inverse;
  NoteFreeDirection(scene, free, information, errors.variables, evidence);
  NoteBoundExcess(free, minimum.found, rows, sensitivities, inverse, estimate,
                  evidence);
  EnterIdentifiabilityAngle(free, of_rows, estimate);
  const SmoothSquareSum smooth = MeasureSmoothPart(
      misfit.Neighbours(), observed, errors.residual, estimate);
  const Eigen::MatrixXd by_correlation = AddedByCorrelation(
      scene, errors.residual, of_rows, inverse, variance.variance,
      ShareOfResidual(errors.residual, num_fitted, variance.variance),
      smooth.least, observed, evidence, estimate);
  const Eigen::MatrixXd by_model =
      variance.variance * (excess * by_correlation + (excess - 1) * inverse);
  errors.variance = variance.variance;
  errors.of_noise =
      variance.variance * inverse + information.of_free_combinations;
  errors.total = errors.of_noise + by_model;
  if (change != nullptr) {
    AddMeshError(scene, *change, sensitivities, inverse, misfit, evidence,
                 errors, estimate);
  }
  if (minimum.found.of_other_model.size() != 0) {
    AddOtherModel(minimum.found, free, errors, estimate);
  }
  estimate.error_budget.noise =
      ErrorsOfVariables(free, errors.variables, errors.of_noise);
  estimate.error_budget.model =
      ErrorsOfVariables(free, errors.variables, by_model);
  AddOutliers(free, errors.variables, observed, errors.residual, sensitivities,
              KnownBeforehand(free, errors.variables, variance.variance),
              errors.total, evidence, estimate);
  AddAxisRotation(scene, errors.variables, rows, sensitivities, inverse, misfit,
                  errors, evidence, estimate);
  if (curved != nullptr) {
    AddCurvature(*curved, errors, estimate);
  }
  if (!by_correlation.isZero(0)) {
    evidence.smooth_residual_error =
        std::sqrt(errors.total.diagonal().maxCoeff());
  }
  EnterErrorsOfKnown(scene, free, errors, estimate);
  return errors;
}

}  // namespace

MinimumErrors DescribeMinimum(const Scene& scene, const BoundedMinimum& found,
                              const SpaceChange* change,
                              const CurvedMisfit* curved,
                              DisplacementMisfit& misfit, Evidence& evidence,
                              Estimate& estimate) {
  Minimum minimum = {found, {}, {}};
  if (!misfit.Evaluate(found.variables, &minimum.rows,
                       &minimum.sensitivities)) {
    evidence.end = End::kSingularStiffness;
    return {};
  }
  return Describe(scene, minimum, change, curved, misfit, evidence, estimate);
}

}  // namespace elastimate
