#include "elastimate/core/equilibrium/refined_stiffness.h"

#include <limits>

#include "elastimate/core/solvers/conjugate_gradients.h"

namespace elastimate {
namespace {

// The smoother damps eigenvalues of D^-1 K between these shares of the largest
// one, which is an estimate.  The rest is left to the coarser space.
constexpr double kUpper = 1.2;
constexpr double kLower = 0.1;
// An iterative solver of the coarsest space need not be more accurate than the
// preconditioner that it is part of.
constexpr double kCoarseTolerance = 1e-2;

}  // namespace

RefinedStiffness::RefinedStiffness(const std::vector<const Mesh*>& meshes,
                                   const std::vector<const Supports*>& supports,
                                   SolverKind solver, double tolerance)
    : SupportedStiffness(*supports.back()),
      coarsest_(*meshes.front(), *supports.front(), solver),
      make_finest_([mesh = meshes.back(), held = supports.back(), solver] {
        return std::make_unique<StiffnessSolver>(*mesh, *held, solver);
      }),
      tolerance_(tolerance) {
  for (const Supports* const of_space : supports) {
    spaces_.push_back(
        {(!of_space->held).cast<double>().matrix().reshaped(), {}});
  }
}

bool RefinedStiffness::Factorize(const NestedStiffness& stiffness,
                                 bool /*with_held_rows*/) {
  stiffness_ = &stiffness;
  if (finest_) {
    return FactorizeFinest();
  }
  if (!coarsest_.FactorizeBlocks(stiffness.CoarsestBlocks())) {
    return false;
  }
  for (std::size_t i = 1; i < spaces_.size(); ++i) {
    if (!(stiffness.LargestEigenvalue(i) > 0)) {
      return false;
    }
    spaces_[i].inverse_blocks =
        InverseBlocks(stiffness.DiagonalBlocks(i), spaces_[i].is_free);
  }
  return true;
}

bool RefinedStiffness::FactorizeFinest() {
  return finest_->FactorizeBlocks(
      stiffness_->Blocks(spaces_.size() - 1, finest_->Graph()));
}

Eigen::MatrixXd RefinedStiffness::Solve(const Eigen::MatrixXd& all,
                                        const Eigen::MatrixXd& start) {
  work_.solves += static_cast<int>(all.cols());
  if (finest_) {
    return finest_->Solve(all);
  }
  const std::size_t finest = spaces_.size() - 1;
  const Eigen::VectorXd& is_free = spaces_[finest].is_free;
  ConjugateGradientOptions options;
  options.tolerance = tolerance_;
  options.most_iterations = kMostIterations;
  options.smallest_eigenvalue = smallest_eigenvalue_;
  ConjugateGradientResult result = SolveByConjugateGradients(
      [&](const Eigen::MatrixXd& x) {
        return Eigen::MatrixXd(is_free.asDiagonal() * Multiply(finest, x));
      },
      [&](const Eigen::MatrixXd& x) { return Cycle(finest, x); },
      is_free.asDiagonal() * all,
      start.size() > 0 ? Eigen::MatrixXd(is_free.asDiagonal() * start) : start,
      options);
  work_.iterations += result.iterations;
  if (!result.has_converged) {
    finest_ = make_finest_();
    return FactorizeFinest() ? finest_->Solve(all)
                             : Eigen::MatrixXd::Constant(
                                   all.rows(), all.cols(),
                                   std::numeric_limits<double>::quiet_NaN());
  }
  smallest_eigenvalue_ = result.smallest_eigenvalue;
  return std::move(result.solution);
}

Eigen::MatrixXd RefinedStiffness::Precondition(const Eigen::MatrixXd& all) {
  if (finest_) {
    return finest_->Solve(all);
  }
  const std::size_t finest = spaces_.size() - 1;
  return Cycle(finest, spaces_[finest].is_free.asDiagonal() * all);
}

Eigen::MatrixXd RefinedStiffness::Multiply(std::size_t space,
                                           const Eigen::MatrixXd& x) {
  if (space + 1 == spaces_.size()) {
    ++work_.element_passes;
  }
  return stiffness_->Multiply(space, x);
}

Eigen::MatrixXd RefinedStiffness::RestOf(std::size_t space,
                                         const Eigen::MatrixXd& force,
                                         const Eigen::MatrixXd& x) {
  Eigen::MatrixXd rest = Multiply(space, x);
  rest = spaces_[space].is_free.asDiagonal() * (force - rest);
  return rest;
}

Eigen::MatrixXd RefinedStiffness::Smooth(std::size_t space,
                                         const Eigen::MatrixXd& force) {
  const double largest = stiffness_->LargestEigenvalue(space);
  const double middle = (kUpper + kLower) / 2 * largest;
  const double radius = (kUpper - kLower) / 2 * largest;
  const Eigen::MatrixXd& inverses = spaces_[space].inverse_blocks;
  // Two steps of the three-term recurrence from zero [Saad, Iterative Methods
  // for Sparse Linear Systems, algorithm 12.1].  The blocks are zero in the
  // held rows and columns.
  const double share = 1 / (2 * middle / radius - radius / middle);
  Eigen::MatrixXd x = MultiplyBlocks(inverses, force) / middle;
  RelaxByBlocks(inverses, force, Multiply(space, x),
                1 + share * radius / middle, 2 * share / radius, x);
  return x;
}

Eigen::MatrixXd RefinedStiffness::Cycle(std::size_t space,
                                        const Eigen::MatrixXd& force) {
  if (space == 0) {
    return coarsest_.Solve(force, kCoarseTolerance);
  }
  const FinerNodes& nodes = stiffness_->NodesAfter(space - 1);
  Eigen::MatrixXd x = Smooth(space, force);
  const Eigen::MatrixXd coarse =
      Cycle(space - 1, spaces_[space - 1].is_free.asDiagonal() *
                           nodes.Restrict(RestOf(space, force, x)));
  x += spaces_[space].is_free.asDiagonal() * nodes.Interpolate(coarse);
  x += Smooth(space, RestOf(space, force, x));
  return x;
}

Eigen::MatrixXd RefinedStiffness::HeldForces(
    const Eigen::MatrixXd& displacements) const {
  return OfHeld(stiffness_->Multiply(spaces_.size() - 1, displacements));
}

Eigen::MatrixXd RefinedStiffness::HeldForcesTransposed(
    const Eigen::MatrixXd& held) const {
  return stiffness_->Multiply(spaces_.size() - 1, OfHeld(held));
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
