#include "elastimate/estimators/total_least_squares.h"

#include <Eigen/LU>
#include <cmath>
#include <sstream>

#include "elastimate/core/degrees_of_freedom.h"
#include "elastimate/core/stiffness_product.h"
#include "elastimate/estimators/force_residual.h"
#include "elastimate/estimators/statistics.h"
#include "elastimate/estimators/virtual_fields.h"

namespace elastimate {
namespace {

// The equation psi(nu; q) = 0 that defines nu.
struct EstimatingEquation {
  /// d psi / d nu = M_22 - s T_22.
  double slope;
  /// c = (T_12 + nu T_22) / (noise of r), by which psi follows s; zero where
  /// the noise is given.
  double noise_feedback;
};

EstimatingEquation EquationAt(const ForceResidual& residual,
                              double poisson_ratio, bool noise_is_given) {
  const Eigen::Matrix2d traces = residual.ProjectedTraces();
  const Eigen::Matrix3d& triangle = residual.Triangle();
  const double b_squared = triangle(1, 1) * triangle(1, 1);
  if (noise_is_given) {
    return {b_squared - traces(1, 1), 0};
  }
  const Eigen::Vector2d weights(1, poisson_ratio);
  const double noise = weights.dot(traces * weights);
  const Eigen::Vector2d orthogonal(
      triangle(1, 2) + poisson_ratio * triangle(1, 1), triangle(2, 2));
  const double variance = orthogonal.squaredNorm() / noise;
  return {b_squared - variance * traces(1, 1),
          traces.row(1).dot(weights) / noise};
}

// d(nu, t) / dq times its transpose: the covariance of (nu, t) for noise of
// variance 1, to first order.
//
// With P the projection orthogonal to the loads, A = H + nu J and r = P A q,
// psi = b.r - s (T_12 + nu T_22), where s = r.r / (noise of r) when it is not
// given:
//
//   dpsi/dq = J r + A P b - 2 c A r,   c = (T_12 + nu T_22) / (noise of r).
class Derivatives {
 public:
  explicit Derivatives(const Scene& scene)
      : mesh_(scene.mesh), dofs_(scene.supports) {
    const auto [q, f] = WeightLoadCases(scene);
    const StiffnessProducts products = MultiplyStiffnessBasis(mesh_, q);
    a_ = dofs_.Restrict(products.h);
    b_ = dofs_.Restrict(products.j);
    f_ = dofs_.Restrict(f);
  }

  Eigen::Matrix2d Gram(double nu, const EstimatingEquation& equation,
                       bool free_poisson_ratio) const {
    const Eigen::Index num_cases = f_.cols();
    const double f_squared = f_.squaredNorm();
    const Eigen::MatrixXd r = WithoutLoads(a_ + nu * b_);
    Eigen::MatrixXd columns(f_.rows(), 3 * num_cases);
    columns << WithoutLoads(b_), r, f_;
    const StiffnessProducts products =
        MultiplyStiffnessBasis(mesh_, dofs_.Extend(columns));
    const Eigen::MatrixXd j = dofs_.Restrict(products.j);
    const Eigen::MatrixXd stiffened = dofs_.Restrict(products.h) + nu * j;
    Eigen::MatrixXd derivatives(f_.size(), 2);
    derivatives.col(0).setZero();
    if (free_poisson_ratio) {
      derivatives.col(0) =
          -(stiffened.leftCols(num_cases) + j.middleCols(num_cases, num_cases) -
            2 * equation.noise_feedback *
                stiffened.middleCols(num_cases, num_cases))
               .reshaped() /
          equation.slope;
    }
    derivatives.col(1) = (stiffened.rightCols(num_cases).reshaped() +
                          f_.cwiseProduct(b_).sum() * derivatives.col(0)) /
                         f_squared;
    return derivatives.transpose() * derivatives;
  }

 private:
  Eigen::MatrixXd WithoutLoads(const Eigen::MatrixXd& forces) const {
    return forces - (f_.cwiseProduct(forces).sum() / f_.squaredNorm()) * f_;
  }

  const Mesh& mesh_;
  DegreesOfFreedom dofs_;
  Eigen::MatrixXd a_;
  Eigen::MatrixXd b_;
  Eigen::MatrixXd f_;
};

// Relative to its standard error, a difference that is no chance; and a
// relative standard error of E that a user wants to be told of.
constexpr double kSignificantScore = 5;
constexpr double kNotableError = 0.01;

// Holds the estimate against that of the virtual fields of lowest degree, since
// the force residual cannot tell an error of the model from noise: it is rough
// either way.  Where that one doubts the model, or the two differ by more than
// noise does [Hausman 1978], the difference and the uncertainty of the other
// one are added to the covariance.
void CompareWithVirtualFields(const Scene& scene, EstimatorOptions options,
                              Estimate& estimate) {
  options.virtual_field_degree = 1;
  const Estimate other = VirtualFields().Run(scene, options);
  estimate.work = estimate.work + other.work;
  if (!other.IsUsable() || !other.active_bounds.empty()) {
    estimate.Fail(
        Status::kNotIdentifiable,
        "virtual-fields of degree 1, against which this method is held since "
        "it does not see errors of the mesh, the supports and the loads, are "
        "not usable: " +
            (other.IsUsable() ? other.warnings.back() : other.message));
    return;
  }
  std::vector<Eigen::Index> free = {0};
  if (!options.known_poisson_ratio) {
    free.push_back(1);
  }
  const Eigen::VectorXd difference = Eigen::Vector2d(
      estimate.elasticity.youngs_modulus - other.elasticity.youngs_modulus,
      estimate.elasticity.poisson_ratio - other.elasticity.poisson_ratio)(free);
  const Eigen::MatrixXd both =
      (estimate.covariance + other.covariance)(free, free);
  const double score = std::sqrt(difference.dot(both.inverse() * difference));
  if (!other.is_model_in_doubt && score <= kSignificantScore) {
    return;
  }
  estimate.is_model_in_doubt = true;
  estimate.covariance(free, free) = both + difference * difference.transpose();
  const double relative_error = *estimate.YoungsModulusStandardError() /
                                estimate.elasticity.youngs_modulus;
  if (relative_error > kNotableError) {
    estimate.warnings.emplace_back(
        "virtual-fields say that the mesh, the supports or the loads do not "
        "describe the experiment; the standard errors are widened to allow for "
        "it");
  }
}

// Fails an estimate out of the physical range, with the reason.
void JudgeUnphysical(const ForceResidual& residual, Estimate& estimate) {
  const IsotropicElasticity& elasticity = estimate.elasticity;
  if (!(residual.ComplianceScale(elasticity.poisson_ratio) > 0)) {
    estimate.Fail(Status::kUnphysical, kDisplacementsOpposeLoads);
    return;
  }
  const bool is_noise = !(estimate.PoissonRatioStandardError().value_or(0) <=
                          kLargestPoissonRatioError);
  std::ostringstream text;
  text << "nu = " << elasticity.poisson_ratio << " is not physical: "
       << (is_noise ? "displacement noise hides it from this method"
                    : "the mesh, the supports or the loads do not describe the "
                      "experiment, or displacement noise is large")
       << "; use virtual-fields or reduced-fe, or give Poisson's ratio";
  estimate.Fail(is_noise ? Status::kNotIdentifiable : Status::kUnphysical,
                text.str());
}

}  // namespace

std::string_view TotalLeastSquares::Name() const {
  return "total-least-squares";
}

std::string_view TotalLeastSquares::Description() const {
  return "closed-form without its noise bias (errors in variables), at the "
         "price of a large variance; no factorisation";
}

std::string TotalLeastSquares::WhyUnsupported(
    const Scene& scene, const EstimatorOptions& options) const {
  if (options.poisson_ratio.AreGiven() || options.youngs_modulus.AreGiven()) {
    return "it cannot keep bounds; use bounded, virtual-fields or reduced-fe";
  }
  if (options.loss != Loss::kNone) {
    return "a loss function needs displacement residuals; use reduced-fe";
  }
  if (options.virtual_field_degree) {
    return "it has no virtual fields to take a degree; use virtual-fields";
  }
  return ForceResidual::WhyUnsupported(scene);
}

Estimate TotalLeastSquares::DoRun(const Scene& scene,
                                  const EstimatorOptions& options) const {
  const ForceResidual residual(scene);
  Estimate estimate;
  estimate.status = Status::kOk;
  estimate.message = "";
  estimate.work = residual.WorkDone();
  const bool free_poisson_ratio = !options.known_poisson_ratio;
  if (free_poisson_ratio && !residual.PoissonRatio()) {
    estimate.Fail(Status::kNotIdentifiable, residual.WhyNotIdentifiable());
    return estimate;
  }
  if (!free_poisson_ratio) {
    estimate.elasticity = residual.At(*options.known_poisson_ratio);
  }
  const std::optional<double> variance =
      residual.DescribeNoise(true, free_poisson_ratio, estimate);
  // What the residual contradicts is not subtracted.
  const bool noise_is_given =
      scene.load_cases.front().noise_sd && variance == 1.0;
  if (free_poisson_ratio) {
    const std::optional<double> nu =
        noise_is_given ? residual.UnbiasedPoissonRatio()
                       : residual.ErrorsInVariablesPoissonRatio();
    if (!nu || !std::isfinite(*nu)) {
      estimate.Fail(
          Status::kNotIdentifiable,
          "displacement noise hides Poisson's ratio from this method; use "
          "virtual-fields or reduced-fe, or give Poisson's ratio");
      return estimate;
    }
    estimate.elasticity = residual.At(*nu);
  }
  estimate.force_residual = residual.RelativeResidual(estimate.elasticity);
  if (variance) {
    const double nu = estimate.elasticity.poisson_ratio;
    const EstimatingEquation equation =
        EquationAt(residual, nu, noise_is_given);
    estimate.work.element_passes += 2;
    const Eigen::Matrix2d gram =
        Derivatives(scene).Gram(nu, equation, free_poisson_ratio);
    const Eigen::Matrix2d to_parameters =
        ComplianceScaleJacobian(estimate.elasticity).inverse();
    estimate.covariance =
        *variance * to_parameters * gram * to_parameters.transpose();
    if (!free_poisson_ratio) {
      estimate.covariance.row(1).setConstant(Estimate::kUnknown);
      estimate.covariance.col(1).setConstant(Estimate::kUnknown);
    }
  }
  if (!estimate.elasticity.IsPhysical()) {
    JudgeUnphysical(residual, estimate);
    return estimate;
  }
  if (variance) {
    CompareWithVirtualFields(scene, options, estimate);
  }
  if (!free_poisson_ratio && estimate.status == Status::kOk) {
    JudgeKnownPoissonRatio(residual, estimate);
  }
  return estimate;
}

}  // namespace elastimate
