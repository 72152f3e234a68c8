#include "elastimate/core/equilibrium/refined_stiffness.h"

#include <limits>

#include "elastimate/core/solvers/conjugate_gradients.h"

namespace elastimate {

RefinedStiffness::RefinedStiffness(const std::vector<const Mesh*>& meshes,
                                   const std::vector<const Supports*>& supports,
                                   SolverKind solver,
                                   const StiffnessSolver* shared)
    : SupportedStiffness(*supports.back()),
      coarsest_(shared == nullptr ? StiffnessSolver(*meshes.front(),
                                                    *supports.front(), solver)
                                  : shared->Sharing()),
      make_finest_([mesh = meshes.back(), held = supports.back(), solver] {
        return std::make_unique<StiffnessSolver>(*mesh, *held, solver);
      }) {
  for (std::size_t i = 0; i + 1 < supports.size(); ++i) {
    held_rows_of_coarser_.push_back(HeldRowsOn(*supports[i]));
  }
}

bool RefinedStiffness::Factorize(const NestedStiffness& stiffness,
                                 bool /*with_held_rows*/) {
  stiffness_ = &stiffness;
  if (finest_) {
    return FactorizeFinest();
  }
  const auto make_blocks = [&stiffness, this] {
    return stiffness.Blocks(0, coarsest_.Graph());
  };
  if (!coarsest_.FactorizeBlocks(make_blocks)) {
    return false;
  }
  coarsest_.KeepPreconditioner();
  return SetUpCycle();
}

bool RefinedStiffness::SetUpCycle() {
  cycle_.clear();
  for (std::size_t i = 1; i <= Finest(); ++i) {
    CycleSpace& space = cycle_.emplace_back();
    space.largest_eigenvalue = stiffness_->LargestEigenvalue(i);
    if (!(space.largest_eigenvalue > 0)) {
      return false;
    }
    space.inverse_blocks = stiffness_->InverseBlocks(i);
    HoldInInverses(HeldRowsIn(i), space.inverse_blocks);
    space.multiply = [this, i](const Eigen::MatrixXd& x) {
      return Multiply(i, x);
    };
    const FinerNodes& nodes = stiffness_->NodesAfter(i - 1);
    space.restrict = [this, i, &nodes](const Eigen::MatrixXd& x) {
      return OfFree(i - 1, nodes.Restrict(x));
    };
    space.interpolate = [this, i, &nodes](const Eigen::MatrixXd& x) {
      return OfFree(i, nodes.Interpolate(x));
    };
  }
  return true;
}

bool RefinedStiffness::FactorizeFinest() {
  return finest_->FactorizeBlocks(
      stiffness_->Blocks(Finest(), finest_->Graph()));
}

ConjugateGradientResult RefinedStiffness::Iterate(Eigen::MatrixXd all,
                                                  Eigen::MatrixXd start) {
  if (start.size() > 0) {
    start = OfFree(Finest(), std::move(start));
  }
  ConjugateGradientOptions options;
  options.tolerance = Tolerance();
  options.most_iterations = kMostIterations;
  options.smallest_eigenvalue = smallest_eigenvalue_;
  ConjugateGradientResult result = SolveByConjugateGradients(
      [&](const Eigen::MatrixXd& x) { return Multiply(Finest(), x); },
      [&](const Eigen::MatrixXd& x) { return Cycle(x); },
      OfFree(Finest(), std::move(all)), std::move(start), options);
  work_.iterations += result.iterations;
  return result;
}

Eigen::MatrixXd RefinedStiffness::Solve(Eigen::MatrixXd all,
                                        Eigen::MatrixXd start) {
  work_.solves += static_cast<int>(all.cols());
  if (finest_) {
    return finest_->Solve(all, StiffnessSolver::kAccurate, start);
  }
  ConjugateGradientResult result = Iterate(std::move(all), std::move(start));
  // Coarse spaces may be those of other moduli.
  if (!result.has_converged && coarsest_.Renew()) {
    const Eigen::MatrixXd found = std::move(result.solution);
    result = Iterate(std::move(result.residual), {});
    result.solution += found;
  }
  if (!result.has_converged) {
    finest_ = make_finest_();
    result.solution += FactorizeFinest()
                           ? finest_->Solve(result.residual)
                           : Eigen::MatrixXd::Constant(
                                 result.solution.rows(), result.solution.cols(),
                                 std::numeric_limits<double>::quiet_NaN());
    return std::move(result.solution);
  }
  smallest_eigenvalue_ = result.smallest_eigenvalue;
  return std::move(result.solution);
}

Eigen::MatrixXd RefinedStiffness::Precondition(const Eigen::MatrixXd& all) {
  if (finest_) {
    return finest_->Solve(all);
  }
  return Cycle(all);
}

Eigen::MatrixXd RefinedStiffness::Multiply(std::size_t space,
                                           const Eigen::MatrixXd& x) {
  if (space == Finest()) {
    ++work_.element_passes;
  }
  return OfFree(space, stiffness_->Multiply(space, x));
}

Eigen::MatrixXd RefinedStiffness::OfFree(std::size_t space,
                                         Eigen::MatrixXd values) const {
  values(HeldRowsIn(space), Eigen::all).setZero();
  return values;
}

Eigen::MatrixXd RefinedStiffness::Cycle(const Eigen::MatrixXd& force) {
  return VCycle(
      cycle_,
      [&](const Eigen::MatrixXd& x) { return coarsest_.Precondition(x); },
      force);
}

Eigen::MatrixXd RefinedStiffness::HeldForces(
    const Eigen::MatrixXd& displacements) const {
  return OfHeld(stiffness_->Multiply(Finest(), displacements));
}

Eigen::MatrixXd RefinedStiffness::HeldForcesTransposed(
    const Eigen::MatrixXd& held) const {
  return stiffness_->Multiply(Finest(), OfHeld(held));
}

Work RefinedStiffness::WorkDone() const {
  Work of_solvers = coarsest_.WorkDone();
  of_solvers.element_passes = 0;
  if (finest_) {
    of_solvers = of_solvers + finest_->WorkDone();
  }
  of_solvers.solves = 0;
  return of_solvers + work_;
}

}  // namespace elastimate
