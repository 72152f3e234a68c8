#ifndef ELASTIMATE_CORE_EQUILIBRIUM_REFINED_STIFFNESS_H_
#define ELASTIMATE_CORE_EQUILIBRIUM_REFINED_STIFFNESS_H_

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "elastimate/core/equilibrium/supported_stiffness.h"
#include "elastimate/core/solvers/v_cycle.h"

namespace elastimate {

/// The stiffness, on some supports, of the finest of some spaces that contain
/// each other.  It is not assembled: conjugate gradients solve with it, and
/// one VCycle over the spaces preconditions them, with the diagonal blocks of
/// the nodes.  On the coarsest space a StiffnessSolver of the same moduli
/// preconditions: it solves with its factor, or runs one cycle of multigrid.
///
/// The iterations do not grow with the mesh.  On blocks and bars, with a
/// factor, an error of 1e-8 takes 12 to 20 of them at nu = 0.3, 20 to 32 at
/// 0.45 and 45 to 70 at 0.49.  An error of 1e-2 takes a fourth of these, and
/// multigrid takes a third more.  Flat elements take many more: ten times as
/// many where they are five times as wide as thick.  Where iterations do not
/// converge, the solver of the coarsest space is renewed; where that does not
/// help, the stiffness of the finest one is factorised, then and from then on.
class RefinedStiffness : public SupportedStiffness {
 public:
  static constexpr int kMostIterations = 200;

  /// `meshes` and `supports` are those of each space, from coarse to fine,
  /// which must outlive this object.  `shared` is null or a solver of the
  /// coarsest space, with which memory is shared (StiffnessSolver::Sharing).
  /// Preconditions and exceptions are those of StiffnessSolver.
  RefinedStiffness(const std::vector<const Mesh*>& meshes,
                   const std::vector<const Supports*>& supports,
                   SolverKind solver, const StiffnessSolver* shared);

  bool Factorize(const NestedStiffness& stiffness,
                 bool with_held_rows) override;
  void Forget() override { cycle_.clear(); }

  /// An iteration takes five element passes of the finest space, four of each
  /// one between, and StiffnessSolver::Precondition on the coarsest, for all
  /// columns.
  using SupportedStiffness::Solve;
  Eigen::MatrixXd Solve(Eigen::MatrixXd all, Eigen::MatrixXd start) override;
  Eigen::MatrixXd Precondition(const Eigen::MatrixXd& all) override;

  Eigen::MatrixXd HeldForces(
      const Eigen::MatrixXd& displacements) const override;
  Eigen::MatrixXd HeldForcesTransposed(
      const Eigen::MatrixXd& held) const override;

  const NodeGraph& GraphOfAssembled() const override {
    return coarsest_.Graph();
  }
  const StiffnessSolver* SolverOfCoarsest() const override {
    return &coarsest_;
  }
  /// The solves and element passes are those of the finest space.
  Work WorkDone() const override;
  const std::string& Notice() const override {
    return finest_ ? finest_->Notice() : coarsest_.Notice();
  }

 private:
  std::size_t Finest() const { return held_rows_of_coarser_.size(); }
  const std::vector<Eigen::Index>& HeldRowsIn(std::size_t space) const {
    return space == Finest() ? HeldRows() : held_rows_of_coarser_[space];
  }
  /// Returns the values with zeros in the held rows of a space.
  Eigen::MatrixXd OfFree(std::size_t space, Eigen::MatrixXd values) const;
  ConjugateGradientResult Iterate(Eigen::MatrixXd all, Eigen::MatrixXd start);
  bool FactorizeFinest();
  /// Sets up the V-cycle over the finer spaces.  Returns whether K is positive
  /// definite there, as far as it is seen.
  bool SetUpCycle();
  /// Returns K x in the free rows of a space, and zeros in the held ones.
  Eigen::MatrixXd Multiply(std::size_t space, const Eigen::MatrixXd& x);
  /// Runs the V-cycle.
  Eigen::MatrixXd Cycle(const Eigen::MatrixXd& force);

  StiffnessSolver coarsest_;
  /// Makes the solver of the finest space, which is null as long as iterations
  /// converge.
  std::function<std::unique_ptr<StiffnessSolver>()> make_finest_;
  std::unique_ptr<StiffnessSolver> finest_;
  /// HeldRows of all spaces but the finest.
  std::vector<std::vector<Eigen::Index>> held_rows_of_coarser_;
  std::vector<CycleSpace> cycle_;  ///< All spaces but the coarsest.
  const NestedStiffness* stiffness_ = nullptr;
  /// The smallest eigenvalue of the preconditioned stiffness that any solution
  /// met so far.
  double smallest_eigenvalue_ = 1;
  Work work_;
};

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_EQUILIBRIUM_REFINED_STIFFNESS_H_
