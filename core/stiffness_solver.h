#ifndef ELASTIMATE_CORE_STIFFNESS_SOLVER_H_
#define ELASTIMATE_CORE_STIFFNESS_SOLVER_H_

#include <Eigen/Core>
#include <memory>

#include "elastimate/core/cholesky.h"
#include "elastimate/core/degrees_of_freedom.h"
#include "elastimate/core/scene.h"
#include "elastimate/core/stiffness_assembly.h"

namespace elastimate {

/// How much computing was done; counted where it happens.
struct Work {
  int element_passes = 0;  ///< Passes over all elements, for any columns.
  int factorizations = 0;  ///< Numeric Cholesky factorisations.
  int solves = 0;          ///< Right-hand sides solved with a factorisation.
};

inline Work operator+(const Work& a, const Work& b) {
  return {a.element_passes + b.element_passes,
          a.factorizations + b.factorizations, a.solves + b.solves};
}

inline Work operator-(const Work& a, const Work& b) {
  return {a.element_passes - b.element_passes,
          a.factorizations - b.factorizations, a.solves - b.solves};
}

/// Solves with A(nu) = H + nu J on the free degrees of freedom of a mesh.
class StiffnessSolver {
 public:
  /// Assembles H and J and analyses their pattern: one element pass.
  /// Precondition: a valid scene.  Throws std::invalid_argument with the
  /// sentence of WhyNotHeld when the supports do not hold the specimen, and
  /// std::bad_alloc when the factor does not fit into memory.
  StiffnessSolver(const Mesh& mesh, const Supports& supports);

  /// Factorises A(nu); does nothing when nu is the present one.  False when
  /// A(nu) is singular to working precision (nu at or beyond -1 or 1/2, or an
  /// extremely ill-conditioned mesh).
  bool Factorize(double poisson_ratio);

  /// A^-1 of the free rows of each column of `all` ((3 num_nodes) x n), zero in
  /// the held rows.  Precondition: Factorize returned true.
  Eigen::MatrixXd Solve(const Eigen::MatrixXd& all);

  /// nu of the present factorisation; NaN when there is none.
  double PoissonRatio() const { return poisson_ratio_; }
  const DegreesOfFreedom& Dofs() const { return degrees_of_freedom_; }
  const NodeGraph& Graph() const { return assembly_->Graph(); }
  const Work& WorkDone() const { return work_; }

 private:
  DegreesOfFreedom degrees_of_freedom_;
  std::unique_ptr<StiffnessAssembly> assembly_;
  Eigen::VectorXd values_;  ///< Of the last H + nu J, memory to be used again.
  std::unique_ptr<Cholesky> cholesky_;
  /// NaN before the first factorisation and after a failed one.
  double poisson_ratio_;
  Work work_;
};

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_STIFFNESS_SOLVER_H_
