#ifndef ELASTIMATE_CORE_EQUILIBRIUM_EQUILIBRIUM_H_
#define ELASTIMATE_CORE_EQUILIBRIUM_EQUILIBRIUM_H_

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "elastimate/core/equilibrium/forward_model.h"
#include "elastimate/core/mechanics/internal_forces.h"
#include "elastimate/core/scene/scene.h"
#include "elastimate/core/solvers/stiffness_solver.h"

namespace elastimate {

class NestedStiffness;
class SupportedStiffness;
struct VertexSpace;

/// Equilibrium of small strains of the materials of a scene,
///
///   K(theta) u = f on the free degrees of freedom, u given on the held ones,
///
/// in each load case, and its sensitivities du / d theta_k = -K^-1 K_k u.  Load
/// cases that hold the same degrees of freedom share a factor.
///
/// Iterations begin with the last displacements and sensitivities, so that what
/// they find depends, within their tolerance, on what was solved for before.
///
///   Equilibrium model(scene, SolverKind::kAutomatic);
///   const MaterialParameters& chart = model.Forces().Parameters();
///   if (model.Solve(chart.Moduli(parameters))) {
///     Eigen::MatrixXd u = model.Displacement();
///   }
class Equilibrium : public ForwardModel {
 public:
  /// Assembles the pattern and analyses it.  Large quadratic meshes are solved
  /// by iterations over the linear elements of their vertices
  /// (VertexSpaceToSolveBy), as below.  Refers to `scene`, which has to
  /// stay as it is; a temporary one does not compile.  Preconditions and
  /// exceptions are those of StiffnessSolver.
  Equilibrium(const Scene& scene, SolverKind solver);
  Equilibrium(const Scene&&, SolverKind) = delete;

  /// Solves in the last of some spaces of one specimen, which are given from
  /// coarse to fine; the scenes have to stay as they are.  Where the spaces
  /// contain each other (AreNested), only the stiffness of the first one is
  /// factorised.  Iterations (RefinedStiffness) then solve the systems of the
  /// last one, and leave a relative error of `tolerance` in the energy norm.
  /// Once they do not converge, the stiffness of the last one is factorised.
  /// They begin with the solutions for the last moduli, so a Solve whose moduli
  /// change displacements by less than the tolerance leaves them as they are
  /// but for a factor.  Where the spaces do not contain each other, the
  /// stiffness of the last one is factorised and the others are not used.
  /// `shared` is null or a solver of the first space, with whose memory the
  /// first solver of the same held degrees of freedom works
  /// (StiffnessSolver::Sharing).
  Equilibrium(const std::vector<const Scene*>& spaces, SolverKind solver,
              double tolerance = StiffnessSolver::kAccurate,
              const StiffnessSolver* shared = nullptr);

  ~Equilibrium() override;
  Equilibrium(Equilibrium&&) noexcept;
  Equilibrium& operator=(Equilibrium&&) noexcept;

  /// Solves for u at these moduli: an element pass and a factorisation for each
  /// set of held degrees of freedom, and a solve for each load case (one
  /// more, and a pass, for each set of held displacements that are not zero).
  /// False when the stiffness is not positive definite to working precision;
  /// there is no u then.
  [[nodiscard]] bool Solve(const Eigen::VectorXd& moduli) override;

  /// Solves with an error of 1e-4, in the energy norm, where iterations solve.
  [[nodiscard]] bool SolveRoughly(const Eigen::VectorXd& moduli);

  const Eigen::MatrixXd& Displacement() const override { return displacement_; }

  /// The part of u that the held displacements cause, which does not change
  /// when all moduli are multiplied by a factor: num_dofs x num_load_cases.
  Eigen::MatrixXd SupportResponse() const { return OrZeros(support_response_); }

  /// Takes a pass and n solves for each load case.  Iterations take n passes,
  /// and neither a pass nor a solve for a direction in which all moduli grow
  /// alike.  Takes nothing where the directions are those of the last call and
  /// neither moduli nor supports have changed since, because searches within
  /// bounds ask twice.
  Eigen::MatrixXd Sensitivities(const Eigen::MatrixXd& directions) override;
  /// Gives back the memory of the last displacement and sensitivities.  Solve
  /// has to be called before anything that describes a solution.
  void ForgetSolution() { BeginWith({}, {}); }
  using ForwardModel::BeginWith;
  /// Begins the iterations of the next Solve and Sensitivities with these,
  /// which are as Displacement and Sensitivities return them, or empty.
  void BeginWith(Eigen::MatrixXd displacement, Eigen::MatrixXd sensitivities) {
    directions_.resize(0, 0);
    displacement_ = std::move(displacement);
    sensitivities_ = std::move(sensitivities);
  }
  /// A solve for each column.
  Eigen::MatrixXd SolveFor(const Eigen::MatrixXd& forces) override;
  /// A pass.
  Eigen::MatrixXd ForceColumns(
      const Eigen::VectorXd& displacement) const override {
    return Forces().Columns(displacement);
  }

  /// Solves as SolveFor does where there is a factor of the stiffness.  Where
  /// iterations solve, applies their preconditioner once.
  /// Precondition: the held rows are zero (ClearHeld).
  Eigen::MatrixXd Precondition(const Eigen::MatrixXd& forces);
  /// Sets the held rows to zero.  `columns` has the same number of columns for
  /// each load case, side by side.
  void ClearHeld(Eigen::MatrixXd& columns) const;
  /// Tells whether iterations solve the systems.
  bool IsRefined() const;

  const Eigen::MatrixXd& Load() const override { return load_; }
  /// Returns the given displacements, zero in the free rows: num_dofs x
  /// num_load_cases.
  Eigen::MatrixXd HeldDisplacement() const {
    return OrZeros(held_displacement_);
  }

  // A solve for each column of the next four.
  Eigen::MatrixXd Extend(const Eigen::MatrixXd& held) override;
  Eigen::MatrixXd ExtendTransposed(const Eigen::MatrixXd& values) override;
  Eigen::MatrixXd ExtendInCase(Eigen::Index k,
                               const Eigen::MatrixXd& held) override;
  [[nodiscard]] bool MoveSupports(const Eigen::MatrixXd& held) override;
  bool IsLinear() const override { return true; }

  Eigen::MatrixXd HeldForces(
      const Eigen::MatrixXd& displacements) const override;
  Eigen::MatrixXd HeldForcesTransposed(
      const Eigen::MatrixXd& held) const override;
  Eigen::MatrixXd HeldForcesInCase(
      Eigen::Index k, const Eigen::MatrixXd& displacements) const override;
  Eigen::MatrixXd SupportForces() const override;
  Eigen::MatrixXd SupportForceSensitivities(
      const Eigen::MatrixXd& directions,
      const Eigen::MatrixXd& sensitivities) override;

  const InternalForces& Forces() const;
  const MaterialParameters& Parameters() const override {
    return Forces().Parameters();
  }
  const NodeGraph& Graph() const override;
  /// Returns the solver of the coarsest space, on the supports of the first
  /// load case; null before there is one.
  const StiffnessSolver* SolverOfCoarsest() const;
  Work WorkDone() const override;
  const std::string& Notice() const override;

 private:
  /// The spaces in which systems are solved: all that were given where they are
  /// nested, else the finest, with the space of its vertices if there is one.
  struct UsedSpaces {
    std::vector<const Scene*> scenes;
    std::unique_ptr<VertexSpace> vertices;
  };
  static UsedSpaces UsedSpacesOf(const std::vector<const Scene*>& spaces,
                                 SolverKind solver);
  Equilibrium(UsedSpaces used, SolverKind solver, double tolerance,
              const StiffnessSolver* shared);

  Eigen::Index NumLoadCases() const { return load_.cols(); }
  void AddStiffness(const std::vector<const Scene*>& spaces, Eigen::Index k,
                    SolverKind solver, const StiffnessSolver* shared);
  void SetTolerance(double tolerance);
  /// Applies `of_stiffness` to the columns of each load case (n side by side)
  /// with the stiffness on the supports of that load case.
  template <class Function>
  Eigen::MatrixXd ByStiffness(const Eigen::MatrixXd& columns,
                              const Function& of_stiffness) const;
  /// Does what SolveFor does, and begins with `start`, which has a guess of
  /// each column or is empty.
  Eigen::MatrixXd SolveFrom(const Eigen::MatrixXd& start,
                            const Eigen::MatrixXd& forces);
  void SolveForSupports(const Eigen::VectorXd& scaled_moduli);
  /// If all moduli grow at the same relative rate along this direction, returns
  /// that rate, at which displacements by loads shrink.  Empty otherwise, and
  /// where motions are unknown.
  std::optional<double> GrowthAlong(const Eigen::VectorXd& direction) const;
  /// Returns the values, or zeros where there are none.
  Eigen::MatrixXd OrZeros(const Eigen::MatrixXd& values) const {
    return values.size() > 0
               ? values
               : Eigen::MatrixXd::Zero(load_.rows(), load_.cols());
  }

  /// Null unless VertexSpaceToSolveBy returns one.
  std::unique_ptr<VertexSpace> vertices_;
  std::unique_ptr<NestedStiffness> values_;
  std::vector<std::unique_ptr<SupportedStiffness>> stiffness_;
  const Mesh* mesh_;  ///< The finest one.
  /// The graph of that mesh where its stiffness is not assembled.  As it takes
  /// much memory, it is made when Graph is first called.
  mutable std::optional<NodeGraph> graph_;
  std::vector<std::size_t> stiffness_of_case_;
  Eigen::MatrixXd load_;
  /// HeldDisplacement; empty where all of them are zero.
  Eigen::MatrixXd held_displacement_;
  /// The first load case that is held as this one, at the same displacements.
  std::vector<Eigen::Index> first_held_alike_;
  Eigen::MatrixXd displacement_;
  /// SupportResponse; empty where that is zero, and before the first Solve.
  Eigen::MatrixXd support_response_;
  /// The last sensitivities, with which iterations begin, and their directions,
  /// which are empty where the displacement has changed.
  Eigen::MatrixXd sensitivities_;
  Eigen::MatrixXd directions_;
  Eigen::VectorXd moduli_;  ///< Of the last Solve.
  double scale_ = 1;  ///< The moduli are `scale_` times those of the factor.
  bool has_unknown_motion_;
  double tolerance_;  ///< Of iterations.
  int element_passes_ = 0;
};

/// Returns Equilibrium::Displacement of a scene at these parameters of its
/// materials, in the order of MaterialParameters.  Throws std::invalid_argument
/// as Equilibrium does, and std::runtime_error when the stiffness is singular
/// to working precision.
[[nodiscard]] Eigen::MatrixXd DisplacementsAt(
    const Scene& scene, const Eigen::VectorXd& parameters,
    SolverKind solver = SolverKind::kAutomatic);
/// Returns them for the last of some spaces, which are those that Equilibrium
/// takes.
[[nodiscard]] Eigen::MatrixXd DisplacementsAt(
    const std::vector<const Scene*>& spaces, const Eigen::VectorXd& parameters,
    SolverKind solver = SolverKind::kAutomatic);

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_EQUILIBRIUM_EQUILIBRIUM_H_
