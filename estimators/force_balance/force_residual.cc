#include "elastimate/estimators/force_balance/force_residual.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "elastimate/core/algebra/dense_algebra.h"
#include "elastimate/core/algebra/large_pages.h"
#include "elastimate/core/algebra/row_block_qr.h"
#include "elastimate/core/mechanics/stiffness_product.h"
#include "elastimate/core/mechanics/stiffness_traces.h"
#include "elastimate/core/scene/degrees_of_freedom.h"
#include "elastimate/core/scene/loads.h"
#include "elastimate/estimators/interface/limits.h"
#include "elastimate/estimators/statistics/errors_on_bound.h"

namespace elastimate {
namespace {

// The sine of the angle between b and f below which rounding, not the data,
// decides on nu.
constexpr double kCollinear = 1e-11;

// Up to here the exact traces take milliseconds; beyond, estimated ones are
// good to better than 1 %, and standard errors to half of that.
constexpr Eigen::Index kMostElementsForExactTraces = 10000;
constexpr Eigen::Index kNumTraceProbes = 2;

// The triangle of a QR factorisation of the free rows of all columns of f, b
// and a, side by side.
Eigen::Matrix3d TriangleOfFreeRows(const ComponentMask& held,
                                   const Eigen::Ref<const Eigen::MatrixXd>& f,
                                   const Eigen::Ref<const Eigen::MatrixXd>& b,
                                   const Eigen::Ref<const Eigen::MatrixXd>& a) {
  RowBlockQr qr(3);
  for (Eigen::Index k = 0; k < f.cols(); ++k) {
    for (Eigen::Index dof = 0; dof < held.size(); ++dof) {
      if (!held.data()[dof]) {
        qr.NextRow() << f(dof, k), b(dof, k), a(dof, k);
      }
    }
  }
  return qr.Triangle();
}

// The products with each other of the free rows of H b, J b, H f and J f,
// summed over the load cases.
Eigen::Matrix4d ProductGram(const ComponentMask& held,
                            const StiffnessProducts& of_b,
                            const Eigen::Ref<const Eigen::MatrixXd>& hf,
                            const Eigen::Ref<const Eigen::MatrixXd>& jf) {
  Eigen::Matrix4d gram = Eigen::Matrix4d::Zero();
  for (Eigen::Index k = 0; k < hf.cols(); ++k) {
    for (Eigen::Index dof = 0; dof < held.size(); ++dof) {
      if (!held.data()[dof]) {
        const Eigen::Vector4d row(of_b.h(dof, k), of_b.j(dof, k), hf(dof, k),
                                  jf(dof, k));
        gram += row * row.transpose();
      }
    }
  }
  return gram;
}

void SetHeldRowsToZero(const ComponentMask& held,
                       Eigen::Ref<Eigen::MatrixXd> columns) {
  for (auto column : columns.colwise()) {
    for (Eigen::Index dof = 0; dof < held.size(); ++dof) {
      if (held.data()[dof]) {
        column(dof) = 0;
      }
    }
  }
}

void WeightMeasurements(const Scene& scene, Eigen::Ref<Eigen::MatrixXd> q) {
  const Supports& supports = scene.supports;
  for (Eigen::Index k = 0; k < q.cols(); ++k) {
    const LoadCase& load_case = scene.load_cases[k];
    q.col(k).reshaped(supports.held.rows(), scene.mesh.NumNodes()) =
        1 / load_case.noise_sd.value_or(1) *
        supports.held.select(supports.displacement, load_case.displacement);
  }
}

void WeightLoads(const Scene& scene, Eigen::Ref<Eigen::MatrixXd> f) {
  AssembleLoadCases(scene, f);
  for (Eigen::Index k = 0; k < f.cols(); ++k) {
    f.col(k) *= 1 / scene.load_cases[k].noise_sd.value_or(1);
  }
}

}  // namespace

WeightedLoadCases WeightLoadCases(const Scene& scene) {
  const Eigen::Index num_rows = scene.mesh.NumDofs();
  const Eigen::Index num_cases = Eigen::Index(scene.load_cases.size());
  WeightedLoadCases weighted = {Eigen::MatrixXd(num_rows, num_cases),
                                Eigen::MatrixXd(num_rows, num_cases)};
  WeightMeasurements(scene, weighted.q);
  WeightLoads(scene, weighted.f);
  return weighted;
}

ForceScene::ForceScene(const Scene& scene) : stiffness_(scene.mesh) {
  const ComponentMask& held = scene.supports.held;
  const Eigen::Index num_cases = Eigen::Index(scene.load_cases.size());
  const bool is_small = scene.mesh.NumElements() <= kMostElementsForExactTraces;
  Eigen::MatrixXd columns(held.size(),
                          num_cases + (is_small ? 0 : kNumTraceProbes));
  auto f = columns.leftCols(num_cases);
  WeightLoads(scene, f);
  SetHeldRowsToZero(held, f);
  SetTraceProbes(held, columns.rightCols(columns.cols() - num_cases));
  StiffnessProducts products;
  stiffness_.Multiply(columns, products);
  loads_ = f;
  of_loads_ = {products.h.leftCols(num_cases), products.j.leftCols(num_cases)};
  traces_ =
      is_small
          ? StiffnessTraces(scene.mesh, DegreesOfFreedom(scene.supports))
          : EstimateStiffnessTraces(held, products.h.rightCols(kNumTraceProbes),
                                    products.j.rightCols(kNumTraceProbes));
}

ForceResidual::ForceResidual(const Scene& scene)
    : section_model_(scene.mesh.section.model) {
  const ComponentMask& held = scene.supports.held;
  const Eigen::Index num_cases = Eigen::Index(scene.load_cases.size());
  const bool is_small = scene.mesh.NumElements() <= kMostElementsForExactTraces;
  const Eigen::Index num_probes = is_small ? 0 : kNumTraceProbes;

  // q, f and, where the traces are estimated, their probes, in one matrix:
  // memory is dear where a pass is as short as writing it.
  Eigen::MatrixXd columns;
  ResizeInLargePages(held.size(), 2 * num_cases + num_probes, columns);
  auto f = columns.middleCols(num_cases, num_cases);
  WeightMeasurements(scene, columns.leftCols(num_cases));
  WeightLoads(scene, f);
  SetHeldRowsToZero(held, f);
  SetTraceProbes(held, columns.rightCols(num_probes));
  const StiffnessProducts products =
      MultiplyStiffnessBasis(scene.mesh, columns);
  ++work_.element_passes;
  if (is_small) {
    traces_ = StiffnessTraces(scene.mesh, DegreesOfFreedom(scene.supports));
    ++work_.element_passes;
  } else {
    traces_ = EstimateStiffnessTraces(held, products.h.rightCols(num_probes),
                                      products.j.rightCols(num_probes));
  }
  Eigen::MatrixXd b;
  ResizeInLargePages(held.size(), num_cases, b);
  b = products.j.leftCols(num_cases);
  SetHeldRowsToZero(held, b);
  const StiffnessProducts of_b = MultiplyStiffnessBasis(scene.mesh, b);
  ++work_.element_passes;
  Compress(scene, products.h.leftCols(num_cases),
           products.j.leftCols(num_cases), f, of_b,
           products.h.middleCols(num_cases, num_cases),
           products.j.middleCols(num_cases, num_cases));
}

ForceResidual::ForceResidual(const ForceScene& prepared, const Scene& scene)
    : section_model_(scene.mesh.section.model), traces_(prepared.traces_) {
  const ComponentMask& held = scene.supports.held;
  Eigen::MatrixXd q(prepared.loads_.rows(), prepared.loads_.cols());
  WeightMeasurements(scene, q);
  StiffnessProducts products;
  prepared.Multiply(q, products);
  Eigen::MatrixXd b = products.j;
  SetHeldRowsToZero(held, b);
  StiffnessProducts of_b;
  prepared.Multiply(b, of_b);
  work_.element_passes += 2;
  Compress(scene, products.h, products.j, prepared.loads_, of_b,
           prepared.of_loads_.h, prepared.of_loads_.j);
}

void ForceResidual::Compress(const Scene& scene,
                             const Eigen::Ref<const Eigen::MatrixXd>& a,
                             const Eigen::Ref<const Eigen::MatrixXd>& b,
                             const Eigen::Ref<const Eigen::MatrixXd>& f,
                             const StiffnessProducts& of_b,
                             const Eigen::Ref<const Eigen::MatrixXd>& hf,
                             const Eigen::Ref<const Eigen::MatrixXd>& jf) {
  const ComponentMask& held = scene.supports.held;
  known_noise_sd_ = scene.load_cases.front().noise_sd;
  num_equations_ = (held.size() - held.count()) * a.cols();
  triangle_ = TriangleOfFreeRows(held, f, b, a);
  product_gram_ = ProductGram(held, of_b, hf, jf);
  traces_ *= static_cast<double>(a.cols());
}

std::optional<double> ForceResidual::PoissonRatio() const {
  const double b_norm = triangle_.col(1).norm();
  if (std::abs(triangle_(1, 1)) <= kCollinear * b_norm) {
    return std::nullopt;
  }
  return -triangle_(1, 2) / triangle_(1, 1);
}

FreeDirection ForceResidual::CollinearDirection() const {
  // Along dt / dnu = b.f / f.f the residual does not change.
  constexpr double kAnyPoissonRatio = 0.25;
  const double nu = kAnyPoissonRatio;
  const double dt_dnu = triangle_(0, 1) / triangle_(0, 0);
  return {
      At(nu),
      {LogYoungsModulusSlope(nu, section_model_) - dt_dnu / ComplianceScale(nu),
       1}};
}

double ForceResidual::ComplianceScale(double poisson_ratio) const {
  return (triangle_(0, 2) + poisson_ratio * triangle_(0, 1)) / triangle_(0, 0);
}

IsotropicElasticity ForceResidual::At(double poisson_ratio) const {
  return IsotropicElasticity::FromComplianceScale(
      ComplianceScale(poisson_ratio), poisson_ratio, section_model_);
}

double ForceResidual::RelativeResidual(
    const IsotropicElasticity& elasticity) const {
  const double t = elasticity.ComplianceScale(section_model_);
  return (triangle_ * Eigen::Vector3d(-t, elasticity.poisson_ratio, 1)).norm() /
         std::abs(t * triangle_(0, 0));
}

Eigen::Matrix2d ForceResidual::StiffenedGram(double poisson_ratio) const {
  Eigen::Matrix<double, 4, 2> combine;
  combine << 1, 0, poisson_ratio, 0, 0, 1, 0, poisson_ratio;
  return combine.transpose() * product_gram_ * combine;
}

Eigen::Matrix2d ForceResidual::ProjectedTraces() const {
  const double f_squared = triangle_(0, 0) * triangle_(0, 0);
  return traces_ - product_gram_.bottomRightCorner<2, 2>() / f_squared;
}

double ForceResidual::ErrorsInVariablesPoissonRatio() const {
  // Minimises (||a~ + nu b~||^2) / (noise of a + nu b), where ~ is the part
  // orthogonal to f, in the basis where the noise is isotropic.
  const Eigen::LLT<Eigen::Matrix2d> noise(ProjectedTraces());
  Eigen::Matrix2d b_then_a;
  b_then_a << triangle_(1, 1), triangle_(1, 2), 0, triangle_(2, 2);
  const Eigen::Matrix2d a_then_b = b_then_a.rowwise().reverse();
  const Eigen::Matrix2d normalized =
      noise.matrixL().solve(a_then_b.transpose()).transpose();
  const Eigen::Vector2d direction =
      noise.matrixU().solve(DecomposeSingularValues(normalized).v.col(1));
  return direction(1) / direction(0);
}

std::optional<double> ForceResidual::ResidualVariance(
    double poisson_ratio, bool free_poisson_ratio) const {
  const Eigen::Vector2d weights(1, poisson_ratio);
  const double all_noise = weights.dot(traces_ * weights);
  const Eigen::Matrix2d stiffened = StiffenedGram(poisson_ratio);
  double fitted_noise = 0;
  if (free_poisson_ratio) {
    const Eigen::Matrix2d r = (Eigen::Matrix2d() << triangle_(0, 1),
                               triangle_(0, 0), triangle_(1, 1), 0)
                                  .finished();
    fitted_noise = ((r.transpose() * r).inverse() * stiffened).trace();
  } else {
    fitted_noise = stiffened(1, 1) / (triangle_(0, 0) * triangle_(0, 0));
  }
  const Eigen::Index num_unknowns = free_poisson_ratio ? 2 : 1;
  if (num_equations_ <= num_unknowns || !(fitted_noise < all_noise)) {
    return std::nullopt;
  }
  const double orthogonal = triangle_(1, 2) + poisson_ratio * triangle_(1, 1);
  return (orthogonal * orthogonal + triangle_(2, 2) * triangle_(2, 2)) /
         (all_noise - fitted_noise);
}

std::optional<double> ForceResidual::NoiseVariance(
    const Estimate& estimate, bool free_youngs_modulus,
    bool free_poisson_ratio) const {
  if (!free_youngs_modulus) {
    const Eigen::Vector2d weights(1, estimate.elasticity.poisson_ratio);
    const double norm = RelativeResidual(estimate.elasticity) *
                        estimate.elasticity.ComplianceScale(section_model_) *
                        triangle_(0, 0);
    return norm * norm / weights.dot(traces_ * weights);
  }
  return ResidualVariance(free_poisson_ratio
                              ? ErrorsInVariablesPoissonRatio()
                              : estimate.elasticity.poisson_ratio,
                          free_poisson_ratio);
}

std::optional<double> ForceResidual::UnbiasedPoissonRatio() const {
  if (!known_noise_sd_) {
    const double nu = ErrorsInVariablesPoissonRatio();
    return std::isfinite(nu) ? std::optional<double>(nu) : std::nullopt;
  }
  const Eigen::Matrix2d noise = ProjectedTraces();
  const double r11 = triangle_(1, 1);
  const double b_squared = r11 * r11 - noise(1, 1);
  if (!(b_squared > 0)) {
    return std::nullopt;
  }
  return -(r11 * triangle_(1, 2) - noise(0, 1)) / b_squared;
}

std::optional<double> ForceResidual::UnbiasedPoissonRatioError() const {
  constexpr double kLargestAttenuation = 0.5;
  const std::optional<double> nu = UnbiasedPoissonRatio();
  const std::optional<double> variance =
      nu ? ResidualVariance(*nu, true) : std::nullopt;
  if (!variance) {
    return std::nullopt;
  }
  const double attenuation =
      *variance * ProjectedTraces()(1, 1) / (triangle_(1, 1) * triangle_(1, 1));
  if (!(attenuation < kLargestAttenuation)) {
    return std::nullopt;
  }
  return std::sqrt(Covariance(At(*nu), *variance, true, true)(1, 1)) /
         (1 - attenuation);
}

Eigen::Matrix2d ForceResidual::Jacobian(
    const IsotropicElasticity& elasticity) const {
  // r depends on (nu, t) through the columns [b, -f].
  Eigen::Matrix2d columns;
  columns << triangle_(0, 1), -triangle_(0, 0), triangle_(1, 1), 0;
  return columns * ComplianceScaleJacobian(elasticity, section_model_);
}

Eigen::Matrix2d ForceResidual::Covariance(const IsotropicElasticity& elasticity,
                                          double noise_variance,
                                          bool free_youngs_modulus,
                                          bool free_poisson_ratio) const {
  // The noise of r is sigma^2 A A^T, so that least squares has a sandwich
  // covariance.
  Eigen::Matrix2d gram = StiffenedGram(elasticity.poisson_ratio);
  gram(0, 1) *= -1;
  gram(1, 0) *= -1;
  std::vector<Eigen::Index> free;
  if (free_youngs_modulus) {
    free.push_back(0);
  }
  if (free_poisson_ratio) {
    free.push_back(1);
  }
  const Eigen::MatrixXd directions =
      ComplianceScaleJacobian(elasticity, section_model_)(Eigen::all, free);
  const Eigen::MatrixXd x = Jacobian(elasticity)(Eigen::all, free);
  const Eigen::MatrixXd inverse =
      Inverse(x.transpose() * x) * directions.transpose();
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Constant(Estimate::kUnknown);
  const Eigen::MatrixXd propagated = inverse * gram * inverse.transpose();
  covariance(free, free) = noise_variance * propagated;
  return covariance;
}

std::optional<double> ForceResidual::DescribeNoise(bool free_youngs_modulus,
                                                   bool free_poisson_ratio,
                                                   Evidence& evidence,
                                                   Estimate& estimate) const {
  const std::optional<double> residual_variance =
      NoiseVariance(estimate, free_youngs_modulus, free_poisson_ratio);
  if (!known_noise_sd_ && !residual_variance) {
    estimate.why_no_standard_error =
        "there are no more equations than unknowns, so that the noise cannot "
        "be estimated; give its standard deviation";
    return std::nullopt;
  }
  const double noise_sd_ratio = std::sqrt(residual_variance.value_or(1));
  double variance = residual_variance.value_or(1);
  estimate.noise_sd = known_noise_sd_.value_or(noise_sd_ratio);
  if (known_noise_sd_) {
    variance = 1;
    if (noise_sd_ratio > kLimits.excess_force_residual) {
      evidence.above_noise = {ResidualKind::kForce, noise_sd_ratio};
      variance = *residual_variance;
    }
  }
  if (free_poisson_ratio) {
    const double b_squared = triangle_(1, 1) * triangle_(1, 1);
    estimate.noise_attenuation =
        std::min(1.0, variance * ProjectedTraces()(1, 1) / b_squared);
  }
  return variance;
}

void ForceResidual::Describe(bool free_youngs_modulus, bool free_poisson_ratio,
                             Evidence& evidence, Estimate& estimate) const {
  estimate.force_residual = RelativeResidual(estimate.elasticity);
  const std::optional<double> variance = DescribeNoise(
      free_youngs_modulus, free_poisson_ratio, evidence, estimate);
  if (!variance) {
    return;
  }
  if (free_youngs_modulus || free_poisson_ratio) {
    estimate.covariance = Covariance(estimate.elasticity, *variance,
                                     free_youngs_modulus, free_poisson_ratio);
    estimate.error_budget.noise =
        StandardErrors(estimate.covariance, estimate.elasticity);
  }
}

ErrorsOnBound ForceResidual::AllowForYoungsModulusOnBound(
    const EstimatorOptions& options, Estimate& estimate) const {
  const bool free_poisson_ratio = !options.known_poisson_ratio;
  const IsotropicElasticity& elasticity = estimate.elasticity;
  // That of the bound may contradict it, which is not for noise to explain.
  const std::optional<double> variance =
      known_noise_sd_ ? 1
                      : ResidualVariance(free_poisson_ratio
                                             ? ErrorsInVariablesPoissonRatio()
                                             : elasticity.poisson_ratio,
                                         free_poisson_ratio);
  const bool is_determined =
      variance && (!free_poisson_ratio || PoissonRatio());
  const double standard_error =
      is_determined ? std::sqrt(Covariance(elasticity, *variance, true,
                                           free_poisson_ratio)(0, 0)) /
                          elasticity.youngs_modulus
                    : std::numeric_limits<double>::infinity();
  const Eigen::Matrix2d x = Jacobian(elasticity);
  const double slope = -elasticity.youngs_modulus * x.col(0).dot(x.col(1)) /
                       x.col(1).squaredNorm();
  return elastimate::AllowForYoungsModulusOnBound(options, slope,
                                                  standard_error, estimate);
}

std::unique_ptr<Preparation> PrepareForceResidual(
    const Scene& scene, const EstimatorOptions& options,
    Estimate (*estimate)(const ForceResidual& residual, const Scene& scene,
                         const EstimatorOptions& options)) {
  class ForcePreparation : public Preparation {
   public:
    ForcePreparation(const Scene& scene, const EstimatorOptions& options,
                     decltype(estimate) estimate)
        : forces_(scene), options_(options), estimate_(estimate) {}

    Estimate Run(const Scene& scene) override {
      return estimate_(ForceResidual(forces_, scene), scene, options_);
    }

   private:
    ForceScene forces_;
    const EstimatorOptions& options_;
    decltype(estimate) estimate_;
  };
  return std::make_unique<ForcePreparation>(scene, options, estimate);
}

std::optional<UnbiasedPoissonRatio> MeasureUnbiasedPoissonRatio(
    const ForceResidual& residual, const Estimate& estimate) {
  const std::optional<double> nu = residual.UnbiasedPoissonRatio();
  const std::optional<double> error = residual.UnbiasedPoissonRatioError();
  if (!residual.PoissonRatio() || !nu || !error) {
    return std::nullopt;
  }
  return UnbiasedPoissonRatio{
      *nu, *error,
      residual.At(*nu).youngs_modulus / estimate.elasticity.youngs_modulus};
}

NoiseBias MeasureNoiseBias(const ForceResidual& residual, const Bounds& bounds,
                           Estimate& estimate) {
  constexpr double kHidden = std::numeric_limits<double>::infinity();
  const IsotropicElasticity& elasticity = estimate.elasticity;
  NoiseBias bias = {kHidden, kHidden,
                    estimate.YoungsModulusStandardError().value_or(0) /
                        elasticity.youngs_modulus,
                    estimate.PoissonRatioStandardError().value_or(0)};
  const std::optional<double> unbiased_nu = residual.UnbiasedPoissonRatio();
  if (!unbiased_nu) {
    return bias;
  }
  const double nu = std::clamp(*unbiased_nu, bounds.lower.value_or(-1),
                               bounds.upper.value_or(0.5));
  const double unbiased = residual.At(nu).youngs_modulus;
  if (!(unbiased > 0)) {
    return bias;
  }
  bias.youngs_modulus = elasticity.youngs_modulus / unbiased - 1;
  bias.poisson_ratio = elasticity.poisson_ratio - nu;
  // Relative to the estimate.
  const Eigen::Vector2d both(bias.youngs_modulus / (1 + bias.youngs_modulus),
                             bias.poisson_ratio);
  const Eigen::Vector2d scaled(elasticity.youngs_modulus * both(0), both(1));
  estimate.covariance += scaled * scaled.transpose();
  estimate.error_budget.bias = both.cwiseAbs();
  return bias;
}

}  // namespace elastimate
