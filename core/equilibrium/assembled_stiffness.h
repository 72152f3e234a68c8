#ifndef ELASTIMATE_CORE_EQUILIBRIUM_ASSEMBLED_STIFFNESS_H_
#define ELASTIMATE_CORE_EQUILIBRIUM_ASSEMBLED_STIFFNESS_H_

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <string>

#include "elastimate/core/equilibrium/supported_stiffness.h"
#include "elastimate/core/mesh/mesh.h"

namespace elastimate {

/// A stiffness on some supports that is assembled, and solved with by a
/// StiffnessSolver.
class AssembledStiffness : public SupportedStiffness {
 public:
  /// Preconditions and exceptions are those of StiffnessSolver.
  AssembledStiffness(const Mesh& mesh, const Supports& supports,
                     SolverKind solver);

  /// Factorises K of the coarsest space of `stiffness`, which is to be of the
  /// mesh.
  bool Factorize(const NestedStiffness& stiffness,
                 bool with_held_rows) override;

  using SupportedStiffness::Solve;
  Eigen::MatrixXd Solve(const Eigen::MatrixXd& all,
                        const Eigen::MatrixXd& /*start*/) override {
    return solver_.Solve(all);
  }

  Eigen::MatrixXd HeldForces(
      const Eigen::MatrixXd& displacements) const override {
    return held_rows_ * displacements;
  }
  Eigen::MatrixXd HeldForcesTransposed(
      const Eigen::MatrixXd& held) const override {
    return held_rows_.transpose() * held;
  }

  const NodeGraph& GraphOfAssembled() const override { return solver_.Graph(); }
  Work WorkDone() const override { return solver_.WorkDone(); }
  const std::string& Notice() const override { return solver_.Notice(); }

 private:
  void AssembleHeldRows(const Eigen::MatrixXd& blocks);

  StiffnessSolver solver_;
  Eigen::SparseMatrix<double, Eigen::RowMajor> held_rows_;
};

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_EQUILIBRIUM_ASSEMBLED_STIFFNESS_H_
