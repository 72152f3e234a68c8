#ifndef ELASTIMATE_ESTIMATORS_FORCE_BALANCE_FORCE_RESIDUAL_H_
#define ELASTIMATE_ESTIMATORS_FORCE_BALANCE_FORCE_RESIDUAL_H_

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>

#include "elastimate/core/materials/elasticity.h"
#include "elastimate/core/mechanics/stiffness_product.h"
#include "elastimate/core/scene/degrees_of_freedom.h"
#include "elastimate/core/scene/scene.h"
#include "elastimate/estimators/interface/estimate.h"
#include "elastimate/estimators/interface/estimator.h"
#include "elastimate/estimators/interface/evidence.h"

namespace elastimate {

/// The measurement as the methods without a finite element solution take it,
/// one column per load case, weighted by 1 / noise_sd where it is known.
struct WeightedLoadCases {
  Eigen::MatrixXd q;  ///< Measured where free, given where held: num_dofs x
                      ///< num_load_cases.
  Eigen::MatrixXd f;  ///< Loads, of the same shape.
};

/// Precondition: every free component is observed.
WeightedLoadCases WeightLoadCases(const Scene& scene);

/// What a ForceResidual needs that does not depend on the measurement, for a
/// scene that is measured again and again.
class ForceScene {
 public:
  /// Two element passes.  Refers to the mesh of the scene.
  explicit ForceScene(const Scene& scene);

  /// H q and J q of some columns: one element pass.
  void Multiply(const Eigen::MatrixXd& q, StiffnessProducts& products) const {
    stiffness_.Multiply(q, products);
  }

 private:
  friend class ForceResidual;

  StiffnessOperator stiffness_;
  Eigen::MatrixXd loads_;  ///< Weighted f, zero in the held rows.
  StiffnessProducts of_loads_;
  Eigen::Matrix2d traces_;  ///< Of one load case.
};

/// The force residual r(nu, t) = a + nu b - t f of a scene, a = H q, b = J q,
/// over the free degrees of freedom of all load cases, compressed to what its
/// least-squares estimators need [Becker & Teschner 2007, eq. 20-24].
///
/// Load cases are weighted by 1 / noise_sd when it is known, so that the noise
/// of the weighted displacements has standard deviation 1.
class ForceResidual {
 public:
  /// One element pass for a and b and what of the statistics does not depend on
  /// them, and one or two for the rest.
  /// Preconditions: what Estimator::Run checks, and every free component is
  /// observed.
  explicit ForceResidual(const Scene& scene);

  /// Of a measurement of the scene that `prepared` is of: two element passes of
  /// one column for each load case.
  ForceResidual(const ForceScene& prepared, const Scene& scene);

  /// Minimiser of ||r|| over nu and t, unbounded; empty when b and f are
  /// collinear, so that the data determine one combination of nu and t only.
  std::optional<double> PoissonRatio() const;

  /// What is not determined when PoissonRatio is empty.
  FreeDirection CollinearDirection() const;

  /// t that minimises ||r|| at this nu, t = f.(a + nu b) / f.f [eq. 20].
  double ComplianceScale(double poisson_ratio) const;

  /// (E, nu) with the t of ComplianceScale.
  IsotropicElasticity At(double poisson_ratio) const;

  /// ||r|| / ||t f||.
  double RelativeResidual(const IsotropicElasticity& elasticity) const;

  const Work& WorkDone() const { return work_; }

  /// What relates t to E.
  SectionModel Model() const { return section_model_; }

  /// The triangle R of the QR factorisation of [f b a]: ||r|| = ||R (-t, nu,
  /// 1)^T||.
  const Eigen::Matrix3d& Triangle() const { return triangle_; }

  /// Noise level, noise bias and covariance of an estimate of this residual.
  /// `free_youngs_modulus` and `free_poisson_ratio` say which parameters were
  /// estimated (not given, not held by a bound).  Fills in the noise, residual
  /// and covariance entries of `estimate`, and what there is to judge of them.
  void Describe(bool free_youngs_modulus, bool free_poisson_ratio,
                Evidence& evidence, Estimate& estimate) const;

  /// AllowForYoungsModulusOnBound with what the residual says about a free E.
  ErrorsOnBound AllowForYoungsModulusOnBound(const EstimatorOptions& options,
                                             Estimate& estimate) const;

  /// The minimiser without the bias of displacement noise (errors in
  /// variables): its nu, or empty when the noise hides it.
  std::optional<double> UnbiasedPoissonRatio() const;

  /// The standard error of UnbiasedPoissonRatio to first order in the noise;
  /// empty when the noise makes up half of b or more.
  std::optional<double> UnbiasedPoissonRatioError() const;

  /// Estimate of the variance of the weighted noise from the residual at this
  /// nu, with the t that fits it; empty when there are too few equations.
  /// `free_poisson_ratio` says whether nu was fitted to this residual.
  std::optional<double> ResidualVariance(double poisson_ratio,
                                         bool free_poisson_ratio) const;

  /// T without the directions that t fits: rows and columns (a, b).
  Eigen::Matrix2d ProjectedTraces() const;

  /// nu of total least squares [Golub & Van Loan 1980], the unbiased one when
  /// the noise is not known.  With a~ and b~ the parts of a and b that are
  /// orthogonal to the loads, and T the ProjectedTraces,
  ///
  ///   M = [a~ b~]^T [a~ b~],   E M = M0 + sigma^2 T,
  ///
  /// it is the nu of (M - s T) (1, nu)^T = 0, where s, the smaller root of
  /// det(M - s T) = 0, estimates sigma^2.
  double ErrorsInVariablesPoissonRatio() const;

  /// The free degrees of freedom times the load cases.
  Eigen::Index NumEquations() const { return num_equations_; }

 private:
  /// Of a = H q and b = J q, the loads f, and the products with b and f.
  void Compress(const Scene& scene, const Eigen::Ref<const Eigen::MatrixXd>& a,
                const Eigen::Ref<const Eigen::MatrixXd>& b,
                const Eigen::Ref<const Eigen::MatrixXd>& f,
                const StiffnessProducts& of_b,
                const Eigen::Ref<const Eigen::MatrixXd>& hf,
                const Eigen::Ref<const Eigen::MatrixXd>& jf);
  /// The variance of the weighted noise for the standard errors: as given, or
  /// from the residual where nothing is given or the residual contradicts it,
  /// which is evidence.  Fills in the noise of `estimate`, or the reason why
  /// there are no standard errors when it is empty.
  std::optional<double> DescribeNoise(bool free_youngs_modulus,
                                      bool free_poisson_ratio,
                                      Evidence& evidence,
                                      Estimate& estimate) const;
  /// Variance of the weighted noise from the residual: at the estimate with E
  /// on a bound, else from the smallest singular value of the noise-normalised
  /// residual.
  std::optional<double> NoiseVariance(const Estimate& estimate,
                                      bool free_youngs_modulus,
                                      bool free_poisson_ratio) const;
  /// Gram matrix of A(nu) [b f].
  Eigen::Matrix2d StiffenedGram(double poisson_ratio) const;
  /// Derivatives of Q^T r by (E, nu), where Q is that of Triangle.
  Eigen::Matrix2d Jacobian(const IsotropicElasticity& elasticity) const;
  Eigen::Matrix2d Covariance(const IsotropicElasticity& elasticity,
                             double noise_variance, bool free_youngs_modulus,
                             bool free_poisson_ratio) const;

  SectionModel section_model_;
  Eigen::Matrix3d triangle_;
  /// Sum of StiffnessTraces over the load cases.
  Eigen::Matrix2d traces_;
  /// Gram matrix of [H b, J b, H f, J f].
  Eigen::Matrix4d product_gram_;
  Eigen::Index num_equations_;
  /// Standard deviation of the noise of the first load case, when known.
  std::optional<double> known_noise_sd_;
  Work work_;
};

/// A preparation that makes the force residual of each measurement, and of it
/// an estimate.
std::unique_ptr<Preparation> PrepareForceResidual(
    const Scene& scene, const EstimatorOptions& options,
    Estimate (*estimate)(const ForceResidual& residual, const Scene& scene,
                         const EstimatorOptions& options));

/// For a given nu: what the data ask for instead; empty when they do not say.
std::optional<UnbiasedPoissonRatio> MeasureUnbiasedPoissonRatio(
    const ForceResidual& residual, const Estimate& estimate);

/// The bias that displacement noise puts on `estimate`: its distance to
/// UnbiasedPoissonRatio.  The square of the bias is added to the covariance.
/// `bounds` are those that the estimate of nu had to keep.
NoiseBias MeasureNoiseBias(const ForceResidual& residual, const Bounds& bounds,
                           Estimate& estimate);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_FORCE_BALANCE_FORCE_RESIDUAL_H_
