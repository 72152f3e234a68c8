#include "elastimate/estimators/force_balance/virtual_work_regression.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "elastimate/estimators/force_balance/force_residual.h"
#include "elastimate/estimators/force_balance/monomials.h"

namespace elastimate {
namespace {

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

bool AreIsotropic(const MaterialParameters& parameters) {
  for (std::size_t i = 0; i < parameters.NumMaterials(); ++i) {
    if (!parameters.LawOf(i).BlockEntries().empty()) {
      return false;
    }
  }
  return true;
}

BoundedMinimum MinimizeFrom(const FreeParameters& free,
                            const Eigen::VectorXd& start, int max_iterations,
                            double unit, WorkBalance& balance) {
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

// The degree unless another is asked for.
int UsualDegree(const Scene& scene) {
  constexpr Eigen::Index kFewParameters = 2;
  return scene.materials.size() > kMostOfCubics ||
                 MaterialParameters(scene.materials, scene.mesh.section.model)
                         .NumParameters() <= kFewParameters
             ? 2
             : 3;
}

VirtualWork FieldsOfDegree(const Scene& scene, const EstimatorOptions& options,
                           int degree, const Eigen::MatrixXd& windows) {
  return VirtualWork(scene.mesh, scene.supports,
                     options.virtual_field_degree.value_or(degree), windows);
}

// What is near enough to start from: of many materials linear polynomials,
// where these leave twice as many equations as there is to find, since the
// whole of a specimen shows too little of each.  Of fewer materials with a
// contrast of thousands these would lead farther astray.
VirtualWork FieldsOfStart(const Scene& scene, const EstimatorOptions& options) {
  const int degree = UsualDegree(scene);
  if (scene.materials.size() <= kMostOfCubics) {
    return FieldsOfDegree(scene, options, degree, {});
  }
  const Eigen::Index dimension = scene.mesh.Dimension();
  const Eigen::Index num_equations =
      NumMonomials(dimension, 1) * dimension *
      Eigen::Index(scene.materials.size() * scene.load_cases.size());
  const bool is_linear_enough =
      num_equations >= 2 * FreeParameters(scene, options).Size();
  return FieldsOfDegree(scene, options, is_linear_enough ? 1 : degree,
                        WindowsOf(scene));
}

}  // namespace

VirtualWork FieldsOfMaterials(const Scene& scene,
                              const EstimatorOptions& options) {
  // Polynomials over the whole of a specimen hardly tell materials apart.
  return FieldsOfDegree(
      scene, options, UsualDegree(scene),
      scene.materials.size() > 1 ? WindowsOf(scene) : Eigen::MatrixXd());
}

std::optional<BoundedMinimum> MinimizeWorkBalance(const FreeParameters& free,
                                                  int max_iterations,
                                                  const ForceResidual& forces,
                                                  WorkBalance& balance) {
  // Ceres' tolerances ask for displacements of this unit.
  const double unit = forces.DisplacementNorm();
  if (!AreIsotropic(free.All()) || forces.Prepared().LargeForces() != nullptr) {
    // Where there are many moduli, or strains are large, typical values are far
    // off, and those which balance the work without weights are near.
    if (const std::optional<Eigen::VectorXd> start =
            free.VariablesOfModuli(balance.LeastSquares())) {
      return MinimizeFrom(free, *start, max_iterations, unit, balance);
    }
  }
  std::optional<BoundedMinimum> best;
  std::optional<Eigen::VectorXd> last;
  for (const double poisson_ratio : {0.3, 0.0, 0.45}) {
    const std::optional<Eigen::VectorXd> start =
        Start(free, poisson_ratio, balance);
    // Laws without such ratios have one start.
    if (start && start != last) {
      last = start;
      BoundedMinimum minimum =
          MinimizeFrom(free, *start, max_iterations, unit, balance);
      if (!best || minimum.cost < best->cost) {
        best = std::move(minimum);
      }
    }
  }
  return best;
}

std::optional<BoundedMinimum> MinimizeVirtualWork(
    const Scene& scene, const EstimatorOptions& options, Work& work) {
  const VirtualWork fields = FieldsOfStart(scene, options);
  const ForceScene prepared(scene);
  const ForceResidual forces(prepared, scene);
  const FreeParameters free(scene, options);
  WorkBalance balance(fields, forces);
  std::optional<BoundedMinimum> best;
  if (balance.NumEquations() > free.Size()) {
    best = MinimizeWorkBalance(free, options.max_iterations, forces, balance);
  }
  work = work + forces.WorkDone() + balance.WorkDone();
  // The fields.
  ++work.element_passes;
  return best;
}

}  // namespace elastimate
