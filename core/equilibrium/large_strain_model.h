#ifndef ELASTIMATE_CORE_EQUILIBRIUM_LARGE_STRAIN_MODEL_H_
#define ELASTIMATE_CORE_EQUILIBRIUM_LARGE_STRAIN_MODEL_H_

#include <Eigen/Core>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "elastimate/core/equilibrium/forward_model.h"
#include "elastimate/core/equilibrium/large_strain_equilibrium.h"
#include "elastimate/core/mesh/node_graph.h"

namespace elastimate {

/// The forward model at large strains.  It solves all load cases by
/// LargeStrainEquilibrium, and keeps the sensitivities at each solution.
///
/// Solve begins at u + S (theta - theta_last), which the sensitivities S of the
/// last successful Solve predict.  If theta has changed little, two or three
/// factorisations lead from there to the equilibrium.
///
/// Only until a Solve has been successful is the load divided into steps.  If a
/// later Solve finds no equilibrium from its start nor from rest at the whole
/// load, it returns false, and the search for moduli takes a shorter step,
/// which costs less than steps of the load.
class LargeStrainModel : public ForwardModel {
 public:
  /// Preconditions and exceptions are those of LargeStrainEquilibrium.
  explicit LargeStrainModel(const Scene& scene);
  explicit LargeStrainModel(const Scene&&) = delete;

  /// Changes how elements evaluate their volume, from the next Solve on.
  void SetDilatation(Dilatation dilatation);

  /// Takes about five factorisations for each load case in the first call, and
  /// about three in later ones.
  [[nodiscard]] bool Solve(const Eigen::VectorXd& moduli) override;
  void BeginWith(const Eigen::MatrixXd& displacement) override;
  const std::string& WhyNotSolved() const override { return why_not_solved_; }

  const Eigen::MatrixXd& Displacement() const override { return displacement_; }
  const Eigen::MatrixXd& Load() const override { return equilibrium_.Load(); }

  /// Costs nothing: Solve has solved for all moduli.
  Eigen::MatrixXd Sensitivities(const Eigen::MatrixXd& directions) override;
  // Another factorisation for each load case whose factor is not kept.
  Eigen::MatrixXd SolveFor(const Eigen::MatrixXd& forces) override;
  Eigen::MatrixXd ForceColumns(
      const Eigen::VectorXd& displacement) const override {
    return equilibrium_.Forces().Columns(moduli_, displacement);
  }

  Eigen::MatrixXd Extend(const Eigen::MatrixXd& held) override;
  Eigen::MatrixXd ExtendTransposed(const Eigen::MatrixXd& values) override;
  Eigen::MatrixXd ExtendInCase(Eigen::Index k,
                               const Eigen::MatrixXd& held) override;
  /// Runs Newton's method, whose first iteration is what Extend predicts.  If
  /// that fails, the supports go there in up to 16 shorter steps.
  [[nodiscard]] bool MoveSupports(const Eigen::MatrixXd& held) override;
  /// Begins as Solve does.  The supports move from where they were in the last
  /// equilibrium.
  [[nodiscard]] bool SolveMoved(const Eigen::VectorXd& moduli,
                                const Eigen::MatrixXd& held) override;
  bool IsLinear() const override { return false; }

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

  const MaterialParameters& Parameters() const override {
    return equilibrium_.Forces().Parameters();
  }
  const NodeGraph& Graph() const override { return equilibrium_.Graph(); }
  Work WorkDone() const override { return equilibrium_.WorkDone(); }
  const std::string& Notice() const override { return no_notice_; }

 private:
  /// The last equilibrium of a load case that was found.
  struct CaseState {
    Eigen::VectorXd moduli;  ///< Empty if none was found.
    Eigen::VectorXd displacement;
    Eigen::MatrixXd sensitivities;  ///< num_dofs x num_moduli.
  };

  /// Whether nothing is known to be near the equilibrium that is searched for.
  bool IsFirstSolve() const {
    return begin_ || states_.back().moduli.size() == 0;
  }
  Eigen::Index NumLoadCases() const { return Load().cols(); }
  /// Finds the equilibrium of load case `k`, beginning at this start.  If the
  /// start is empty or leads to none, the search follows the moduli from those
  /// of the last equilibrium, and then begins again at rest.
  bool SolveInCase(Eigen::Index k, const Eigen::VectorXd& start);
  /// Changes the moduli in steps from those of the last equilibrium of load
  /// case `k` to the present ones.  A step that fails is halved, once.
  LargeStrainState FollowModuli(Eigen::Index k);
  bool MoveSupportsOfCase(Eigen::Index k, const Eigen::VectorXd& held);
  /// Returns the solver of load case `k`, with the factor of its tangent.
  StiffnessSolver& TangentSolver(Eigen::Index k);
  Eigen::MatrixXd TangentProducts(Eigen::Index k,
                                  const Eigen::MatrixXd& columns) const;
  /// Returns `values` with zeros in the rows that load case `k` does not hold.
  Eigen::MatrixXd OfHeldInCase(Eigen::Index k, Eigen::MatrixXd values) const;
  /// Applies of_case(k, columns of k) to the columns of each load case.
  template <class Function>
  Eigen::MatrixXd ByCase(const Eigen::MatrixXd& columns,
                         const Function& of_case) const;

  const Scene& scene_;
  LargeStrainEquilibrium equilibrium_;
  Eigen::MatrixXd given_;  ///< The displacement of supports in the scene.
  Eigen::VectorXd moduli_;
  std::vector<CaseState> states_;
  /// Where the next Solve begins, in place of a prediction.
  std::optional<Eigen::MatrixXd> begin_;
  Eigen::MatrixXd displacement_;
  std::map<const StiffnessSolver*, Eigen::Index> case_of_factor_;
  std::string why_not_solved_;
  std::string no_notice_;
};

}  // namespace elastimate

#endif  // ELASTIMATE_CORE_EQUILIBRIUM_LARGE_STRAIN_MODEL_H_
