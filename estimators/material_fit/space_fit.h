#ifndef ELASTIMATE_ESTIMATORS_MATERIAL_FIT_SPACE_FIT_H_
#define ELASTIMATE_ESTIMATORS_MATERIAL_FIT_SPACE_FIT_H_

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "elastimate/core/scene/camera.h"
#include "elastimate/core/scene/scene.h"
#include "elastimate/estimators/interface/estimate.h"
#include "elastimate/estimators/interface/estimator.h"
#include "elastimate/estimators/material_fit/certified_descent.h"
#include "elastimate/estimators/misfit/displacement_misfit.h"
#include "elastimate/estimators/misfit/mesh_error.h"
#include "elastimate/estimators/misfit/minimum_statistics.h"
#include "elastimate/estimators/statistics/bounded_variables.h"

namespace elastimate {

/// How a fit finds its minimum: with a factorisation at each step
/// (BestMinimum), or by reduced models: where it has no start and there is a
/// certificate, the global minimum (CertifiedDescent), else that which it comes
/// to from its start (ReducedMinimum).
enum class Descent { kFull, kReduced };

/// A fit, and where it is.
struct MaterialFit {
  Estimate estimate;
  /// Empty where there is no fit.
  std::optional<BoundedMinimum> minimum;
  MinimumErrors errors;
  /// The fitted displacement, num_dofs x num_load_cases, and the cameras that
  /// see it, as DisplacementMisfit has them; empty where there is no fit.
  Eigen::MatrixXd displacement;
  std::vector<Camera> cameras;
  /// Whether the data hardly prefer an axis that was found to another one.
  bool has_rival_axis = false;
  /// Whether values far from the minimum explain the data as well
  /// (FindShearModulus).
  bool is_undetermined = false;

  std::optional<Eigen::VectorXd> Variables() const {
    return minimum ? std::optional<Eigen::VectorXd>(minimum->variables)
                   : std::nullopt;
  }
};

/// A scene with its model against the measurement, and the fit of that.
class SpaceFit {
 public:
  /// Preconditions are those of Estimator::Run; the supports hold the specimen.
  /// `coarser` are spaces of the same specimen, from coarse to fine, by which
  /// systems are solved without a factor of this one; none where that is
  /// faster.  They and `options` must outlive this object.  `shared` is null or
  /// a solver of the coarsest space, with which memory is shared.
  SpaceFit(Scene scene, const EstimatorOptions& options,
           const std::vector<const Scene*>& coarser = {},
           const StiffnessSolver* shared = nullptr);
  SpaceFit(const SpaceFit&) = delete;
  SpaceFit& operator=(const SpaceFit&) = delete;

  /// Finds the minimum from `start` on, or from where FitMaterials says, with
  /// its parameters, its displacement and its residual.  Without a minimum, the
  /// estimate says that displacements oppose the loads.
  void Minimize(Descent descent, const std::optional<Eigen::VectorXd>& start);
  /// Descends from starts over the whole range of Poisson's ratio, and keeps
  /// the best minimum.  Preconditions: a minimum; one isotropic material of
  /// small strains.  Costs 7 solutions, and a descent for each other minimum
  /// that these show.
  void MinimizeAcrossRange(Descent descent);

  /// Descends also as without a start, and keeps the better minimum.
  /// Precondition: a minimum.
  void MinimizeAlsoWithoutStart(Descent descent);

  /// Describes the minimum, with the mesh error that `change` from coarser
  /// elements tells of; null where the elements are taken as exact.  `curved`
  /// is this fit or a coarser one, whose curvature adds to the errors, or null
  /// (DescribeMinimum).  Precondition: there is a minimum.
  void Describe(const SpaceChange* change, SpaceFit* curved);

  /// What the elements of this fit changed from those of a coarser one of the
  /// same measurement: one solution of the coarse model.  Empty where one of
  /// both models cannot be solved at either minimum.  Precondition: both have a
  /// minimum.
  std::optional<SpaceChange> ChangeFrom(SpaceFit& coarse);

  /// Returns how far the minimum moves if these components are held as well.
  /// Costs one solution at the minimum, which is added to `work`, and a step of
  /// the model linearised there.  Empty if a fit is needed instead: because
  /// holding them explains the displacements better, because the step is long
  /// or meets a bound, or because iterations do not converge.  Empty also at
  /// large strains, if systems are solved by factors, and if supports differ
  /// between load cases.  Precondition: there is a minimum.
  std::optional<Eigen::VectorXd> ChangeByHolding(
      const std::vector<HeldComponent>& components, Work& work);

  /// Takes the measurement of another scene of the same specimen, at the same
  /// nodes or at others, less some outliers.  Minimize starts anew then.
  /// Preconditions: no unknown motions; other rows, if there are outliers.
  enum class Rows { kSame, kOther };
  void Measure(const Scene& scene, Rows rows,
               const std::vector<Outlier>& left_out = {});

  /// Gives back the memory that only another Minimize needs, which then takes
  /// longer.
  void KeepMinimum();
  /// Gives back all that a minimum was found by, but for the solver.
  void ForgetModel();

  /// The square sum of what is left of the displacements at the minimum.
  double SquareSum() const { return square_sum_; }
  Eigen::Index NumRows() const { return misfit_.Observed().Size(); }
  const Scene& OwnScene() const { return scene_; }
  /// The solver of the coarsest space; null where there is none yet, or where
  /// strains are large.
  const StiffnessSolver* SolverOfCoarsest();
  DisplacementMisfit& Misfit() { return misfit_; }
  MaterialFit& Fit() { return fit_; }
  const MaterialFit& Fit() const { return fit_; }

 private:
  void MinimizeAlsoFrom(
      Descent descent,
      const std::vector<std::optional<Eigen::VectorXd>>& starts);
  /// Enters what is there at the minimum before it is described.
  void EnterMinimum();
  /// Moves to the minimum with the loss of the options, by reweighting.
  void Reweigh();
  std::optional<BoundedMinimum> FindMinimum(
      Descent descent, const std::optional<Eigen::VectorXd>& start);
  std::optional<BoundedMinimum> FindOverRotations(
      Descent descent, const std::optional<Eigen::VectorXd>& start);
  /// Notes the variables of the other one of two models beside the better one,
  /// where the data do not decide between them.
  BoundedMinimum WithOtherModel(BoundedMinimum best,
                                const BoundedMinimum& other);
  std::optional<BoundedMinimum> FindOverAxes(Descent descent);
  std::optional<BoundedMinimum> FindAtLargeStrains(
      const std::optional<Eigen::VectorXd>& start);
  /// Enters what the elements change in the rows of a coarser fit at these
  /// variables; false where one of both has no solution.
  bool CompareRows(SpaceFit& coarse, const Eigen::VectorXd& variables,
                   Eigen::VectorXd& change);
  /// Returns the displacement at the minimum where these components are held as
  /// well; empty where iterations do not converge.
  std::optional<Eigen::MatrixXd> DisplacementWithHeld(
      const std::vector<HeldComponent>& components, Work& work);
  Work WorkDone();
  const std::string& SolverNotice();

  const EstimatorOptions& options_;
  Scene scene_;
  DisplacementMisfit misfit_;
  /// Empty before it is asked for, and where there is no certificate.
  std::optional<CertifiedDescent> certified_;
  MaterialFit fit_;
  double square_sum_ = 0;
};

/// The fit of a scene with its elements taken as exact.
MaterialFit FitSpace(const Scene& scene, const EstimatorOptions& options,
                     Descent descent,
                     const std::optional<Eigen::VectorXd>& start);

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_MATERIAL_FIT_SPACE_FIT_H_
