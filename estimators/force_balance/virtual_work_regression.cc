#include "elastimate/estimators/force_balance/virtual_work_regression.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "elastimate/core/algebra/dense_algebra.h"
#include "elastimate/core/scene/loads.h"
#include "elastimate/estimators/force_balance/monomials.h"
#include "elastimate/estimators/force_balance/virtual_work.h"
#include "elastimate/estimators/force_balance/work_balance.h"
#include "elastimate/estimators/interface/free_parameters.h"
#include "elastimate/estimators/interface/judge.h"
#include "elastimate/estimators/interface/parameter_judge.h"
#include "elastimate/estimators/interface/stopwatch.h"
#include "elastimate/estimators/statistics/bounded_variables.h"

namespace elastimate {
namespace {

constexpr int kUsualDegree = 3;

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

// The part of the volume around each node that each material has, num_nodes x
// num_materials.
Eigen::MatrixXd WindowsOf(const Scene& scene) {
  const Mesh& mesh = scene.mesh;
  const std::vector<int> material_of =
      MaterialOfElements(scene.materials, mesh);
  const Eigen::VectorXd volumes = ElementVolumes(mesh);
  Eigen::MatrixXd windows = Eigen::MatrixXd::Zero(
      mesh.NumNodes(), Eigen::Index(scene.materials.size()));
  for (Eigen::Index e = 0; e < mesh.NumElements(); ++e) {
    for (const int node : mesh.elements.col(e)) {
      windows(node, material_of[std::size_t(e)]) += volumes(e);
    }
  }
  return windows.array().colwise() / windows.rowwise().sum().array();
}

// Quadratic polynomials tell more materials apart as well, at half as many.
constexpr std::size_t kMostOfCubics = 4;
constexpr int kDegreeOfMany = 2;

// Of this degree unless another is asked for.
VirtualWork FieldsOf(const Scene& scene, const EstimatorOptions& options,
                     int degree, const Eigen::MatrixXd& windows) {
  return VirtualWork(scene.mesh, scene.supports,
                     options.virtual_field_degree.value_or(degree), windows);
}

// Polynomials over the whole of a specimen hardly tell materials apart.
VirtualWork FieldsOfMaterials(const Scene& scene,
                              const EstimatorOptions& options) {
  if (scene.materials.size() == 1) {
    return FieldsOf(scene, options, kUsualDegree, {});
  }
  return FieldsOf(
      scene, options,
      scene.materials.size() > kMostOfCubics ? kDegreeOfMany : kUsualDegree,
      WindowsOf(scene));
}

// What is near enough to start from: of many materials linear polynomials,
// where these leave twice as many equations as there is to find, since the
// whole of a specimen shows too little of each.  Of fewer materials with a
// contrast of thousands these would lead farther astray.
VirtualWork FieldsOfStart(const Scene& scene, const EstimatorOptions& options) {
  if (scene.materials.size() <= kMostOfCubics) {
    return FieldsOf(scene, options, kUsualDegree, {});
  }
  const Eigen::Index dimension = scene.mesh.Dimension();
  const Eigen::Index num_equations =
      NumMonomials(dimension, 1) * dimension *
      Eigen::Index(scene.materials.size() * scene.load_cases.size());
  const bool is_linear_enough =
      num_equations >= 2 * FreeParameters(scene, options).Size();
  return FieldsOf(scene, options, is_linear_enough ? 1 : kDegreeOfMany,
                  WindowsOf(scene));
}

// A measurement, and the virtual fields that it is to balance.
struct Problem {
  VirtualWork work;
  FreeParameters free;
  WorkBalance balance;

  Problem(const Scene& scene, const EstimatorOptions& options,
          VirtualWork fields)
      : work(std::move(fields)), free(scene, options), balance(scene, work) {}

  bool IsDetermined() const { return balance.NumEquations() > free.Size(); }
};

// Enters what the balance says of its fit.
void DescribeFit(const Scene& scene, const Eigen::VectorXd& variables,
                 Problem& problem, Evidence& evidence, Estimate& estimate) {
  const FreeParameters& free = problem.free;
  WorkBalance& balance = problem.balance;
  const Eigen::VectorXd moduli = free.ModuliAt(variables);
  Eigen::VectorXd residual;
  Eigen::MatrixXd jacobian;
  if (!balance.Evaluate(moduli, free.ModuliJacobian(variables), &residual,
                        &jacobian)) {
    evidence.end = End::kSearchFailed;
    return;
  }
  const auto redundancy = static_cast<double>(
      std::max<Eigen::Index>(residual.size() - variables.size(), 1));
  const bool is_given = scene.load_cases.front().noise_sd.has_value();
  const double variance =
      std::max(is_given ? 1.0 : 0.0, residual.squaredNorm() / redundancy);
  estimate.noise_sd =
      is_given ? *scene.load_cases.front().noise_sd : std::sqrt(variance);
  estimate.force_residual =
      balance.ForceResidualNorm(moduli) / balance.LoadNorm();
  const Eigen::MatrixXd covariance =
      variance * Inverse(jacobian.transpose() * jacobian);
  EnterCovariance(free, variables, covariance, estimate);
  estimate.error_budget.noise = ErrorsOfVariables(free, variables, covariance);
  evidence.correction = residual.norm() / balance.DisplacementNorm();
}

}  // namespace

std::optional<BoundedMinimum> MinimizeVirtualWork(
    const Scene& scene, const EstimatorOptions& options, Work& work) {
  Problem problem(scene, options, FieldsOfStart(scene, options));
  std::optional<BoundedMinimum> best;
  if (problem.IsDetermined()) {
    best = BestOfStarts(problem.free, options.max_iterations, problem.balance);
  }
  work = work + problem.balance.WorkDone();
  // The fields.
  ++work.element_passes;
  return best;
}

Estimate BalanceVirtualWork(const Scene& scene,
                            const EstimatorOptions& options) {
  Estimate estimate;
  Evidence evidence;
  Stopwatch stopwatch;
  Problem problem(scene, options, FieldsOfMaterials(scene, options));
  estimate.stages.push_back({"prepare mesh", stopwatch.Lap()});
  evidence.load_imbalance = problem.work.Imbalance(AssembleLoadCases(scene));
  evidence.are_forces_dependent = !problem.IsDetermined();
  Judge(evidence, options, estimate);
  if (!estimate.IsUsable()) {
    return estimate;
  }
  const std::optional<BoundedMinimum> minimum =
      BestOfStarts(problem.free, options.max_iterations, problem.balance);
  if (!minimum) {
    evidence.do_displacements_oppose_loads = true;
    Judge(evidence, options, estimate);
    return estimate;
  }
  evidence.end = minimum->end;
  evidence.search_message = minimum->message;
  EnterParameters(scene, problem.free,
                  problem.free.ParametersAt(minimum->variables), estimate);
  NoteVariablesOnBounds(problem.free, *minimum, evidence, estimate);
  DescribeFit(scene, minimum->variables, problem, evidence, estimate);
  estimate.work = problem.balance.WorkDone();
  // The fields.
  ++estimate.work.element_passes;
  Judge(evidence, options, estimate);
  estimate.stages.push_back({"fit", stopwatch.Lap()});
  return estimate;
}

}  // namespace elastimate
