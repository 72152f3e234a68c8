#ifndef ELASTIMATE_CORE_EQUILIBRIUM_SUPPORTED_STIFFNESS_H_
#define ELASTIMATE_CORE_EQUILIBRIUM_SUPPORTED_STIFFNESS_H_

#include <Eigen/Core>
#include <string>

#include "elastimate/core/equilibrium/nested_stiffness.h"
#include "elastimate/core/mesh/node_graph.h"
#include "elastimate/core/scene/degrees_of_freedom.h"
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

  /// Prepares for the moduli that `stiffness` has now, which it may refer to
  /// until the next call; the held rows are there where they are asked for.
  /// False when K_ff is singular to working precision.
  virtual bool Factorize(const NestedStiffness& stiffness,
                         bool with_held_rows) = 0;

  /// K_ff^-1 of the free rows of each column of `all`, zero in the held rows;
  /// NaN where iterations do not converge.  `start` is empty or has a guess of
  /// each column, of any size, which spares iterations where it is good.
  /// Precondition: Factorize returned true, as below.
  virtual Eigen::MatrixXd Solve(const Eigen::MatrixXd& all,
                                const Eigen::MatrixXd& start) = 0;
  Eigen::MatrixXd Solve(const Eigen::MatrixXd& all) { return Solve(all, {}); }

  /// u in equilibrium without loads, of displacements of the held degrees of
  /// freedom alone (zero in the free rows): n solves.  This, and what is below,
  /// needs the held rows.
  Eigen::MatrixXd Extend(const Eigen::MatrixXd& held);
  /// The transpose of Extend, zero in the free rows: n solves.
  Eigen::MatrixXd ExtendTransposed(const Eigen::MatrixXd& values);
  /// K of the held rows times some columns, zero in the free rows.
  virtual Eigen::MatrixXd HeldForces(
      const Eigen::MatrixXd& displacements) const = 0;
  /// Its transpose, of values in the held rows.
  virtual Eigen::MatrixXd HeldForcesTransposed(
      const Eigen::MatrixXd& held) const = 0;

  /// `values` in the held rows, zero in the free.
  Eigen::MatrixXd OfHeld(Eigen::MatrixXd values) const;

  /// The graph of the mesh whose stiffness is assembled.
  virtual const NodeGraph& GraphOfAssembled() const = 0;
  virtual Work WorkDone() const = 0;
  /// StiffnessSolver::Notice.
  virtual const std::string& Notice() const = 0;

 protected:
  explicit SupportedStiffness(const Supports& supports) : dofs_(supports) {}
  const DegreesOfFreedom& Dofs() const { return dofs_; }

 private:
  DegreesOfFreedom dofs_;
};

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_EQUILIBRIUM_SUPPORTED_STIFFNESS_H_
