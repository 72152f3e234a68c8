#include "elastimate/core/solvers/stiffness_solver.h"

#include <cassert>
#include <limits>
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
    : degrees_of_freedom_(supports), poisson_ratio_(kNaN) {
  const std::string why_not_held = WhyNotHeld(mesh, supports);
  if (!why_not_held.empty()) {
    throw std::invalid_argument(why_not_held);
  }
  assert(kind != SolverKind::kMultigrid || HasMultigrid());
  assembly_ = std::make_unique<StiffnessAssembly>(mesh, degrees_of_freedom_);
  ++work_.element_passes;
  is_multigrid_ = kind == SolverKind::kMultigrid;
  if (!is_multigrid_) {
    auto cholesky = std::make_unique<Cholesky>(*assembly_, degrees_of_freedom_);
    const double most_flops =
        kMostFlops[mesh.Order() - 1] *
        static_cast<double>(degrees_of_freedom_.NumFree());
    if (kind == SolverKind::kAutomatic &&
        cholesky->FactorizationFlops() > most_flops) {
      is_multigrid_ = HasMultigrid();
      notice_ = HasMultigrid()
                    ? ""
                    : "the mesh is so large that multigrid would be faster "
                      "than the factorisation, but it is not available (" +
                          WhyNoMultigrid() + ")";
    }
    if (!is_multigrid_) {
      solver_ = std::move(cholesky);
    }
  }
  if (is_multigrid_) {
    // Its set-up takes much longer than an element pass, and much memory.
    assembly_->ForgetBases();
    solver_ = MakeMultigrid(mesh, *assembly_, degrees_of_freedom_);
    work_.ranks = NumRanksOfSolves();
  }
}

bool StiffnessSolver::Factorize(double poisson_ratio) {
  if (poisson_ratio == poisson_ratio_) {
    return true;
  }
  poisson_ratio_ = kNaN;
  if (!(poisson_ratio > -1 && poisson_ratio < 0.5)) {
    return false;
  }
  assembly_->Combine(poisson_ratio, values_);
  work_.element_passes += assembly_->HasBases() ? 0 : 1;
  if (!FactorizeValues()) {
    return false;
  }
  poisson_ratio_ = poisson_ratio;
  return true;
}

bool StiffnessSolver::FactorizeBlocks(const Eigen::MatrixXd& blocks) {
  poisson_ratio_ = kNaN;
  values_ = assembly_->ValuesOf(blocks);
  return FactorizeValues();
}

bool StiffnessSolver::FactorizeValues() {
  if (is_multigrid_) {
    const int set_ups_before = solver_->NumSetUps();
    const bool is_set_up = solver_->Factorize(values_);
    work_.multigrid_set_ups += solver_->NumSetUps() - set_ups_before;
    if (is_set_up) {
      return true;
    }
    FallBackToCholesky("could not be set up");
  }
  ++work_.factorizations;
  return solver_->Factorize(values_);
}

void StiffnessSolver::FallBackToCholesky(const std::string& why) {
  notice_ = "multigrid " + why + ", so the stiffness matrix was factorised";
  is_multigrid_ = false;
  solver_.reset();  // Its memory is needed.
  solver_ = std::make_unique<Cholesky>(*assembly_, degrees_of_freedom_);
}

Eigen::MatrixXd StiffnessSolver::Solve(const Eigen::MatrixXd& all,
                                       double tolerance,
                                       const Eigen::MatrixXd& start) {
  work_.solves += static_cast<int>(all.cols());
  const Eigen::MatrixXd right_hand_sides = degrees_of_freedom_.Restrict(all);
  const Eigen::MatrixXd free_start = is_multigrid_ && start.size() > 0
                                         ? degrees_of_freedom_.Restrict(start)
                                         : Eigen::MatrixXd();
  const int iterations_before = solver_->NumIterations();
  const int set_ups_before = solver_->NumSetUps();
  std::optional<Eigen::MatrixXd> solution =
      solver_->Solve(right_hand_sides, tolerance, free_start);
  work_.iterations += solver_->NumIterations() - iterations_before;
  work_.multigrid_set_ups += solver_->NumSetUps() - set_ups_before;
  if (!solution && is_multigrid_) {
    std::ostringstream why;
    why.precision(10);
    why << "did not converge";
    if (poisson_ratio_ == poisson_ratio_) {
      why << " at nu = " << poisson_ratio_;
    }
    FallBackToCholesky(why.str());
    if (FactorizeValues()) {
      solution = solver_->Solve(right_hand_sides, tolerance, free_start);
    }
  }
  if (!solution) {
    poisson_ratio_ = kNaN;
    return Eigen::MatrixXd::Constant(all.rows(), all.cols(), kNaN);
  }
  return degrees_of_freedom_.Extend(*solution);
}

}  // namespace elastimate
