#include "elastimate/estimators/force_balance/virtual_work_regression.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "elastimate/core/algebra/dense_algebra.h"
#include "elastimate/core/algebra/node_sums.h"
#include "elastimate/core/mechanics/internal_forces.h"
#include "elastimate/core/mechanics/stiffness_traces.h"
#include "elastimate/core/scene/degrees_of_freedom.h"
#include "elastimate/core/scene/loads.h"
#include "elastimate/estimators/force_balance/force_residual.h"
#include "elastimate/estimators/force_balance/virtual_work.h"
#include "elastimate/estimators/interface/free_parameters.h"
#include "elastimate/estimators/interface/judge.h"
#include "elastimate/estimators/interface/limits.h"
#include "elastimate/estimators/interface/parameter_judge.h"
#include "elastimate/estimators/interface/stopwatch.h"
#include "elastimate/estimators/statistics/bounded_variables.h"

namespace elastimate {
namespace {

// Of polynomials: several materials need more fields than one.
constexpr int kDefaultDegree = 3;

// The balance of virtual work of a measurement.
class WorkBalance {
 public:
  WorkBalance(const Scene& scene, const VirtualWork& work)
      : dofs_(scene.supports),
        forces_(scene.mesh, scene.materials),
        work_(work),
        fields_(work.Fields()) {
    auto [q, f] = WeightLoadCases(scene);
    q_ = std::move(q);
    f_ = dofs_.Restrict(f);
    for (Eigen::Index k = 0; k < q_.cols(); ++k) {
      columns_.push_back(forces_.Columns(q_.col(k)));
      work_of_columns_.push_back(work.Of(columns_.back()));
      ++work_done_.element_passes;
    }
    work_of_loads_ = work.Of(f);
  }

  Eigen::Index NumEquations() const { return work_of_loads_.size(); }
  const Work& WorkDone() const { return work_done_; }

  /// L^-1 r of all load cases, and its derivative by theta along directions.
  bool Evaluate(const Eigen::VectorXd& moduli,
                const Eigen::MatrixXd& directions, Eigen::VectorXd* residual,
                Eigen::MatrixXd* jacobian) {
    ++work_done_.element_passes;
    const Eigen::MatrixXd stiffened =
        dofs_.Restrict(forces_.Multiply(moduli, fields_));
    const Eigen::MatrixXd upper = TriangularFactor(stiffened);
    if (!(upper.diagonal().cwiseAbs().minCoeff() > 0) || !upper.allFinite()) {
      return false;
    }
    const Eigen::Index k = upper.cols();
    residual->resize(NumEquations());
    if (jacobian != nullptr) {
      jacobian->resize(NumEquations(), directions.cols());
    }
    const auto lower = upper.transpose().triangularView<Eigen::Lower>();
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      const Eigen::VectorXd z = lower.solve(Eigen::VectorXd(
          work_of_columns_[i] * moduli - work_of_loads_.col(Eigen::Index(i))));
      residual->segment(k * Eigen::Index(i), k) = z;
      if (jacobian != nullptr) {
        const Eigen::VectorXd multipliers =
            upper.triangularView<Eigen::Upper>().solve(z);
        const Eigen::VectorXd correction =
            dofs_.Extend(stiffened * multipliers);
        ++work_done_.element_passes;
        jacobian->middleRows(k * Eigen::Index(i), k) =
            lower.solve(Eigen::MatrixXd(
                (work_of_columns_[i] - work_.Of(forces_.Columns(correction))) *
                directions));
      }
    }
    return true;
  }

  /// The factor on all moduli that balances the work of all fields best.
  double BestScale(const Eigen::VectorXd& moduli) const {
    double product = 0;
    double square = 0;
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      const Eigen::VectorXd internal = work_of_columns_[i] * moduli;
      product += internal.dot(work_of_loads_.col(Eigen::Index(i)));
      square += internal.squaredNorm();
    }
    return product / square;
  }

  /// The moduli that balance the work of all fields best, unweighted.
  Eigen::VectorXd LeastSquares() const {
    const Eigen::Index k = work_of_loads_.rows();
    Eigen::MatrixXd columns(NumEquations(), work_of_columns_[0].cols());
    for (std::size_t i = 0; i < work_of_columns_.size(); ++i) {
      columns.middleRows(k * Eigen::Index(i), k) = work_of_columns_[i];
    }
    const Eigen::VectorXd scales = columns.colwise().norm();
    return SolveLeastSquares(columns * scales.cwiseInverse().asDiagonal(),
                             work_of_loads_.reshaped())
        .col(0)
        .cwiseQuotient(scales);
  }

  /// The variance of the weighted noise by the force residual: it takes as
  /// noise whatever is out of balance at single nodes.
  double ForceVariance(const Scene& scene, const Eigen::VectorXd& moduli) {
    constexpr Eigen::Index kProbes = 2;
    Eigen::MatrixXd probes(scene.mesh.NumDofs(), kProbes);
    SetTraceProbes(scene.supports.held, probes);
    const double trace =
        SquaredNorm(dofs_.Restrict(forces_.Multiply(moduli, probes))) / kProbes;
    ++work_done_.element_passes;
    return ForceResidualNorm(moduli) * ForceResidualNorm(moduli) /
           (trace * double(columns_.size()));
  }
  double ForceResidualNorm(const Eigen::VectorXd& moduli) const {
    double square_sum = 0;
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      square_sum += SquaredNorm(dofs_.Restrict(columns_[i] * moduli) -
                                f_.col(Eigen::Index(i)));
    }
    return std::sqrt(square_sum);
  }
  double LoadNorm() const { return Norm(f_); }
  double DisplacementNorm() const { return Norm(dofs_.Restrict(q_)); }

 private:
  DegreesOfFreedom dofs_;
  InternalForces forces_;
  const VirtualWork& work_;
  Eigen::MatrixXd fields_;
  Eigen::MatrixXd q_;
  Eigen::MatrixXd f_;  ///< On the free rows.
  std::vector<Eigen::MatrixXd> columns_;
  std::vector<Eigen::MatrixXd> work_of_columns_;
  Eigen::MatrixXd work_of_loads_;
  Work work_done_;
};

// Typical values but for these Poisson's ratios, at the scale of the loads;
// empty when the displacements oppose the loads.
std::optional<Eigen::VectorXd> Start(const FreeParameters& free,
                                     double poisson_ratio,
                                     const WorkBalance& balance) {
  const auto values_at = [&](double scale) {
    Eigen::VectorXd values = free.All().Typical(scale);
    for (const Eigen::Index i : free.All().Free()) {
      const LawParameter& parameter = *free.All().All()[i].law_parameter;
      if (!parameter.is_modulus && !parameter.beside) {
        values(i) = poisson_ratio;
      }
    }
    return values;
  };
  const std::optional<double> known = free.All().KnownModulus();
  const double scale =
      known ? *known : balance.BestScale(free.All().Moduli(values_at(1)));
  if (!(scale > 0)) {
    return std::nullopt;
  }
  return free.VariablesOf(values_at(scale));
}

// That of the moduli which balance the work without weights, but for what is
// known; empty where their stiffness is not positive definite.
std::optional<Eigen::VectorXd> LinearStart(const FreeParameters& free,
                                           const WorkBalance& balance) {
  Eigen::VectorXd parameters = free.All().ParametersOf(balance.LeastSquares());
  for (Eigen::Index i = 0; i < parameters.size(); ++i) {
    parameters(i) = free.All().All()[i].known.value_or(parameters(i));
  }
  const Eigen::VectorXd variables = free.VariablesOf(parameters);
  return variables.allFinite() ? std::optional<Eigen::VectorXd>(variables)
                               : std::nullopt;
}

bool AreIsotropic(const MaterialParameters& parameters) {
  for (std::size_t i = 0; i < parameters.NumMaterials(); ++i) {
    if (!parameters.LawOf(i).BlockEntries().empty()) {
      return false;
    }
  }
  return true;
}

BoundedMinimum Minimize(const FreeParameters& free,
                        const Eigen::VectorXd& start, int max_iterations,
                        WorkBalance& balance) {
  // Of displacements, for Ceres' tolerances.
  const double unit = balance.DisplacementNorm();
  const ResidualFunction residual = [&](const Eigen::VectorXd& x,
                                        Eigen::VectorXd* r,
                                        Eigen::MatrixXd* jacobian) {
    if (!balance.Evaluate(free.ModuliAt(x), free.ModuliJacobian(x), r,
                          jacobian)) {
      return false;
    }
    *r /= unit;
    if (jacobian != nullptr) {
      *jacobian /= unit;
    }
    return r->allFinite();
  };
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = max_iterations;
  options.initial_trust_region_radius = 1e8;
  options.function_tolerance = 1e-12;
  options.gradient_tolerance = 1e-14;
  options.parameter_tolerance = 1e-12;
  options.logging_type = ceres::SILENT;
  return MinimizeOverVariables(residual, balance.NumEquations(),
                               free.VariableBounds(), start, options);
}

// The best minimum that the starts lead to: near nu = 1/2 the balance has
// others.  Empty without a start.
std::optional<BoundedMinimum> BestOfStarts(const FreeParameters& free,
                                           int max_iterations,
                                           WorkBalance& balance) {
  if (!AreIsotropic(free.All())) {
    // Of many moduli, typical values are far off.
    if (const std::optional<Eigen::VectorXd> start =
            LinearStart(free, balance)) {
      return Minimize(free, *start, max_iterations, balance);
    }
  }
  std::optional<BoundedMinimum> best;
  std::optional<Eigen::VectorXd> last;
  for (const double poisson_ratio : {0.3, 0.0, 0.45}) {
    const std::optional<Eigen::VectorXd> start =
        Start(free, poisson_ratio, balance);
    // Of laws without such ratios all are one.
    if (start && start != last) {
      last = start;
      BoundedMinimum minimum = Minimize(free, *start, max_iterations, balance);
      if (!best || minimum.cost < best->cost) {
        best = std::move(minimum);
      }
    }
  }
  return best;
}

// Enters noise and covariance of a fit.
void DescribeFit(const Scene& scene, const FreeParameters& free,
                 const Eigen::VectorXd& variables, WorkBalance& balance,
                 Evidence& evidence, Estimate& estimate) {
  const Eigen::VectorXd moduli = free.ModuliAt(variables);
  Eigen::VectorXd residual;
  Eigen::MatrixXd jacobian;
  if (!balance.Evaluate(moduli, free.ModuliJacobian(variables), &residual,
                        &jacobian)) {
    evidence.end = End::kSearchFailed;
    return;
  }
  const double square_sum = residual.squaredNorm();
  const double m =
      double(std::max<Eigen::Index>(balance.NumEquations() - free.Size(), 1));
  const std::optional<double>& given = scene.load_cases.front().noise_sd;
  double variance = square_sum / m;
  estimate.noise_sd = given.value_or(std::sqrt(variance));
  if (!given) {
    estimate.noise_degrees_of_freedom = m;
  }
  estimate.force_residual =
      balance.ForceResidualNorm(moduli) / balance.LoadNorm();
  bool is_noise = false;
  if (given && variance <= 1 + kLimits.significant_score * std::sqrt(2 / m)) {
    variance = 1;
    is_noise = true;
  } else {
    if (given) {
      evidence.above_noise = {ResidualKind::kVirtualWork, std::sqrt(variance)};
    }
    const double rough = balance.ForceVariance(scene, moduli);
    is_noise =
        variance <= rough * (1 + kLimits.significant_score * std::sqrt(2 / m));
  }
  const Eigen::MatrixXd inverse = Inverse(jacobian.transpose() * jacobian);
  const Eigen::MatrixXd of_noise = variance * inverse;
  const Eigen::MatrixXd of_model = (is_noise ? 0 : square_sum) * inverse;
  estimate.error_budget.noise = ErrorsOfVariables(free, variables, of_noise);
  estimate.error_budget.model = ErrorsOfVariables(free, variables, of_model);
  estimate.is_model_in_doubt = !is_noise;
  EnterCovariance(free, variables, of_noise + of_model, estimate);
  if (!is_noise) {
    evidence.virtual_work_error =
        std::sqrt((of_noise + of_model).diagonal().maxCoeff());
  }
  evidence.correction = std::sqrt(square_sum) / balance.DisplacementNorm();
}

}  // namespace

Estimate BalanceVirtualWork(const Scene& scene,
                            const EstimatorOptions& options) {
  Estimate estimate;
  Evidence evidence;
  Stopwatch stopwatch;
  const VirtualWork work(scene.mesh, scene.supports,
                         options.virtual_field_degree.value_or(kDefaultDegree));
  estimate.stages.push_back({"prepare mesh", stopwatch.Lap()});
  const FreeParameters free(scene, options);
  WorkBalance balance(scene, work);
  evidence.load_imbalance = work.Imbalance(AssembleLoadCases(scene));
  if (balance.NumEquations() <= free.Size()) {
    evidence.are_forces_dependent = true;
    Judge(evidence, options, estimate);
    return estimate;
  }
  const std::optional<BoundedMinimum> best =
      BestOfStarts(free, options.max_iterations, balance);
  if (!best) {
    evidence.do_displacements_oppose_loads = true;
    Judge(evidence, options, estimate);
    return estimate;
  }
  const BoundedMinimum& minimum = *best;
  evidence.end = minimum.end;
  evidence.search_message = minimum.message;
  EnterParameters(scene, free, free.ParametersAt(minimum.variables), estimate);
  NoteVariablesOnBounds(free, minimum, estimate);
  DescribeFit(scene, free, minimum.variables, balance, evidence, estimate);
  estimate.work = balance.WorkDone();
  // The fields.
  ++estimate.work.element_passes;
  Judge(evidence, options, estimate);
  estimate.stages.push_back({"fit", stopwatch.Lap()});
  return estimate;
}

}  // namespace elastimate
