#ifndef ELASTIMATE_CORE_SOLVERS_CHOLESKY_H_
#define ELASTIMATE_CORE_SOLVERS_CHOLESKY_H_

#include <Eigen/Core>
#include <memory>
#include <optional>

#include "elastimate/core/algebra/eigen_abi.h"
#include "elastimate/core/mechanics/stiffness_assembly.h"
#include "elastimate/core/solvers/linear_solver.h"

namespace elastimate {

/// Supernodal sparse Cholesky factorisation (CHOLMOD) of the matrices that
/// share the pattern of one StiffnessAssembly: analysed once, factorised for
/// each set of values.
///
/// The fill-reducing ordering is METIS nested dissection of the graph of the
/// nodes, so that the components of a node stay together.  That graph has a
/// third of the vertices of the graph of the degrees of freedom, and the
/// ordering is as good.
class Cholesky : public LinearSolver {
 public:
  /// Orders and analyses the pattern.  `assembly` must outlive this object.
  /// Throws std::bad_alloc when there is not enough memory.
  Cholesky(const StiffnessAssembly& assembly,
           const DegreesOfFreedom& degrees_of_freedom);
  ~Cholesky() override;

  /// Factorises the matrix of these values (in the order of the pattern) as L
  /// L^T.  Returns false when the matrix is not positive definite to working
  /// precision, so that a solution would have no correct digit.
  ///
  /// Precondition: the supports hold the mesh (WhyNotHeld).  The values cannot
  /// tell whether they do: a motion that nothing resists has, once assembled, a
  /// stiffness of up to 1e-14 of the diagonal next to nu = 1/2, which is mere
  /// rounding.  A plate of quadratic elements that is a thousandth as thick as
  /// it is wide has one of 1e-15 that is right to a few per cent.
  bool Factorize(const Eigen::VectorXd& values) override;

  std::optional<Eigen::MatrixXd> Solve(const Eigen::MatrixXd& right_hand_sides,
                                       double tolerance,
                                       const Eigen::MatrixXd& start) override;
  Eigen::MatrixXd Precondition(const Eigen::MatrixXd& columns) override {
    return *Solve(columns, 0, {});
  }

  /// Returns the floating-point operations of a factorisation.
  double FactorizationFlops() const;
  /// Returns the number of stored values of the factor.
  double FactorValues() const;

 private:
  bool FactorHasTheEnergyOf(const Eigen::VectorXd& values);

  struct Workspace;
  std::unique_ptr<Workspace> workspace_;
};

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_SOLVERS_CHOLESKY_H_
