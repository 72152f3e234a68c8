#include "elastimate/core/equilibrium/large_strain_equilibrium.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>

#include "elastimate/core/large_strain/large_strain_law.h"
#include "elastimate/core/mechanics/internal_forces.h"
#include "elastimate/core/scene/degrees_of_freedom.h"
#include "elastimate/core/scene/loads.h"
#include "elastimate/core/text/numbers.h"

namespace elastimate {
namespace {

// A state is in equilibrium if the norm of its residual is at most this share
// of the norm of the forces of loads or supports.
constexpr double kResidual = 1e-10;
// If an iteration changes the displacement by less than this share of its size,
// only rounding is left.  In a nearly incompressible material, the rounding of
// the residual may be above kResidual.
constexpr double kRounding = 1e-12;
// At a relative residual below this, the tangent is practically that of the
// equilibrium, and is used for the remaining iterations.
constexpr double kNearby = 1e-7;
// Newton's method gives up after so many factorisations.
constexpr int kMostTangents = 20;
// After a step of the load that failed, the next one is shorter by this factor.
constexpr double kCut = 0.25;
// After a step of the load with at most so many factorisations, the next one is
// twice as long.
constexpr int kEasyIterations = 6;
constexpr double kSmallestLoadStep = 1.0 / 1024;
constexpr double kSmallestVolumeRatio = 0.01;
// A tangent that is not positive definite is made so by adding a stiffness
// against shear: the largest multiple of the shear modulus, and the factor from
// one attempt to the next.
constexpr double kMostShift = 1e4;
constexpr double kShiftFactor = 8;

// Returns the largest shear modulus of the materials.
double ShearModulusAtRest(const MaterialParameters& parameters,
                          const Eigen::VectorXd& moduli) {
  double largest = 0;
  for (std::size_t i = 0; i < parameters.NumMaterials(); ++i) {
    const Law& law = parameters.LawOf(i);
    largest = std::max(
        largest,
        LameModuliAtRest(law, moduli.segment(parameters.FirstModulus(i),
                                             law.NumModuli()))(0));
  }
  return largest;
}

}  // namespace

std::string WhyNotInEquilibrium(const LargeStrainState& state) {
  if (state.status == EquilibriumStatus::kDone) {
    return "";
  }
  const std::string reached = Percent(state.load_share) + " of the load";
  const std::string element = "element " + std::to_string(state.element);
  // Specimens that fail under a load that is nearly right reach more of it.
  constexpr double kFarTooSmall = 0.02;
  if (state.load_share < kFarTooSmall) {
    return "beyond " + reached +
           " no stable equilibrium is found, so that the loads are far too "
           "large for the specimen; check the units of the loads and of the "
           "parameters of the materials";
  }
  switch (state.status) {
    case EquilibriumStatus::kDone:
      break;
    case EquilibriumStatus::kUnstable:
      return "beyond " + reached +
             " the equilibrium is unstable, so that the specimen buckles or "
             "snaps (" +
             element +
             " moves most); reduce the load, or hold more of the specimen";
    case EquilibriumStatus::kInverted:
      return "beyond " + reached + " " + element +
             " is turned inside out; reduce the load, or make the mesh finer "
             "there";
    case EquilibriumStatus::kNoEquilibrium:
      break;
  }
  return "beyond " + reached + " no equilibrium is found (" + element +
         " is deformed most); reduce the load, or check the parameters of the "
         "materials";
}

LargeStrainEquilibrium::LargeStrainEquilibrium(const Scene& scene,
                                               Dilatation dilatation,
                                               KeptFactors kept)
    : scene_(scene),
      forces_(scene.mesh, scene.materials, dilatation),
      load_(scene.mesh.NumDofs(), scene.load_cases.size()),
      held_displacement_(load_.rows(), load_.cols()) {
  for (Eigen::Index k = 0; k < load_.cols(); ++k) {
    const std::vector<elastimate::Load>& loads = scene.load_cases[k].loads;
    std::vector<elastimate::Load> dead;
    std::remove_copy_if(loads.begin(), loads.end(), std::back_inserter(dead),
                        Follows);
    load_.col(k) = AssembleLoads(scene.mesh, dead).reshaped();
    pressures_.emplace_back(scene.mesh, loads);
  }
  HeldGroups groups = GroupByHeld(scene);
  if (kept == KeptFactors::kOfEachCase) {
    groups.first_cases.resize(load_.cols());
    std::iota(groups.first_cases.begin(), groups.first_cases.end(), 0);
    groups.of_case.assign(groups.first_cases.begin(), groups.first_cases.end());
  }
  solver_of_case_ = groups.of_case;
  for (const Eigen::Index k : groups.first_cases) {
    solvers_.push_back(std::make_unique<StiffnessSolver>(
        scene.mesh, SupportsOf(scene, k), SolverKind::kCholesky));
  }
  for (Eigen::Index k = 0; k < load_.cols(); ++k) {
    held_displacement_.col(k) =
        elastimate::HeldDisplacement(SupportsOf(scene, k));
  }
}

Work LargeStrainEquilibrium::WorkDone() const {
  Work work;
  for (const std::unique_ptr<StiffnessSolver>& solver : solvers_) {
    work = work + solver->WorkDone();
  }
  work.element_passes += element_passes_;
  return work;
}

bool LargeStrainEquilibrium::Factorize(const Eigen::VectorXd& moduli,
                                       Eigen::Index k, double t,
                                       const Eigen::VectorXd& u,
                                       double most_shift,
                                       LargeStrainState& state) {
  StiffnessSolver& solver = TangentSolver(k);
  Eigen::MatrixXd tangent = forces_.TangentBlocks(moduli, u, solver.Graph());
  pressures_[k].AddSymmetricBlocks(u, -t, solver.Graph(), tangent);
  ++element_passes_;
  ++state.num_tangents;
  if (solver.FactorizeBlocks(tangent)) {
    return true;
  }
  if (most_shift == 0) {
    return false;
  }
  if (shear_blocks_.size() == 0) {
    const InternalForces linear(scene_.mesh, {});
    shear_blocks_ = linear.Blocks(Eigen::Vector2d(1, 0), solver.Graph());
  }
  const double shear = ShearModulusAtRest(forces_.Parameters(), moduli);
  double shift = 1;
  while (shift <= most_shift) {
    ++state.num_tangents;
    if (solver.FactorizeBlocks(tangent + shift * shear * shear_blocks_)) {
      return true;
    }
    shift *= kShiftFactor;
  }
  return false;
}

Eigen::Index LargeStrainEquilibrium::ElementOfLowestMode(
    const Eigen::VectorXd& moduli, Eigen::Index k, LargeStrainState& state) {
  constexpr int kIterations = 8;
  if (!Factorize(moduli, k, state.load_share, state.displacement, kMostShift,
                 state)) {
    return state.smallest_volume.element;
  }
  // Inverse iterations converge quickly, because the state is nearly unstable.
  Eigen::MatrixXd mode = Eigen::VectorXd::NullaryExpr(
      load_.rows(), [](Eigen::Index i) { return std::sin(double(i + 1)); });
  for (int i = 0; i < kIterations; ++i) {
    mode = TangentSolver(k).Solve(mode).normalized();
  }
  const Mesh& mesh = scene_.mesh;
  const Eigen::VectorXd of_nodes =
      mode.reshaped(mesh.Dimension(), mesh.NumNodes()).colwise().squaredNorm();
  Eigen::Index most = 0;
  double largest = 0;
  for (Eigen::Index e = 0; e < mesh.NumElements(); ++e) {
    const double sum = of_nodes(mesh.elements.col(e)).sum();
    if (sum > largest) {
      largest = sum;
      most = e;
    }
  }
  return most;
}

void LargeStrainEquilibrium::NameFailure(const Eigen::VectorXd& moduli,
                                         Eigen::Index k,
                                         LargeStrainState& state) {
  // Beyond the largest load that a material bears, Newton's method turns
  // elements inside out that are far from flat at that load.
  constexpr double kNearlyFlat = 0.2;
  if (state.status == EquilibriumStatus::kInverted &&
      forces_.SmallestVolumeRatio(state.displacement).value > kNearlyFlat) {
    state.status = EquilibriumStatus::kNoEquilibrium;
  }
  state.element = state.status == EquilibriumStatus::kUnstable
                      ? ElementOfLowestMode(moduli, k, state)
                      : state.smallest_volume.element;
}

EquilibriumStatus LargeStrainEquilibrium::Newton(const Eigen::VectorXd& moduli,
                                                 Eigen::Index k, double t,
                                                 LargeStrainState& state,
                                                 Eigen::VectorXd& u) {
  StiffnessSolver& solver = TangentSolver(k);
  const DegreesOfFreedom& dofs = solver.Dofs();
  // What the held degrees of freedom have yet to move; zero in the free rows.
  Eigen::VectorXd held_change =
      t * held_displacement_.col(k) - (u - dofs.Extend(dofs.Restrict(u)));
  const int tangents_before = state.num_tangents;
  double last_change = std::numeric_limits<double>::infinity();
  double last_size = std::numeric_limits<double>::infinity();
  bool has_nearby_tangent = false;
  for (;;) {
    const Eigen::VectorXd forces = forces_.Forces(moduli, u);
    ++element_passes_;
    const Eigen::VectorXd load = t * LoadAt(k, u);
    const Eigen::VectorXd residual = dofs.Restrict(load - forces);
    const double scale = std::max(
        load.norm(), (forces - dofs.Extend(dofs.Restrict(forces))).norm());
    const bool is_held = held_change.isZero(0);
    if (!residual.allFinite()) {
      return EquilibriumStatus::kNoEquilibrium;
    }
    const bool is_equilibrium =
        is_held && (residual.norm() <= kResidual * scale ||
                    last_change <= kRounding * u.norm());
    const double size = residual.norm() / scale;
    if (!has_nearby_tangent || size > last_size / 2) {
      const int tangents = state.num_tangents;
      if (!Factorize(moduli, k, t, u, is_equilibrium ? 0 : kMostShift, state)) {
        return EquilibriumStatus::kUnstable;
      }
      const bool is_shifted = state.num_tangents > tangents + 1;
      has_nearby_tangent = !is_shifted && is_held && size <= kNearby;
    }
    last_size = size;
    if (is_equilibrium) {
      return EquilibriumStatus::kDone;
    }
    if (state.num_tangents - tangents_before >= kMostTangents) {
      return EquilibriumStatus::kNoEquilibrium;
    }
    Eigen::VectorXd right = dofs.Extend(residual);
    if (!is_held) {
      right -= forces_.TangentProducts(moduli, u, held_change);
    }
    const Eigen::VectorXd change = solver.Solve(right) + held_change;
    // A shortened iteration moves the supports by the same share of their way,
    // and leaves the rest to later iterations.
    double factor = 1;
    for (;; factor /= 2) {
      state.smallest_volume = forces_.SmallestVolumeRatio(u + factor * change);
      if (state.smallest_volume.value > kSmallestVolumeRatio) {
        break;
      }
      constexpr double kSmallestFactor = 1.0 / 64;
      if (factor <= kSmallestFactor) {
        return EquilibriumStatus::kInverted;
      }
    }
    u += factor * change;
    last_change = change.norm();
    held_change *= 1 - factor;
  }
}

LargeStrainState LargeStrainEquilibrium::SolveFrom(
    const Eigen::VectorXd& start, const Eigen::VectorXd& moduli,
    Eigen::Index k) {
  LargeStrainState state;
  state.displacement = start;
  state.num_steps = 1;
  state.smallest_volume = forces_.SmallestVolumeRatio(start);
  state.status = state.smallest_volume.value > kSmallestVolumeRatio
                     ? Newton(moduli, k, 1, state, state.displacement)
                     : EquilibriumStatus::kInverted;
  state.load_share = state.status == EquilibriumStatus::kDone ? 1 : 0;
  state.element = state.smallest_volume.element;
  return state;
}

LargeStrainState LargeStrainEquilibrium::Solve(
    const Eigen::VectorXd& moduli, Eigen::Index k, int most_tangents,
    const std::function<void(double)>& progress) {
  LargeStrainState state;
  state.displacement = Eigen::VectorXd::Zero(load_.rows());
  double step = 1;
  while (state.load_share < 1) {
    const double t = std::min(1.0, state.load_share + step);
    Eigen::VectorXd u = state.displacement;
    const int tangents_before = state.num_tangents;
    if (progress && state.num_steps > 0) {
      progress(state.load_share);
    }
    ++state.num_steps;
    state.status = Newton(moduli, k, t, state, u);
    if (state.status == EquilibriumStatus::kDone) {
      state.load_share = t;
      state.displacement = u;
      if (state.num_tangents - tangents_before <= kEasyIterations) {
        step *= 2;
      }
    } else {
      step = (t - state.load_share) * kCut;
      if (step < kSmallestLoadStep || state.num_tangents > most_tangents) {
        NameFailure(moduli, k, state);
        return state;
      }
    }
  }
  state.smallest_volume = forces_.SmallestVolumeRatio(state.displacement);
  return state;
}

LargeStrainSolution SolveLoadCases(
    const Eigen::VectorXd& moduli, LargeStrainEquilibrium& model,
    const std::function<void(const std::string&)>& progress) {
  const Eigen::Index num_cases = model.Load().cols();
  LargeStrainSolution solution;
  solution.displacement.resize(model.Load().rows(), num_cases);
  solution.imbalance.resize(model.Load().rows(), num_cases);
  for (Eigen::Index k = 0; k < num_cases; ++k) {
    const std::string load_case = "load case " + std::to_string(k + 1);
    const auto show_step = [&](double load_share) {
      if (progress) {
        progress(load_case + ", " + Percent(load_share) +
                 " of the load reached");
      }
    };
    if (progress) {
      progress(load_case);
    }
    const LargeStrainState state =
        model.Solve(moduli, k, std::numeric_limits<int>::max(), show_step);
    if (state.status != EquilibriumStatus::kDone) {
      solution.why_not = load_case + ": " + WhyNotInEquilibrium(state);
      return solution;
    }
    solution.displacement.col(k) = state.displacement;
    solution.imbalance.col(k) =
        model.Forces().Forces(moduli, state.displacement) -
        model.LoadAt(k, state.displacement);
  }
  return solution;
}

}  // namespace elastimate
