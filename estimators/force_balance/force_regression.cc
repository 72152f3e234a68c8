#include "elastimate/estimators/force_balance/force_regression.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "elastimate/core/algebra/dense_algebra.h"
#include "elastimate/core/algebra/node_sums.h"
#include "elastimate/core/algebra/row_block_qr.h"
#include "elastimate/core/mechanics/internal_forces.h"
#include "elastimate/core/mechanics/stiffness_traces.h"
#include "elastimate/core/scene/degrees_of_freedom.h"
#include "elastimate/estimators/force_balance/force_residual.h"
#include "elastimate/estimators/interface/free_parameters.h"
#include "elastimate/estimators/interface/judge.h"
#include "elastimate/estimators/interface/limits.h"
#include "elastimate/estimators/interface/parameter_judge.h"
#include "elastimate/estimators/statistics/bounded_variables.h"

namespace elastimate {
namespace {

// Of columns scaled to norm 1: what is smaller is rounding.
constexpr double kDependentColumns = 1e-11;

// [F f] of all load cases, compressed, and how noise enters it.
class Regression {
 public:
  explicit Regression(const Scene& scene)
      : scene_(scene),
        dofs_(scene.supports),
        forces_(scene.mesh, scene.materials),
        cases_(WeightLoadCases(scene)) {
    const Eigen::Index m = forces_.Parameters().NumModuli();
    RowBlockQr qr(m + 1);
    for (Eigen::Index k = 0; k < cases_.q.cols(); ++k) {
      const Eigen::MatrixXd columns = forces_.Columns(cases_.q.col(k));
      ++work_.element_passes;
      for (const Eigen::Index dof : dofs_.free) {
        qr.NextRow() << columns.row(dof), cases_.f(dof, k);
      }
    }
    const Eigen::MatrixXd triangle = qr.Triangle();
    columns_ = triangle.leftCols(m);
    loads_ = triangle.col(m);
    MeasureTraces();
  }

  /// R theta - Q^T f has the norm of the residual: (m + 1) rows.
  const Eigen::MatrixXd& Columns() const { return columns_; }
  const Eigen::VectorXd& Loads() const { return loads_; }
  /// Sum over the load cases of T, by random probes.
  const Eigen::MatrixXd& Traces() const { return traces_; }
  double NumEquations() const {
    return static_cast<double>(dofs_.NumFree() * cases_.q.cols());
  }
  Work WorkDone() const { return work_; }

  /// The unconstrained minimum; empty when the columns are not independent.
  std::optional<Eigen::VectorXd> LeastSquares() const {
    const Eigen::VectorXd scales = columns_.colwise().norm();
    if (!(scales.minCoeff() > 0)) {
      return std::nullopt;
    }
    const Eigen::MatrixXd scaled =
        columns_ * scales.cwiseInverse().asDiagonal();
    const SingularValueDecomposition svd = DecomposeSingularValues(scaled);
    if (!(svd.values(svd.values.size() - 1) > kDependentColumns)) {
      return std::nullopt;
    }
    return Eigen::VectorXd(
        SolveLeastSquares(scaled, loads_).col(0).cwiseQuotient(scales));
  }

  /// Sum over the load cases of (K F B)^T (K F B) on the free rows, for
  /// directions B of theta.
  Eigen::MatrixXd StiffenedGram(const Eigen::VectorXd& moduli,
                                const Eigen::MatrixXd& directions) {
    Eigen::MatrixXd gram =
        Eigen::MatrixXd::Zero(directions.cols(), directions.cols());
    for (Eigen::Index k = 0; k < cases_.q.cols(); ++k) {
      const Eigen::MatrixXd free_forces =
          dofs_.Restrict(forces_.Columns(cases_.q.col(k)) * directions);
      const Eigen::MatrixXd stiffened =
          dofs_.Restrict(forces_.Multiply(moduli, dofs_.Extend(free_forces)));
      work_.element_passes += 2;
      gram += InnerProducts(stiffened, stiffened);
    }
    return gram;
  }

 private:
  void MeasureTraces() {
    constexpr Eigen::Index kProbes = 2;
    Eigen::MatrixXd probes(scene_.mesh.NumDofs(), kProbes);
    SetTraceProbes(scene_.supports.held, probes);
    traces_.setZero(columns_.cols(), columns_.cols());
    for (Eigen::Index k = 0; k < kProbes; ++k) {
      const Eigen::MatrixXd columns =
          dofs_.Restrict(forces_.Columns(probes.col(k)));
      ++work_.element_passes;
      traces_ +=
          double(cases_.q.cols()) / kProbes * InnerProducts(columns, columns);
    }
  }

  const Scene& scene_;
  DegreesOfFreedom dofs_;
  InternalForces forces_;
  WeightedLoadCases cases_;
  Eigen::MatrixXd columns_;
  Eigen::VectorXd loads_;
  Eigen::MatrixXd traces_;
  Work work_;
};

// A fit, and where it ended.
struct RegressionFit {
  Eigen::VectorXd variables;
  Eigen::VectorXd moduli;
};

// The modulus that is known, else the factor on all of typical ones that fits
// best; 1 where there is none.
double ScaleOfModuli(const Regression& regression, const FreeParameters& free) {
  if (const std::optional<double> known = free.All().KnownModulus()) {
    return *known;
  }
  const Eigen::VectorXd typical = free.VariablesOf(free.All().Typical(1));
  const Eigen::VectorXd predicted =
      regression.Columns() * free.ModuliAt(typical);
  const double scale =
      InnerProduct(predicted, regression.Loads()) / SquaredNorm(predicted);
  return scale > 0 ? scale : 1;
}

// Within bounds, by Ceres.
RegressionFit SearchMinimum(const Regression& regression,
                            const FreeParameters& free, Evidence& evidence,
                            Estimate& estimate, const Scene& scene) {
  const Eigen::VectorXd start =
      free.VariablesOf(free.All().Typical(ScaleOfModuli(regression, free)));
  const double norm = regression.Loads().norm();
  const ResidualFunction residual = [&](const Eigen::VectorXd& x,
                                        Eigen::VectorXd* r,
                                        Eigen::MatrixXd* jacobian) {
    *r = (regression.Columns() * free.ModuliAt(x) - regression.Loads()) / norm;
    if (jacobian != nullptr) {
      *jacobian = regression.Columns() * free.ModuliJacobian(x) / norm;
    }
    return r->allFinite();
  };
  // So few residuals cost nothing: iterate to rounding.
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = 500;
  options.function_tolerance = 0;
  options.gradient_tolerance = 1e-16;
  options.parameter_tolerance = 1e-14;
  options.logging_type = ceres::SILENT;
  const BoundedMinimum minimum =
      MinimizeOverVariables(residual, regression.Columns().rows(),
                            free.VariableBounds(), start, options);
  evidence.end = minimum.end;
  evidence.search_message = minimum.message;
  EnterParameters(scene, free, free.ParametersAt(minimum.variables), estimate);
  NoteVariablesOnBounds(free, minimum, evidence, estimate);
  return {minimum.variables, free.ModuliAt(minimum.variables)};
}

// The variance of the weighted noise.
double NoiseVariance(const Scene& scene, const Regression& regression,
                     const RegressionFit& fit, double num_free,
                     Evidence& evidence, Estimate& estimate) {
  const double square_sum =
      (regression.Columns() * fit.moduli - regression.Loads()).squaredNorm();
  const double share = fit.moduli.dot(regression.Traces() * fit.moduli) *
                       std::max(1.0, regression.NumEquations() - num_free) /
                       regression.NumEquations();
  const double variance = square_sum / share;
  const std::optional<double>& given = scene.load_cases.front().noise_sd;
  estimate.noise_sd = given.value_or(std::sqrt(variance));
  if (!given) {
    return variance;
  }
  if (std::sqrt(variance) > kLimits.excess_force_residual) {
    evidence.above_noise = {ResidualKind::kForce, std::sqrt(variance)};
    return variance;
  }
  return 1;
}

// Enters covariance and bias of the variables.
void DescribeErrors(const FreeParameters& free, const RegressionFit& fit,
                    double variance, Regression& regression,
                    Estimate& estimate) {
  const Eigen::MatrixXd directions = free.ModuliJacobian(fit.variables);
  const Eigen::MatrixXd x = regression.Columns() * directions;
  const Eigen::MatrixXd inverse = Inverse(x.transpose() * x);
  Eigen::MatrixXd covariance =
      variance * inverse * regression.StiffenedGram(fit.moduli, directions) *
      inverse;
  estimate.error_budget.noise =
      ErrorsOfVariables(free, fit.variables, covariance);

  // Without the noise in F^T F.
  const Eigen::MatrixXd noise =
      variance * directions.transpose() * regression.Traces() * directions;
  const Eigen::VectorXd pull =
      variance * directions.transpose() * (regression.Traces() * fit.moduli);
  const Eigen::MatrixXd clean = x.transpose() * x - noise;
  const bool is_hidden =
      !(DecomposeSymmetric(clean, x.transpose() * x).values(0) > 0);
  const Eigen::VectorXd bias =
      is_hidden ? Eigen::VectorXd::Constant(
                      pull.size(), std::numeric_limits<double>::infinity())
                : Eigen::VectorXd(Inverse(clean) * pull);
  estimate.error_budget.bias =
      ErrorsOfVariables(free, fit.variables, bias * bias.transpose());
  if (!is_hidden) {
    covariance += bias * bias.transpose();
  }
  EnterCovariance(free, fit.variables, covariance, estimate);
}

}  // namespace

Estimate RegressForces(const Scene& scene, const EstimatorOptions& options,
                       bool is_bounded) {
  Estimate estimate;
  Evidence evidence;
  Regression regression(scene);
  const FreeParameters free(scene, options);
  const bool is_linear = free.Size() == free.All().NumParameters();
  const std::optional<Eigen::VectorXd> moduli = regression.LeastSquares();
  RegressionFit fit;
  if (!is_bounded && is_linear && moduli) {
    const Eigen::VectorXd parameters = free.All().ParametersOf(*moduli);
    fit = {free.VariablesOf(parameters), *moduli};
    // As they are: those that are not physical, too.
    EnterParameters(scene, free, parameters, estimate);
  } else {
    fit = SearchMinimum(regression, free, evidence, estimate, scene);
  }
  estimate.force_residual =
      (regression.Columns() * fit.moduli - regression.Loads()).norm() /
      regression.Loads().norm();
  if (!moduli && is_linear) {
    evidence.are_forces_dependent = true;
  } else if (fit.variables.allFinite()) {
    DescribeErrors(free, fit,
                   NoiseVariance(scene, regression, fit, double(free.Size()),
                                 evidence, estimate),
                   regression, estimate);
  }
  estimate.work = regression.WorkDone();
  Judge(evidence, options, estimate);
  return estimate;
}

}  // namespace elastimate
