#ifndef ELASTIMATE_CORE_EQUILIBRIUM_SUPPORTED_STIFFNESS_H_
#define ELASTIMATE_CORE_EQUILIBRIUM_SUPPORTED_STIFFNESS_H_

#include <Eigen/Core>
#include <string>
#include <utility>
#include <vector>

#include "elastimate/core/equilibrium/nested_stiffness.h"
#include "elastimate/core/mesh/node_graph.h"
#include "elastimate/core/scene/supports.h"
#include "elastimate/core/solvers/stiffness_solver.h"

namespace elastimate {

/// A stiffness K on some supports, in blocks of free and held degrees of
/// freedom: K_ff, which systems are solved with, and the held rows (K_hf,
/// K_hh).  All matrices are num_dofs x n.
class SupportedStiffness {
 public:
  virtual ~SupportedStiffness() = default;
  SupportedStiffness(const SupportedStiffness&) = delete;
  SupportedStiffness& operator=(const SupportedStiffness&) = delete;

  /// Prepares for the present moduli of `stiffness`, to which it may refer
  /// until the next call.  `with_held_rows` asks for the held rows as well.
  /// Returns false when K_ff is singular to working precision.
  virtual bool Factorize(const NestedStiffness& stiffness,
                         bool with_held_rows) = 0;

  /// Gives back memory of which the next Factorize makes no use.
  virtual void Forget() {}

  /// Returns K_ff^-1 times the free rows of each column of `all`, and zeros in
  /// the held rows; NaN where no solver converges.  `start` is empty or
  /// has a guess of each column, scaled in any way, which spares iterations
  /// where it is good.  Precondition, here and below: Factorize returned true.
  virtual Eigen::MatrixXd Solve(Eigen::MatrixXd all, Eigen::MatrixXd start) = 0;
  Eigen::MatrixXd Solve(Eigen::MatrixXd all) {
    return Solve(std::move(all), {});
  }

  /// Does what Solve does as far as one application of the preconditioner does
  /// it, where there is no factor; symmetric and positive definite.
  /// Precondition: the held rows are zero.
  virtual Eigen::MatrixXd Precondition(const Eigen::MatrixXd& all) {
    return Solve(all);
  }

  /// Leaves a relative error of `tolerance` in the energy norm from now on,
  /// where there is no factor; kAccurate without this call.
  void SetTolerance(double tolerance) { tolerance_ = tolerance; }

  /// Returns u in equilibrium without loads where the held degrees of freedom
  /// are displaced by `held` (zero in the free rows): n solves.  This function
  /// and those below need the held rows.
  Eigen::MatrixXd Extend(const Eigen::MatrixXd& held);
  /// Multiplies by the transpose of Extend; the free rows are zero: n solves.
  Eigen::MatrixXd ExtendTransposed(const Eigen::MatrixXd& values);
  /// Returns the held rows of K times the columns, zero in the free rows.
  virtual Eigen::MatrixXd HeldForces(
      const Eigen::MatrixXd& displacements) const = 0;
  /// Multiplies by the transpose of HeldForces; `held` counts in the held rows.
  virtual Eigen::MatrixXd HeldForcesTransposed(
      const Eigen::MatrixXd& held) const = 0;

  /// Sets the held rows to zero.
  void ClearHeld(Eigen::Ref<Eigen::MatrixXd> values) const {
    values(held_rows_, Eigen::all).setZero();
  }
  /// Returns `values` with zeros in the free rows.
  Eigen::MatrixXd OfHeld(const Eigen::MatrixXd& values) const;

  /// Returns the graph of the mesh whose stiffness is assembled.
  virtual const NodeGraph& GraphOfAssembled() const = 0;
  /// Returns the solver of the coarsest space, or null before there is one.
  virtual const StiffnessSolver* SolverOfCoarsest() const = 0;
  virtual Work WorkDone() const = 0;
  /// Returns StiffnessSolver::Notice.
  virtual const std::string& Notice() const = 0;

 protected:
  explicit SupportedStiffness(const Supports& supports);
  /// Returns the held degrees of freedom, in ascending order.
  const std::vector<Eigen::Index>& HeldRows() const { return held_rows_; }
  /// Returns what HeldRows is on other supports.
  static std::vector<Eigen::Index> HeldRowsOn(const Supports& supports);
  double Tolerance() const { return tolerance_; }

 private:
  std::vector<Eigen::Index> held_rows_;
  double tolerance_ = StiffnessSolver::kAccurate;
};

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_EQUILIBRIUM_SUPPORTED_STIFFNESS_H_
