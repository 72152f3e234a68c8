#ifndef ELASTIMATE_CORE_EQUILIBRIUM_LARGE_STRAIN_EQUILIBRIUM_H_
#define ELASTIMATE_CORE_EQUILIBRIUM_LARGE_STRAIN_EQUILIBRIUM_H_

#include <Eigen/Core>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "elastimate/core/mechanics/follower_pressure.h"
#include "elastimate/core/mechanics/large_strain_forces.h"
#include "elastimate/core/scene/scene.h"
#include "elastimate/core/solvers/stiffness_solver.h"

namespace elastimate {

/// Which factorised tangents are kept.
enum class KeptFactors {
  kLast,        ///< The last one for each set of held degrees of freedom.
  kOfEachCase,  ///< The last one of each load case.
};

/// How the search for an equilibrium ended.
enum class EquilibriumStatus {
  kDone,
  /// Beyond the share of the load that was reached, the tangent is not positive
  /// definite: the specimen buckles or snaps.
  kUnstable,
  kInverted,       ///< Beyond that share, an element is turned inside out.
  kNoEquilibrium,  ///< Beyond that share, Newton's method does not converge.
};

/// A state of a specimen in one load case.
struct LargeStrainState {
  EquilibriumStatus status = EquilibriumStatus::kNoEquilibrium;
  /// The share of the loads and of the displacements of supports at which
  /// `displacement` is in stable equilibrium: 1 if the search was successful.
  double load_share = 0;
  Eigen::VectorXd displacement;  ///< num_dofs [length].
  /// The smallest volume ratio of the mesh at the end of the search, and its
  /// element.
  VolumeRatio smallest_volume = {1, 0};
  /// If the search failed at an unstable state, this is the element that moves
  /// most in the lowest mode of the tangent.  If it failed otherwise, this is
  /// the element with the smallest volume ratio.
  Eigen::Index element = 0;
  int num_steps = 0;     ///< Steps of the load, including failed ones.
  int num_tangents = 0;  ///< Factorisations.
};

/// Says why the whole load was not reached, and what the user can do about it.
/// Empty if it was reached.
[[nodiscard]] std::string WhyNotInEquilibrium(const LargeStrainState& state);

/// Finds the equilibrium of the specimen of a scene at large strains,
///
///   f(u; theta) = t F on the free degrees of freedom,
///   u = t u_held on the held ones,
///
/// at the share t = 1 of the load.  Loads are dead: nodal forces F stay as they
/// are on the undeformed specimen, except those of pressures that follow the
/// surface (FollowerPressure).  The tangent contains the symmetric part of the
/// derivative of these pressures.  The derivative is symmetric if the edge of
/// the loaded surface is held, or if the surface is closed.  Otherwise Newton's
/// method converges linearly, and only the symmetric part of the tangent is
/// checked for stability.
///
/// Newton's method begins at the whole load.  If it fails, the load is divided
/// into steps.  After a step that failed, the next one is a quarter as long;
/// after an easy one, it is twice as long.  An iteration is shortened if det F
/// would fall below a hundredth.  Once the residual is small, the last factor
/// is used again.  The tangent has to be positive definite at the end, because
/// Newton's method converges to unstable states as well [Wriggers, Nonlinear
/// Finite Element Methods, 2008, chapter 5].
///
/// On the way there, the volume of a nearly incompressible material may be
/// wrong, so that its pressure is large and the tangent is indefinite.  Then a
/// multiple of a stiffness against shear alone is added, which does not impede
/// the correction of the volume.
///
///   LargeStrainEquilibrium model(scene);
///   const MaterialParameters& chart = model.Forces().Parameters();
///   const auto state = model.Solve(chart.Moduli(parameters), 0);
///   if (state.status == EquilibriumStatus::kDone) { ... }
class LargeStrainEquilibrium {
 public:
  /// Assembles the sparsity pattern of the tangent and analyses it.  Refers to
  /// `scene`, which has to stay as it is; a temporary one does not compile.
  /// Throws as LargeStrainForces and StiffnessSolver do.  Precondition: a valid
  /// scene.
  explicit LargeStrainEquilibrium(
      const Scene& scene, Dilatation dilatation = Dilatation::kMeanOfElement,
      KeptFactors kept = KeptFactors::kLast);
  explicit LargeStrainEquilibrium(const Scene&&,
                                  Dilatation = Dilatation::kMeanOfElement,
                                  KeptFactors = KeptFactors::kLast) = delete;

  /// Sets the displacement of the held degrees of freedom in load case `k`
  /// (num_dofs, zero in the free rows), in place of that of the scene.
  void SetHeldDisplacement(Eigen::Index k, const Eigen::VectorXd& held) {
    held_displacement_.col(k) = held;
  }
  const Eigen::MatrixXd& HeldDisplacement() const { return held_displacement_; }
  /// Changes how elements evaluate their volume, from the next call on.
  void SetDilatation(Dilatation dilatation) {
    forces_.SetDilatation(dilatation);
  }
  /// Returns the dead loads, num_dofs x num_load_cases [force].
  const Eigen::MatrixXd& Load() const { return load_; }
  /// Returns all loads F of load case `k` at a displacement, num_dofs [force].
  Eigen::VectorXd LoadAt(Eigen::Index k,
                         const Eigen::VectorXd& displacement) const {
    return load_.col(k) + pressures_[k].Forces(displacement);
  }

  /// Finds the equilibrium in load case `k`.  About five tangents for each step
  /// of the load.  After a step that failed, the search goes on only if it has
  /// taken at most `most_tangents` until then.  Each further step begins with
  /// `progress` of the share of the load that was reached; it may be empty.
  LargeStrainState Solve(const Eigen::VectorXd& moduli, Eigen::Index k,
                         int most_tangents = std::numeric_limits<int>::max(),
                         const std::function<void(double)>& progress = {});

  /// Finds the equilibrium in load case `k` near `start` (num_dofs), such as
  /// that of moduli that are nearly the same.  Newton's method begins there at
  /// the whole load and is not helped by steps of the load, so that a failure
  /// costs little.  Two or three tangents; about twenty where it fails.
  LargeStrainState SolveFrom(const Eigen::VectorXd& start,
                             const Eigen::VectorXd& moduli, Eigen::Index k);

  /// Returns the solver of load case `k`.  After a Solve of that load case that
  /// was successful, and as long as its factor is kept, it has the factor of
  /// the tangent there.
  StiffnessSolver& TangentSolver(Eigen::Index k) {
    return *solvers_[solver_of_case_[k]];
  }

  /// Factorises the tangent of load case `k` again, at a displacement that
  /// Solve found.
  void FactorizeAgain(const Eigen::VectorXd& moduli, Eigen::Index k,
                      const Eigen::VectorXd& displacement) {
    LargeStrainState state;
    // The tangent was positive definite when the state was found.
    static_cast<void>(Factorize(moduli, k, 1, displacement, 0, state));
  }

  const NodeGraph& Graph() const { return solvers_.front()->Graph(); }
  Work WorkDone() const;
  const LargeStrainForces& Forces() const { return forces_; }

 private:
  /// Factorises the tangent.  If it is not positive definite, a stiffness
  /// against shear is added, whose multiple of the shear modulus grows from 1
  /// up to `most_shift` until the sum is.  Returns false if that is not enough.
  bool Factorize(const Eigen::VectorXd& moduli, Eigen::Index k, double t,
                 const Eigen::VectorXd& u, double most_shift,
                 LargeStrainState& state);
  /// Sets the element of a search that failed, and says what a failure of
  /// Newton's method means at the last equilibrium.
  void NameFailure(const Eigen::VectorXd& moduli, Eigen::Index k,
                   LargeStrainState& state);
  /// Returns the element that moves most in the lowest mode of the tangent at
  /// the last stable state.  One tangent and a few solves.
  Eigen::Index ElementOfLowestMode(const Eigen::VectorXd& moduli,
                                   Eigen::Index k, LargeStrainState& state);
  /// Runs Newton's method at the share `t` of the load, beginning at `u`.
  EquilibriumStatus Newton(const Eigen::VectorXd& moduli, Eigen::Index k,
                           double t, LargeStrainState& state,
                           Eigen::VectorXd& u);
  const Scene& scene_;
  LargeStrainForces forces_;
  Eigen::MatrixXd load_;                     ///< num_dofs x num_load_cases.
  std::vector<FollowerPressure> pressures_;  ///< One for each load case.
  Eigen::MatrixXd held_displacement_;        ///< num_dofs x num_load_cases.
  std::vector<std::unique_ptr<StiffnessSolver>> solvers_;
  std::vector<std::size_t> solver_of_case_;
  /// The stiffness of small strains for lambda = 0 and 2 mu = 1; empty until it
  /// is needed.
  Eigen::MatrixXd shear_blocks_;
  int element_passes_ = 0;
};

/// The equilibria of all load cases.
struct LargeStrainSolution {
  Eigen::MatrixXd displacement;  ///< num_dofs x num_load_cases [length].
  /// f(u) - F, num_dofs x num_load_cases [force]; in the held rows, these are
  /// the forces of the supports.
  Eigen::MatrixXd imbalance;
  /// "load case 2: beyond ..." of the first load case without equilibrium, of
  /// which and of later ones the columns mean nothing; empty where all have
  /// one.
  std::string why_not;
};

/// Finds the equilibrium of one load case after the other.  `progress` is
/// called with "load case 2" before each search, and with "load case 2, 30 % of
/// the load reached" before each further step of it; it may be empty.
[[nodiscard]] LargeStrainSolution SolveLoadCases(
    const Eigen::VectorXd& moduli, LargeStrainEquilibrium& model,
    const std::function<void(const std::string&)>& progress = {});

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_EQUILIBRIUM_LARGE_STRAIN_EQUILIBRIUM_H_
