#ifndef ELASTIMATE_CORE_SOLVERS_STIFFNESS_SOLVER_H_
#define ELASTIMATE_CORE_SOLVERS_STIFFNESS_SOLVER_H_

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "elastimate/core/mechanics/stiffness_assembly.h"
#include "elastimate/core/scene/degrees_of_freedom.h"
#include "elastimate/core/scene/scene.h"
#include "elastimate/core/solvers/linear_solver.h"
#include "elastimate/core/solvers/multigrid.h"

namespace elastimate {

/// How much computing was done; counted where it happens.
struct Work {
  int element_passes = 0;  ///< Passes over all elements, for any columns.
  int factorizations = 0;  ///< Numeric Cholesky factorisations.
  int multigrid_set_ups = 0;
  int solves = 0;      ///< Right-hand sides that were solved for.
  int iterations = 0;  ///< Steps of conjugate gradients, all columns.
  /// Processes that solved together (ShareSolves), or each for some frames of a
  /// series.
  int ranks = 1;
};

inline Work operator+(const Work& a, const Work& b) {
  return {a.element_passes + b.element_passes,
          a.factorizations + b.factorizations,
          a.multigrid_set_ups + b.multigrid_set_ups,
          a.solves + b.solves,
          a.iterations + b.iterations,
          std::max(a.ranks, b.ranks)};
}

inline Work operator-(const Work& a, const Work& b) {
  return {a.element_passes - b.element_passes,
          a.factorizations - b.factorizations,
          a.multigrid_set_ups - b.multigrid_set_ups,
          a.solves - b.solves,
          a.iterations - b.iterations,
          a.ranks};
}

/// How linear systems are solved.
enum class SolverKind {
  /// Multigrid where a factorisation takes longer, as its analysis tells.  In a
  /// compact body that is from about 30 000 nodes on with linear tetrahedra and
  /// 200 000 with quadratic ones, in plates and bars from many more on.
  /// Equilibrium solves straight quadratic elements by iterations over linear
  /// elements on their vertices, where those take multigrid.
  kAutomatic,
  kCholesky,   ///< Direct.  In a compact body, time grows with nodes squared.
  kMultigrid,  ///< Conjugate gradients; needs PETSc (HasMultigrid).
};

/// Solves with A(nu) = H + nu J, or another stiffness of the same pattern, on
/// the free degrees of freedom of a mesh.
class StiffnessSolver {
 public:
  /// The relative error, in the energy norm, that iterations leave.
  static constexpr double kAccurate = 1e-8;

  /// Assembles H and J and analyses their pattern: one element pass.
  /// Preconditions: a valid scene; HasMultigrid() for kMultigrid.  Throws
  /// std::invalid_argument with the sentence of WhyNotHeld when the supports do
  /// not hold the specimen, and std::bad_alloc when the factor does not fit
  /// into memory.  `mesh` has to outlive this object.
  StiffnessSolver(const Mesh& mesh, const Supports& supports, SolverKind kind);

  StiffnessSolver(StiffnessSolver&&) noexcept = default;
  StiffnessSolver& operator=(StiffnessSolver&&) noexcept = default;
  StiffnessSolver(const StiffnessSolver&) = delete;
  StiffnessSolver& operator=(const StiffnessSolver&) = delete;

  /// Returns a solver of the same mesh and supports whose analysis, coarse
  /// spaces and factor are in the same memory.  A solver that solves after
  /// another one has factorised first factorises its own last matrix again, and
  /// each counts its own work.  Where multigrid fails for one, all factorise
  /// from then on.  The mesh has to outlive all of them.
  StiffnessSolver Sharing() const;
  /// Tells whether these supports hold the degrees of freedom that those of
  /// this solver hold.
  bool Holds(const Supports& supports) const;

  /// Factorises A(nu); does nothing when nu is the present one.  Returns false
  /// when A(nu) is singular to working precision (nu at or beyond -1 or 1/2, or
  /// an extremely ill-conditioned mesh).
  [[nodiscard]] bool Factorize(double poisson_ratio);

  /// Factorises a stiffness that is given by a block for each pair of the graph
  /// instead, side by side: dimension x (dimension num_pairs).  Returns false
  /// when it is singular to working precision.
  /// Precondition: no other solver shares the memory of this one.
  [[nodiscard]] bool FactorizeBlocks(const Eigen::MatrixXd& blocks);
  /// Factorises the blocks that a function makes.  The function is kept until
  /// the next factorisation, and called again where another solver has
  /// factorised since; what it refers to has to live as long.
  using MakeBlocks = std::function<Eigen::MatrixXd()>;
  [[nodiscard]] bool FactorizeBlocks(MakeBlocks make_blocks);

  /// Returns A^-1 times the free rows of each column of `all` (num_dofs x n),
  /// and zeros in the held rows.  `start` is empty or has a guess of each
  /// column (num_dofs x n), scaled in any way, with which iterations begin.
  /// Where multigrid does not converge, A is factorised from then on; when that
  /// shows that it is singular, the solution is NaN.  Precondition: the last
  /// factorisation succeeded.
  Eigen::MatrixXd Solve(const Eigen::MatrixXd& all,
                        double tolerance = kAccurate,
                        const Eigen::MatrixXd& start = {});

  /// Returns LinearSolver::Precondition of the free rows of each column
  /// (num_dofs x n), and zeros in the held rows; NaN where the last matrix has
  /// to be factorised again and is singular.  This counts no solve, and never
  /// takes another solver.  Precondition: as for Solve.
  Eigen::MatrixXd Precondition(const Eigen::MatrixXd& all);
  /// Does what LinearSolver::Renew does.
  bool Renew();
  /// Gives back the memory that Precondition does not need.  The next Solve or
  /// Renew factorises again.
  void KeepPreconditioner();

  /// Returns nu of the present factorisation; NaN when there is none, or when
  /// it is of blocks.
  double PoissonRatio() const { return poisson_ratio_; }
  const DegreesOfFreedom& Dofs() const { return shared_->degrees_of_freedom; }
  const NodeGraph& Graph() const { return shared_->assembly->Graph(); }
  const Work& WorkDone() const { return work_; }
  bool UsesMultigrid() const { return shared_->is_multigrid; }
  /// Returns a sentence where systems are solved in another way than was asked
  /// for or than is best; else empty.
  const std::string& Notice() const { return shared_->notice; }

 private:
  struct Shared {
    explicit Shared(const Supports& supports) : degrees_of_freedom(supports) {}
    DegreesOfFreedom degrees_of_freedom;
    std::unique_ptr<StiffnessAssembly> assembly;
    /// The last matrix; empty where multigrid has taken it and MakeValues can
    /// make it again.
    Eigen::VectorXd values;
    std::unique_ptr<LinearSolver> solver;
    bool is_multigrid = false;
    /// Whether nothing but Precondition is possible before the next
    /// factorisation.
    bool has_preconditioner_only = false;
    std::string notice;
    std::int64_t num_factorizations = 0;
  };

  explicit StiffnessSolver(std::shared_ptr<Shared> shared);
  /// Tells whether MakeValues can make the last matrix again.
  bool CanMakeValues() const {
    return make_blocks_ || !std::isnan(poisson_ratio_);
  }
  bool MakeValues();
  bool FactorizeValues();
  bool FactorizeAgain();
  bool FactorizeToSolve();
  void FallBackToCholesky(const std::string& why);

  std::shared_ptr<Shared> shared_;
  /// This is NaN before the first factorisation and after a failed one.
  double poisson_ratio_;
  /// Makes the blocks of the last factorisation of this solver; empty where
  /// that was of nu.
  MakeBlocks make_blocks_;
  /// The number, among all in the shared memory, of the last factorisation of
  /// this solver.
  std::int64_t own_factorization_ = 0;
  Work work_;
};

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_SOLVERS_STIFFNESS_SOLVER_H_
