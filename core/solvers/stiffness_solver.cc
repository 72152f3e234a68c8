#include "elastimate/core/solvers/stiffness_solver.h"

#include <cassert>
#include <cmath>
#include <limits>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "elastimate/core/scene/rigid_motion.h"
#include "elastimate/core/solvers/cholesky.h"

namespace elastimate {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// A factorisation of so many floating-point operations for each degree of
// freedom takes about as long as multigrid takes for its set-up and some dozen
// solves.  The values are for linear and for quadratic elements.
constexpr double kMostFlops[] = {1e6, 9e6};

}  // namespace

StiffnessSolver::StiffnessSolver(const Mesh& mesh, const Supports& supports,
                                 SolverKind kind)
    : poisson_ratio_(kNaN) {
  const std::string why_not_held = WhyNotHeld(mesh, supports);
  if (!why_not_held.empty()) {
    throw std::invalid_argument(why_not_held);
  }
  assert(kind != SolverKind::kMultigrid || HasMultigrid());
  shared_ = std::make_shared<Shared>(supports);
  Shared& shared = *shared_;
  shared.assembly =
      std::make_unique<StiffnessAssembly>(mesh, shared.degrees_of_freedom);
  ++work_.element_passes;
  shared.is_multigrid = kind == SolverKind::kMultigrid;
  if (!shared.is_multigrid) {
    auto cholesky =
        std::make_unique<Cholesky>(*shared.assembly, shared.degrees_of_freedom);
    const double most_flops =
        kMostFlops[mesh.Order() - 1] *
        static_cast<double>(shared.degrees_of_freedom.NumFree());
    if (kind == SolverKind::kAutomatic &&
        cholesky->FactorizationFlops() > most_flops) {
      shared.is_multigrid = HasMultigrid();
      shared.notice =
          HasMultigrid()
              ? ""
              : "the mesh is so large that multigrid would be faster "
                "than the factorisation, but it is not available (" +
                    WhyNoMultigrid() + ")";
    }
    if (!shared.is_multigrid) {
      shared.solver = std::move(cholesky);
    }
  }
  if (shared.is_multigrid) {
    // Its set-up takes much longer than an element pass, and much memory.
    shared.assembly->ForgetBases();
    shared.solver =
        MakeMultigrid(mesh, *shared.assembly, shared.degrees_of_freedom);
    work_.ranks = NumRanksOfSolves();
  }
}

StiffnessSolver::StiffnessSolver(std::shared_ptr<Shared> shared)
    : shared_(std::move(shared)), poisson_ratio_(kNaN) {
  if (shared_->is_multigrid) {
    work_.ranks = NumRanksOfSolves();
  }
}

StiffnessSolver StiffnessSolver::Sharing() const {
  return StiffnessSolver(shared_);
}

bool StiffnessSolver::Holds(const Supports& supports) const {
  return DegreesOfFreedom(supports).place == Dofs().place;
}

bool StiffnessSolver::Factorize(double poisson_ratio) {
  if (poisson_ratio == poisson_ratio_ &&
      own_factorization_ == shared_->num_factorizations) {
    return true;
  }
  make_blocks_ = {};
  poisson_ratio_ = poisson_ratio;
  if (!(poisson_ratio > -1 && poisson_ratio < 0.5) || !MakeValues() ||
      !FactorizeValues()) {
    poisson_ratio_ = kNaN;
    return false;
  }
  return true;
}

bool StiffnessSolver::FactorizeBlocks(const Eigen::MatrixXd& blocks) {
  poisson_ratio_ = kNaN;
  make_blocks_ = {};
  shared_->values = shared_->assembly->ValuesOf(blocks);
  return FactorizeValues();
}

bool StiffnessSolver::FactorizeBlocks(MakeBlocks make_blocks) {
  poisson_ratio_ = kNaN;
  make_blocks_ = std::move(make_blocks);
  return MakeValues() && FactorizeValues();
}

// Makes the values of the last matrix of this solver.  Returns false where
// there is none.
bool StiffnessSolver::MakeValues() {
  if (make_blocks_) {
    shared_->values = shared_->assembly->ValuesOf(make_blocks_());
    return true;
  }
  if (!std::isnan(poisson_ratio_)) {
    shared_->assembly->Combine(poisson_ratio_, shared_->values);
    work_.element_passes += shared_->assembly->HasBases() ? 0 : 1;
    return true;
  }
  return false;
}

bool StiffnessSolver::FactorizeValues() {
  Shared& shared = *shared_;
  own_factorization_ = ++shared.num_factorizations;
  shared.has_preconditioner_only = false;
  if (shared.is_multigrid) {
    const int set_ups_before = shared.solver->NumSetUps();
    const bool is_set_up = shared.solver->Factorize(shared.values);
    work_.multigrid_set_ups += shared.solver->NumSetUps() - set_ups_before;
    if (is_set_up) {
      if (CanMakeValues()) {
        shared.values.resize(0);  // Multigrid has its own matrix.
      }
      return true;
    }
    FallBackToCholesky("could not be set up");
  }
  ++work_.factorizations;
  return shared.solver->Factorize(shared.values);
}

// Factorises the last matrix of this solver again where another solver has
// factorised since.
bool StiffnessSolver::FactorizeAgain() {
  return own_factorization_ == shared_->num_factorizations ||
         (MakeValues() && FactorizeValues());
}

bool StiffnessSolver::FactorizeToSolve() {
  return shared_->has_preconditioner_only ? MakeValues() && FactorizeValues()
                                          : FactorizeAgain();
}

void StiffnessSolver::KeepPreconditioner() {
  // The matrix at hand may be one that only another solver can make again.
  if (own_factorization_ == shared_->num_factorizations && CanMakeValues() &&
      shared_->solver->KeepPreconditioner()) {
    shared_->has_preconditioner_only = true;
  }
}

void StiffnessSolver::FallBackToCholesky(const std::string& why) {
  Shared& shared = *shared_;
  shared.notice =
      "multigrid " + why + ", so the stiffness matrix was factorised";
  shared.is_multigrid = false;
  shared.solver.reset();  // Its memory is needed.
  shared.solver =
      std::make_unique<Cholesky>(*shared.assembly, shared.degrees_of_freedom);
}

Eigen::MatrixXd StiffnessSolver::Solve(const Eigen::MatrixXd& all,
                                       double tolerance,
                                       const Eigen::MatrixXd& start) {
  Shared& shared = *shared_;
  work_.solves += static_cast<int>(all.cols());
  std::optional<Eigen::MatrixXd> solution;
  if (FactorizeToSolve()) {
    const Eigen::MatrixXd right_hand_sides =
        shared.degrees_of_freedom.Restrict(all);
    const Eigen::MatrixXd free_start =
        shared.is_multigrid && start.size() > 0
            ? shared.degrees_of_freedom.Restrict(start)
            : Eigen::MatrixXd();
    const int iterations_before = shared.solver->NumIterations();
    const int set_ups_before = shared.solver->NumSetUps();
    solution = shared.solver->Solve(right_hand_sides, tolerance, free_start);
    work_.iterations += shared.solver->NumIterations() - iterations_before;
    work_.multigrid_set_ups += shared.solver->NumSetUps() - set_ups_before;
    if (!solution && shared.is_multigrid) {
      std::ostringstream why;
      why.precision(10);
      why << "did not converge";
      if (!std::isnan(poisson_ratio_)) {
        why << " at nu = " << poisson_ratio_;
      }
      FallBackToCholesky(why.str());
      if ((!CanMakeValues() || MakeValues()) && FactorizeValues()) {
        solution =
            shared.solver->Solve(right_hand_sides, tolerance, free_start);
      }
    }
  }
  if (!solution) {
    poisson_ratio_ = kNaN;
    return Eigen::MatrixXd::Constant(all.rows(), all.cols(), kNaN);
  }
  return shared.degrees_of_freedom.Extend(*solution);
}

Eigen::MatrixXd StiffnessSolver::Precondition(const Eigen::MatrixXd& all) {
  if (!FactorizeAgain()) {
    poisson_ratio_ = kNaN;
    return Eigen::MatrixXd::Constant(all.rows(), all.cols(), kNaN);
  }
  const DegreesOfFreedom& dofs = shared_->degrees_of_freedom;
  return dofs.Extend(shared_->solver->Precondition(dofs.Restrict(all)));
}

bool StiffnessSolver::Renew() {
  if (!FactorizeToSolve()) {
    return false;
  }
  LinearSolver& solver = *shared_->solver;
  const int set_ups_before = solver.NumSetUps();
  const bool is_renewed = solver.Renew();
  work_.multigrid_set_ups += solver.NumSetUps() - set_ups_before;
  return is_renewed;
}

}  // namespace elastimate
