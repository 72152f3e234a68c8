#include "elastimate/estimators/force_balance/force_regression.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <vector>

#include "elastimate/core/algebra/dense_algebra.h"
#include "elastimate/estimators/force_balance/free_direction.h"
#include "elastimate/estimators/force_balance/virtual_work_check.h"
#include "elastimate/estimators/interface/free_parameters.h"
#include "elastimate/estimators/interface/judge.h"
#include "elastimate/estimators/interface/limits.h"
#include "elastimate/estimators/interface/parameter_judge.h"
#include "elastimate/estimators/statistics/bounded_variables.h"

namespace elastimate {
namespace {

// The least singular value of columns of norm 1 below which they depend on each
// other but for rounding.
constexpr double kDependentColumns = 1e-11;

// What a residual is divided by, and its gradient by the moduli.
struct SizeOfModuli {
  double value;
  Eigen::RowVectorXd gradient;
};
using SizeFunction = std::function<SizeOfModuli(const Eigen::VectorXd& moduli)>;

SizeFunction MeanStiffness(const ForceResidual& forces) {
  const Eigen::VectorXd& weights = forces.Prepared().Weights();
  return [&weights](const Eigen::VectorXd& moduli) {
    return SizeOfModuli{weights.dot(moduli), weights.transpose()};
  };
}

SizeFunction NoiseOfForces(const ForceResidual& forces) {
  const Eigen::MatrixXd& traces = forces.Traces();
  return [&traces](const Eigen::VectorXd& moduli) {
    const Eigen::RowVectorXd product = (traces * moduli).transpose();
    const double size = std::sqrt(product.dot(moduli));
    return SizeOfModuli{size, product / size};
  };
}

// theta / size as a combination of the columns of [F f], and its derivatives by
// the variables: (m + 1) x 1 and (m + 1) x n.
struct Combinations {
  Eigen::VectorXd residual;
  Eigen::MatrixXd derivatives;
};

Combinations CombinationsAt(const FreeParameters& free,
                            const Eigen::VectorXd& variables,
                            const SizeFunction& size_of) {
  const Eigen::VectorXd moduli = free.ModuliAt(variables);
  const Eigen::MatrixXd jacobian = free.ModuliJacobian(variables);
  const auto [size, gradient] = size_of(moduli);
  Combinations combinations;
  combinations.residual.resize(moduli.size() + 1);
  combinations.residual << moduli / size, -1 / size;
  combinations.derivatives.resize(moduli.size() + 1, jacobian.cols());
  combinations.derivatives << jacobian / size,
      Eigen::RowVectorXd::Zero(jacobian.cols());
  combinations.derivatives -=
      combinations.residual * (gradient * jacobian) / size;
  return combinations;
}

// [F f] in the rows of its triangle.
Eigen::MatrixXd TriangleOf(const ForceResidual& forces) {
  Eigen::MatrixXd triangle(forces.Columns().rows(),
                           forces.Columns().cols() + 1);
  triangle << forces.Columns(), forces.Loads();
  return triangle;
}

// (F theta - f) / size in the rows of the triangle.
Eigen::VectorXd ResidualAt(const FreeParameters& free,
                           const Eigen::VectorXd& variables,
                           const SizeFunction& size_of,
                           const ForceResidual& forces) {
  return TriangleOf(forces) * CombinationsAt(free, variables, size_of).residual;
}

// By Ceres, within the bounds of the variables.
BoundedMinimum SearchMinimum(const ForceResidual& forces,
                             const FreeParameters& free,
                             const SizeFunction& size_of,
                             const Eigen::VectorXd& start) {
  const Eigen::MatrixXd triangle = TriangleOf(forces);
  const double unit =
      forces.Loads().norm() / size_of(free.ModuliAt(start)).value;
  const ResidualFunction residual = [&](const Eigen::VectorXd& x,
                                        Eigen::VectorXd* r,
                                        Eigen::MatrixXd* jacobian) {
    const Combinations combinations = CombinationsAt(free, x, size_of);
    *r = triangle * combinations.residual / unit;
    if (jacobian != nullptr) {
      *jacobian = triangle * combinations.derivatives / unit;
    }
    return r->allFinite();
  };
  // So few residuals cost nothing: iterate to rounding.
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = 500;
  options.function_tolerance = 0;
  options.gradient_tolerance = 1e-16;
  options.parameter_tolerance = 1e-15;
  // At rounding, no step is one.
  options.max_num_consecutive_invalid_steps = 50;
  options.logging_type = ceres::SILENT;
  return MinimizeOverVariables(residual, triangle.rows(), free.VariableBounds(),
                               start, options);
}

// The moduli of the least residual over the mean stiffness w.theta, where none
// is known or bounded: the residual of c = theta / (w.theta) and t = 1 /
// (w.theta) is linear, and w.c = 1 gives one entry of c.  Empty when the
// columns are not independent.
std::optional<Eigen::VectorXd> LinearMinimum(const ForceResidual& forces) {
  const Eigen::VectorXd& weights = forces.Prepared().Weights();
  Eigen::Index given = 0;
  weights.cwiseAbs().maxCoeff(&given);
  const Eigen::VectorXd of_given = forces.Columns().col(given) / weights(given);
  Eigen::MatrixXd columns = forces.Columns() - of_given * weights.transpose();
  columns.col(given) = -forces.Loads();
  if (!(LeastSingularValue(columns) > kDependentColumns)) {
    return std::nullopt;
  }
  const Eigen::VectorXd scales = columns.colwise().norm();
  columns *= scales.cwiseInverse().asDiagonal();
  const Eigen::VectorXd solution =
      SolveLeastSquares(columns, -of_given).col(0).cwiseQuotient(scales);
  Eigen::VectorXd moduli = solution;
  moduli(given) = 0;
  moduli(given) = (1 - weights.dot(moduli)) / weights(given);
  return moduli / solution(given);
}

// These variables at the scale that fits the loads best [eq. 20], where no
// known modulus gives another; empty when the displacements oppose the loads.
std::optional<Eigen::VectorXd> AtScaleOfLoads(
    const std::optional<Eigen::VectorXd>& variables,
    const ForceResidual& forces, const FreeParameters& free) {
  if (!variables || free.All().KnownModulus()) {
    return variables;
  }
  const Eigen::VectorXd moduli = free.ModuliAt(*variables);
  const double scale = forces.Loads().squaredNorm() /
                       (forces.Columns() * moduli).dot(forces.Loads());
  return scale > 0 ? free.VariablesOfModuli(scale * moduli) : std::nullopt;
}

// The better of the minima of the residual over the mean stiffness that these
// starts lead to; empty where there is none.
std::optional<BoundedMinimum> BestMinimumOf(
    const std::vector<std::optional<Eigen::VectorXd>>& starts,
    const ForceResidual& forces, const FreeParameters& free) {
  // What is better by less is the same minimum, which the first start is nearer
  // to.
  constexpr double kRounding = 1e-9;
  std::optional<BoundedMinimum> best;
  double least = std::numeric_limits<double>::infinity();
  for (const std::optional<Eigen::VectorXd>& start : starts) {
    if (!start) {
      continue;
    }
    const SizeFunction size_of = MeanStiffness(forces);
    const BoundedMinimum minimum = SearchMinimum(forces, free, size_of, *start);
    const double residual =
        ResidualAt(free, minimum.variables, size_of, forces).norm();
    if (!best || residual < (1 - kRounding) * least) {
      best = minimum;
      least = residual;
    }
  }
  return best;
}

// What noise makes of a minimum.
struct NoiseOfMinimum {
  double variance;           ///< That the weighted noise has.
  Eigen::MatrixXd bread;     ///< A.
  Eigen::MatrixXd of_noise;  ///< The part of A that is noise.
  Eigen::MatrixXd filling;   ///< X^T K K X / s^2.

  // sigma^2 A^-1 X^T K K X A^-1 / s^2, with all of A or what is no noise.
  Eigen::MatrixXd Covariance(const Eigen::MatrixXd& of_bread) const {
    const Eigen::MatrixXd inverse = Inverse(of_bread);
    return variance * inverse * filling * inverse;
  }
  // The largest share of A, over all directions, that is noise.
  double Attenuation() const {
    return DecomposeSymmetric(of_noise, bread).values(bread.rows() - 1);
  }
};

NoiseOfMinimum NoiseAt(const FreeParameters& free,
                       const Eigen::VectorXd& variables, double variance,
                       ForceResidual& forces) {
  const Combinations combinations =
      CombinationsAt(free, variables, MeanStiffness(forces));
  const Eigen::MatrixXd x = TriangleOf(forces) * combinations.derivatives;
  const Eigen::MatrixXd of_moduli =
      combinations.derivatives.topRows(forces.Columns().cols());
  return {variance, x.transpose() * x,
          variance * of_moduli.transpose() * forces.Traces() * of_moduli,
          forces.StiffenedGram(combinations.residual.head(of_moduli.rows()),
                               combinations.derivatives)};
}

// The variance of the weighted noise as given, or from the residual where
// nothing is given or the residual contradicts it, which is evidence.  Empty,
// with the reason, where neither is known.
std::optional<double> NoiseVariance(const std::optional<double>& of_residual,
                                    const std::optional<double>& given_noise_sd,
                                    Evidence& evidence, Estimate& estimate) {
  if (!given_noise_sd && !of_residual) {
    estimate.why_no_standard_error =
        "there are no more equations than unknowns, so that the noise cannot "
        "be estimated; give its standard deviation (--noise_sd)";
    return std::nullopt;
  }
  const double ratio = std::sqrt(of_residual.value_or(1));
  estimate.noise_sd = given_noise_sd.value_or(ratio);
  if (!given_noise_sd) {
    return of_residual;
  }
  if (ratio > kLimits.excess_force_residual) {
    evidence.above_noise = {ResidualKind::kForce, ratio};
    return of_residual;
  }
  return 1;
}

// The derivatives of the residual over the mean stiffness, in the triangle.
Eigen::MatrixXd DerivativesAt(const FreeParameters& free,
                              const Eigen::VectorXd& variables,
                              const ForceResidual& forces) {
  return TriangleOf(forces) *
         CombinationsAt(free, variables, MeanStiffness(forces)).derivatives;
}

}  // namespace

std::optional<double> NoiseVarianceAt(const FreeParameters& free,
                                      const Eigen::VectorXd& variables,
                                      const ForceResidual& forces) {
  const double redundancy = forces.NumEquations() - double(free.Size());
  if (!(redundancy > 0)) {
    return std::nullopt;
  }
  return ResidualAt(free, variables, NoiseOfForces(forces), forces)
             .squaredNorm() *
         forces.NumEquations() / redundancy;
}

UnbiasedFit FitWithoutBias(const FreeParameters& free,
                           const Eigen::VectorXd& start,
                           const ForceResidual& forces) {
  UnbiasedFit fit;
  fit.variables =
      SearchMinimum(forces, free, NoiseOfForces(forces), start).variables;
  fit.noise_variance = NoiseVarianceAt(free, fit.variables, forces);
  return fit;
}

std::optional<Eigen::MatrixXd> CovarianceOf(const UnbiasedFit& fit,
                                            const FreeParameters& free,
                                            ForceResidual& forces) {
  constexpr double kLargestAttenuation = 0.5;
  if (!fit.variables.allFinite() || !fit.noise_variance ||
      !(LeastSingularValue(DerivativesAt(free, fit.variables, forces)) >
        kDependentColumns)) {
    return std::nullopt;
  }
  const NoiseOfMinimum noise =
      NoiseAt(free, fit.variables, *fit.noise_variance, forces);
  if (!(noise.Attenuation() < kLargestAttenuation)) {
    return std::nullopt;
  }
  return noise.Covariance(noise.bread - noise.of_noise);
}

namespace {

// Says whether the data contradict Poisson's ratios that are known.
void CheckKnownRatios(const Scene& scene, const EstimatorOptions& options,
                      const FreeParameters& free, ForceResidual& forces,
                      Evidence& evidence, const Estimate& estimate) {
  Scene open = scene;
  EstimatorOptions open_options = options;
  open_options.known_poisson_ratio.reset();
  for (Material& material : open.materials) {
    material.known.erase(
        std::remove_if(material.known.begin(), material.known.end(),
                       [](const KnownParameter& known) {
                         return known.name == "poisson_ratio";
                       }),
        material.known.end());
  }
  const FreeParameters all(open, open_options);
  if (all.Size() == free.Size()) {
    return;
  }
  const UnbiasedFit fit =
      FitWithoutBias(all, all.VariablesOf(estimate.ParameterValues()), forces);
  const std::optional<Eigen::MatrixXd> covariance =
      CovarianceOf(fit, all, forces);
  if (!covariance) {
    return;
  }
  const Eigen::VectorXd asked = all.ParametersAt(fit.variables);
  double change = 0;
  double largest_score = 0;
  for (Eigen::Index i = 0; i < all.Size(); ++i) {
    const Eigen::Index place = all.All().Free()[i];
    const ParameterEstimate& parameter = estimate.parameters[place];
    const double difference = asked(place) - parameter.value;
    const double error = std::sqrt((*covariance)(i, i));
    if (!parameter.is_known) {
      change = std::max(change, parameter.IsStiffness()
                                    ? std::abs(difference / parameter.value)
                                    : 0);
    } else if (std::abs(difference) / error > largest_score) {
      largest_score = std::abs(difference) / error;
      evidence.known_ratio = {parameter.Label(), difference, asked(place),
                              error, 0};
    }
  }
  if (evidence.known_ratio) {
    evidence.known_ratio->change_of_moduli = change;
  }
}

class ForceRegression {
 public:
  ForceRegression(const Scene& scene, const EstimatorOptions& options,
                  ForceResidual& forces)
      : scene_(scene),
        options_(options),
        forces_(forces),
        free_(scene, options),
        moduli_(LinearMinimum(forces)) {}

  // The moduli of the least residual of physical materials; empty when the
  // displacements oppose the loads.
  std::optional<Eigen::VectorXd> PhysicalMinimum() {
    return FindMinimum(/*is_bounded=*/true)
               ? std::optional<Eigen::VectorXd>(
                     free_.All().Moduli(estimate_.ParameterValues()))
               : std::nullopt;
  }

  Estimate Run(bool is_bounded, End end_of_moduli = End::kDone) {
    const bool has_minimum = FindMinimum(is_bounded);
    if (end_of_moduli != End::kDone) {
      evidence_.end = end_of_moduli;
    }
    if (!has_minimum) {
      evidence_.do_displacements_oppose_loads = true;
      Judge(evidence_, options_, estimate_);
      estimate_.work = forces_.WorkDone();
      return estimate_;
    }
    if (variables_.allFinite() &&
        !NoteFreeDirection(DerivativesAt(free_, variables_, forces_),
                           kDependentColumns, free_, estimate_, evidence_)) {
      DescribeErrors();
      CheckKnownRatios(scene_, options_, free_, forces_, evidence_, estimate_);
    }
    estimate_.work = forces_.WorkDone();
    Judge(evidence_, options_, estimate_);
    CheckWork();
    Judge(evidence_, options_, estimate_);
    return estimate_;
  }

 private:
  // Enters the parameters of the least residual over the mean stiffness; false
  // when the displacements oppose the loads.
  bool FindMinimum(bool is_bounded) {
    const bool is_linear = free_.Size() == free_.All().NumParameters();
    if (!is_bounded && is_linear && moduli_) {
      const Eigen::VectorXd parameters = free_.All().ParametersOf(*moduli_);
      // Parameters that are not physical are entered, too.
      EnterParameters(scene_, free_, parameters, estimate_);
      variables_ = free_.VariablesOf(parameters);
      SetForceResidual(*moduli_);
      return forces_.Prepared().Weights().dot(*moduli_) > 0 ||
             !AreRatiosPhysical();
    }
    const Eigen::VectorXd typical = free_.VariablesOf(
        free_.All().Typical(free_.All().KnownModulus().value_or(1)));
    const std::optional<BoundedMinimum> minimum = BestMinimumOf(
        {moduli_
             ? AtScaleOfLoads(free_.VariablesOfModuli(*moduli_), forces_, free_)
             : std::nullopt,
         AtScaleOfLoads(typical, forces_, free_)},
        forces_, free_);
    if (!minimum) {
      return false;
    }
    variables_ = minimum->variables;
    evidence_.end = minimum->end;
    evidence_.search_message = minimum->message;
    EnterParameters(scene_, free_, free_.ParametersAt(variables_), estimate_);
    NoteVariablesOnBounds(free_, *minimum, evidence_, estimate_);
    for (Eigen::Index i = 0; i < free_.Size(); ++i) {
      // The search ends far off where no bound does.
      const Bounds& bounds = free_.VariableBounds()[i];
      const Side side = minimum->on_bound[i];
      evidence_.does_youngs_modulus_diverge =
          evidence_.does_youngs_modulus_diverge ||
          (side == Side::kLower && !bounds.lower) ||
          (side == Side::kUpper && !bounds.upper);
    }
    SetForceResidual(free_.ModuliAt(variables_));
    return true;
  }

  // Where they are not, noise may have turned the signs of the moduli.
  bool AreRatiosPhysical() const {
    return std::all_of(estimate_.parameters.begin(), estimate_.parameters.end(),
                       [](const ParameterEstimate& parameter) {
                         return parameter.IsStiffness() ||
                                parameter.IsPhysical();
                       });
  }

  void SetForceResidual(const Eigen::VectorXd& moduli) {
    estimate_.force_residual =
        (forces_.Columns() * moduli - forces_.Loads()).norm() /
        forces_.Loads().norm();
  }

  // Enters the noise, the covariance and the bias of the variables.
  void DescribeErrors() {
    const UnbiasedFit unbiased = FitWithoutBias(free_, variables_, forces_);
    noise_variance_ =
        NoiseVariance(unbiased.noise_variance,
                      scene_.load_cases.front().noise_sd, evidence_, estimate_);
    if (!noise_variance_) {
      return;
    }
    const NoiseOfMinimum noise =
        NoiseAt(free_, variables_, *noise_variance_, forces_);
    Eigen::MatrixXd covariance = noise.Covariance(noise.bread);
    estimate_.noise_attenuation = std::min(1.0, noise.Attenuation());
    estimate_.error_budget.noise =
        ErrorsOfVariables(free_, variables_, covariance);
    const Eigen::VectorXd bias = variables_ - unbiased.variables;
    const Eigen::MatrixXd of_bias = bias * bias.transpose();
    estimate_.error_budget.bias = ErrorsOfVariables(free_, variables_, of_bias);
    EnterCovariance(free_, variables_, covariance + of_bias, estimate_);
  }

  void CheckWork() {
    if (forces_.Prepared().LargeForces() == nullptr) {
      evidence_.work_check = CheckByVirtualWork(scene_, options_, estimate_);
    } else if (noise_variance_) {
      evidence_.work_check = CheckByLargeVirtualWork(
          scene_, free_, variables_, *noise_variance_, forces_, estimate_);
    }
  }

  const Scene& scene_;
  const EstimatorOptions& options_;
  ForceResidual& forces_;
  FreeParameters free_;
  std::optional<double> noise_variance_;
  std::optional<Eigen::VectorXd> moduli_;
  Eigen::VectorXd variables_;
  Evidence evidence_;
  Estimate estimate_;
};

class ForcePreparation : public Preparation {
 public:
  ForcePreparation(const Scene& scene, const EstimatorOptions& options,
                   bool is_bounded)
      : forces_(scene), options_(options), is_bounded_(is_bounded) {}

  Estimate Run(const Scene& scene) override {
    if (forces_.AreNonlinearInModuli()) {
      return RunNonlinear(scene);
    }
    ForceResidual forces(forces_, scene);
    return ForceRegression(scene, options_, forces).Run(is_bounded_);
  }

 private:
  // Gauss-Newton: takes the derivatives by the moduli at the last minimum,
  // until the ratios of the moduli stay.
  Estimate RunNonlinear(const Scene& scene) {
    // Convergence is quadratic where the residual is small.
    constexpr double kSameRatios = 1e-9;
    const MaterialParameters& all = forces_.LargeForces()->Parameters();
    Eigen::VectorXd moduli =
        all.Moduli(all.Typical(all.KnownModulus().value_or(1))).normalized();
    Work work;
    for (int i = 0;; ++i) {
      ForceResidual forces(forces_, scene, moduli);
      const std::optional<Eigen::VectorXd> minimum =
          ForceRegression(scene, options_, forces).PhysicalMinimum();
      const bool is_done =
          !minimum || (minimum->normalized() - moduli).norm() <= kSameRatios;
      if (is_done || i == options_.max_iterations) {
        Estimate estimate =
            ForceRegression(scene, options_, forces)
                .Run(is_bounded_, is_done ? End::kDone : End::kIterationLimit);
        estimate.work = estimate.work + work;
        return estimate;
      }
      work = work + forces.WorkDone();
      moduli = minimum->normalized();
    }
  }

  ForceScene forces_;
  const EstimatorOptions& options_;
  bool is_bounded_;
};

}  // namespace

Estimate RegressForces(const Scene& scene, const EstimatorOptions& options,
                       bool is_bounded) {
  return ForcePreparation(scene, options, is_bounded).Run(scene);
}

std::unique_ptr<Preparation> PrepareForceRegression(
    const Scene& scene, const EstimatorOptions& options, bool is_bounded) {
  return std::make_unique<ForcePreparation>(scene, options, is_bounded);
}

}  // namespace elastimate
