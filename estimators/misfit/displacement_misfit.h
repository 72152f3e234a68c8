#ifndef ELASTIMATE_ESTIMATORS_MISFIT_DISPLACEMENT_MISFIT_H_
#define ELASTIMATE_ESTIMATORS_MISFIT_DISPLACEMENT_MISFIT_H_

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "elastimate/core/equilibrium/equilibrium.h"
#include "elastimate/core/equilibrium/forward_model.h"
#include "elastimate/core/mechanics/large_strain_forces.h"
#include "elastimate/core/scene/observed_displacements.h"
#include "elastimate/core/scene/scene.h"
#include "elastimate/estimators/interface/estimator.h"
#include "elastimate/estimators/interface/free_parameters.h"
#include "elastimate/estimators/misfit/motion_elimination.h"

namespace elastimate {

/// The standard deviation of a row of displacements without noise, the norm of
/// all of which is 1, beside which resultants are weighed.
inline constexpr double kLeastNoise = 1e-12;

/// The displacements of a scene at variables x of its materials, against the
/// measured ones: model - measurement in the rows of ObservedDisplacements;
/// where motions are unknown, in those of MotionElimination without what
/// these could explain.
class DisplacementMisfit {
 public:
  /// Preconditions are those of Estimator::Run.  `scene` must outlive this.
  DisplacementMisfit(const Scene& scene, const EstimatorOptions& options)
      : DisplacementMisfit(std::vector<const Scene*>{&scene}, options) {}

  /// Takes the last of some spaces of one specimen, from coarse to fine, by
  /// which systems of small strains are solved without its factor
  /// (Equilibrium).  All must outlive this.  `shared` is null or a solver of
  /// the first space, with which memory is shared.
  DisplacementMisfit(const std::vector<const Scene*>& spaces,
                     const EstimatorOptions& options,
                     const StiffnessSolver* shared = nullptr);

  const FreeParameters& Free() const { return free_; }
  const ObservedDisplacements& Observed() const { return observed_; }
  ForwardModel& Model() { return *model_; }
  /// Precondition: the materials have laws of small strains.
  Equilibrium& SmallStrainModel() { return *small_strain_model_; }
  bool HasLargeStrains() const { return small_strain_model_ == nullptr; }
  /// Evaluates the volume of elements in another way from now on.
  /// Precondition: HasLargeStrains.
  void SetDilatation(Dilatation dilatation);
  /// Takes such rotations of the whole specimen from now on.  Precondition: its
  /// rigid motion is free.
  void SetRotations(MotionElimination::Rotations rotations);

  /// Takes these nodes for neighbours in statistics of the residual: those of
  /// the mesh that was measured, whose nodes have none in a finer one.
  /// `graph` must outlive this.
  void SetNeighbours(const NodeGraph& graph) { neighbours_ = &graph; }
  const NodeGraph& Neighbours() const {
    return neighbours_ != nullptr ? *neighbours_ : model_->Graph();
  }

  /// Takes what a scene that differs in its measured displacements alone has
  /// measured; with other rows, at other nodes.  Precondition of both: no
  /// unknown motions.
  void Remeasure(const Scene& scene);
  void ObserveAnew(const Scene& scene);

  /// Solves in place of the model: u and, side by side for each load case,
  /// du/dx at x; false where it cannot.  Empty takes it back.
  using Solution = std::function<bool(const Eigen::VectorXd& x,
                                      Eigen::MatrixXd* displacement,
                                      Eigen::MatrixXd* sensitivities)>;
  void SetSolution(Solution solution) { solution_ = std::move(solution); }

  Eigen::Index NumRows() const;
  /// Returns the variance of a row of displacements: as given, else by the
  /// square sum that a fit leaves of them.
  double Variance(double square_sum) const;
  /// The numbers of unknown motions, which are fitted as the variables are, and
  /// of measured resultants.
  Eigen::Index NumAmounts() const;
  Eigen::Index NumResultants() const;

  /// Sets the standard deviation of a row, which weighs resultants.
  void SetNoise(double standard_deviation);
  /// Zero without resultants.
  double Noise() const { return NumResultants() > 0 ? motion_->Noise() : 0; }

  /// How a loss weighs the rows r of displacements: by w = psi(r) / r.
  struct Weights {
    /// The roots of w, which multiply the rows and their derivatives; empty
    /// without a loss.
    Eigen::VectorXd factors;
    double mean_slope = 1;  ///< The mean of d psi / d r.
  };
  /// Precondition: no unknown motions.
  void SetWeights(const Weights& weights) { weights_ = weights; }
  const Weights& RowWeights() const { return weights_; }

  /// A factorisation, and a solve for each load case and variable; times the
  /// iterations of MotionElimination where motions are unknown.  False when the
  /// stiffness is singular at x.
  bool Evaluate(const Eigen::VectorXd& x, Eigen::VectorXd* residual,
                Eigen::MatrixXd* jacobian);

  /// Solves the model at x, a factorisation.  False when the stiffness is
  /// singular there.
  bool SolveAt(const Eigen::VectorXd& x);
  /// Has the model itself at x: a factorisation, unless it is there.  False as
  /// above.
  bool Factorize(const Eigen::VectorXd& x);
  /// Takes u and du/dx, as Equilibrium has them, for those at x, of which an
  /// Evaluate there costs nothing.  Precondition: no unknown motions.
  void Place(const Eigen::VectorXd& x, Eigen::MatrixXd displacement,
             Eigen::MatrixXd sensitivities);

  /// Gives back the memory of the last solution, but for what was placed.  The
  /// factor stays.  Precondition: small strains.
  void ForgetSolution();

  /// Gives back the memory of what was placed.
  void ForgetPlaced();

  /// Returns u and, side by side for each load case, du/dx at x as Place takes
  /// them, and solves only where it has to.  False when the stiffness is
  /// singular there.
  bool SolutionAt(const Eigen::VectorXd& x, Eigen::MatrixXd* displacement,
                  Eigen::MatrixXd* sensitivities);

  /// u where the last Evaluate was, num_dofs x num_load_cases: that of the
  /// model; with a motion of all that is linear (MotionElimination); and as
  /// cameras see it, where there are some.
  const Eigen::MatrixXd& Displacement() const {
    return placed_ ? placed_->displacement : model_->Displacement();
  }
  Eigen::MatrixXd FittedDisplacement() const {
    return motion_ ? motion_->FittedDisplacement() : Displacement();
  }
  std::vector<Camera> Cameras() const {
    return motion_ ? motion_->Cameras() : std::vector<Camera>();
  }

  /// A factor on the displacements, and what it leaves.
  struct ScaleFit {
    double compliance;  ///< 1 / E, or another unit of the moduli.
    double cost;
  };
  /// What explains displacements or resultants best where the moduli are 1, in
  /// the sum of squares or, with a loss, that of absolute deviations; empty
  /// when they oppose the loads.  Of resultants alone the cost is zero.  For
  /// starts of searches: iterations leave an error of 1e-4 (SolveRoughly).
  /// Precondition: small strains.
  std::optional<ScaleFit> FitScale(const Eigen::VectorXd& unit_moduli,
                                   Loss loss);
  /// The factor on all moduli by which the forces of supports, which nothing
  /// but their motion causes, explain the resultants best; empty where it is
  /// not positive.  The model is where the last Evaluate was.
  std::optional<double> FitStiffness();

 private:
  struct Placed {
    Eigen::MatrixXd displacement;
    Eigen::MatrixXd sensitivities;
  };

  bool IsAt(const Eigen::VectorXd& x) const {
    return x_.size() == x.size() && x_ == x;
  }
  /// Enters the residual of new measurements.
  void CompareAnew();
  bool MoveTo(const Eigen::VectorXd& x);
  bool MoveModelTo(const Eigen::VectorXd& x);
  Eigen::MatrixXd Sensitivities(const Eigen::VectorXd& x);
  Eigen::VectorXd WithoutMotion(const Eigen::MatrixXd& displacements);

  FreeParameters free_;
  std::unique_ptr<ForwardModel> model_;
  Equilibrium* small_strain_model_;  ///< `model_`, or null.
  ObservedDisplacements observed_;
  std::optional<MotionElimination> motion_;
  std::function<void(int)> on_factorization_;
  int num_factorizations_ = 0;
  Eigen::VectorXd x_;  ///< Where the model is; empty where it is nowhere.
  std::optional<Placed> placed_;  ///< In place of the model.
  Solution solution_;
  Eigen::VectorXd residual_;
  Weights weights_;
  const NodeGraph* neighbours_ = nullptr;
};

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_MISFIT_DISPLACEMENT_MISFIT_H_
