#ifndef ELASTIMATE_CORE_EQUILIBRIUM_ASSEMBLED_STIFFNESS_H_
#define ELASTIMATE_CORE_EQUILIBRIUM_ASSEMBLED_STIFFNESS_H_

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <memory>
#include <string>

#include "elastimate/core/equilibrium/supported_stiffness.h"
#include "elastimate/core/mesh/mesh.h"

namespace elastimate {

/// A stiffness on some supports that is assembled.  A StiffnessSolver solves
/// with it; the solver analyses the mesh only when it is first needed, as a
/// reduced model may take its place all the time.
class AssembledStiffness : public SupportedStiffness {
 public:
  /// Preconditions and exceptions are those of StiffnessSolver.  The mesh and
  /// the supports must outlive this object.  `shared` is null or a solver of
  /// both, with which memory is shared (StiffnessSolver::Sharing).
  AssembledStiffness(const Mesh& mesh, const Supports& supports,
                     SolverKind solver, const StiffnessSolver* shared);

  /// Factorises K of the coarsest space of `stiffness`, whose mesh has to be
  /// this one.
  bool Factorize(const NestedStiffness& stiffness,
                 bool with_held_rows) override;

  using SupportedStiffness::Solve;
  Eigen::MatrixXd Solve(Eigen::MatrixXd all, Eigen::MatrixXd start) override {
    return Solver().Solve(all, Tolerance(), start);
  }

  Eigen::MatrixXd HeldForces(
      const Eigen::MatrixXd& displacements) const override {
    return rows_ * displacements;
  }
  Eigen::MatrixXd HeldForcesTransposed(
      const Eigen::MatrixXd& held) const override {
    return rows_.transpose() * held;
  }

  const NodeGraph& GraphOfAssembled() const override {
    return Solver().Graph();
  }
  const StiffnessSolver* SolverOfCoarsest() const override {
    return solver_.get();
  }
  Work WorkDone() const override {
    return solver_ ? solver_->WorkDone() : Work();
  }
  const std::string& Notice() const override;

 private:
  StiffnessSolver& Solver() const;
  void AssembleHeldRows(const Eigen::MatrixXd& blocks);

  const Mesh& mesh_;
  const Supports& supports_;
  SolverKind kind_;
  mutable std::unique_ptr<StiffnessSolver> solver_;
  /// K with its held rows only; all other rows are empty.
  Eigen::SparseMatrix<double, Eigen::RowMajor> rows_;
};

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_EQUILIBRIUM_ASSEMBLED_STIFFNESS_H_
