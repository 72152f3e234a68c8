#ifndef ELASTIMATE_ESTIMATORS_REDUCED_MODEL_CERTIFIED_FIT_H_
#define ELASTIMATE_ESTIMATORS_REDUCED_MODEL_CERTIFIED_FIT_H_

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "elastimate/core/scene/observed_displacements.h"
#include "elastimate/core/scene/scene.h"
#include "elastimate/estimators/interface/estimator.h"
#include "elastimate/estimators/reduced_model/reduced_fit.h"
#include "elastimate/estimators/reduced_model/reduced_model.h"

namespace elastimate {

/// The fit of a ReducedModel that is refined until the fit is as good as that
/// of the full model, over the whole range of nu that is searched:
///
/// 1. At the estimate, the displacements are off by less than a tenth of the
///    standard deviation of the noise, all together.
/// 2. At every nu, a lower bound of the norm of the residual of the full model
///    (ReducedFit::BracketResiduals) lies above that of the fit, but for a
///    tenth of a standard deviation, and one part in 2000.
///
/// The noise is the one given, or what the fit leaves, whichever is less.  A
/// bad minimum with a large residual cannot loosen its own certificate: (2)
/// says that the full model leaves as much at every nu.
///
/// Errors of the model come from ReducedModel::ErrorBound in the energy, and
/// from the energy to the observed displacements by ComplianceNorm.
///
/// nu is searched within the bounds, and where there are none from
/// kUsualSmallest to kLargestPoissonRatio, by multigrid, which does not
/// converge next to 1/2, to kUsualLargestOfMultigrid.  Where the residual at an
/// end that no bound has set is near the least, the search goes on beyond it,
/// to kSmallestPoissonRatio or kLargestPoissonRatio.  Where no
/// bound is set below and the least residual exceeds 5 % of the measurement, it
/// goes on to kSmallestOfPoorFits.
class CertifiedFit {
 public:
  static constexpr double kUsualSmallest = -0.7;
  static constexpr double kSmallestOfPoorFits = -0.95;
  static constexpr double kUsualLargestOfMultigrid = 0.495;

  /// Factorises once, and once more where nu may be near 1/2 or near -1.  Both
  /// bounds on nu are given, and alike where nu is known; those on E need not
  /// be.  `on_factorization` is that of EstimatorOptions.  `scene` must outlive
  /// this object.  Preconditions and exceptions: those of ReducedModel.
  CertifiedFit(const Scene& scene, const Bounds& poisson_ratio,
               const Bounds& youngs_modulus, SolverKind solver,
               std::function<void(int)> on_factorization);

  /// Fits, and refines the model.  False when the stiffness is singular at the
  /// first pole.
  bool Run(const ObservedDisplacements& observed);

  /// Has the next Run take rows that are others than those of the last one: of
  /// other nodes, or with other weights.
  void ForgetRows();

  /// Gives back the memory that the model does not need.  The next Run
  /// orthogonalises the rows again, and may set another pole where it would
  /// have enlarged the model.
  void KeepModel();

  const ReducedFit::Point& Best() const { return best_; }
  /// Whether the last fit is certified.
  bool HasConverged() const { return has_converged_; }
  /// Whether the model is off at this point by less than a tenth of the
  /// standard deviation of the noise, all together.
  bool IsAccurateAt(const ReducedFit::Point& point,
                    const ObservedDisplacements& observed) const;
  const ReducedModel& Model() const { return model_; }

 private:
  // Where the model is not yet good enough.
  struct Doubt {
    /// Where to refine, and how much smaller the error has to be there.
    double poisson_ratio;
    double factor;
    /// The middle of the range that is in doubt.
    double middle;
  };

  bool SetPole(double nu);
  /// Enlarges until the relative error bound at nu is below a limit; false when
  /// that would take more vectors than a pole gets.
  bool EnlargeUntil(double nu, double limit);
  bool Improve(const Doubt& doubt);
  /// Moves the ends of the search at which the residual is near the least to
  /// those of the largest range; false where there are none.
  bool SearchFurther(const ObservedDisplacements& observed,
                     const std::vector<ReducedFit::ResidualBracket>& brackets);

  void Fit(const ObservedDisplacements& observed);
  double NoiseOf(const ObservedDisplacements& observed) const;
  /// The error of the observed displacements that always may remain.
  double SmallestError() const;
  double AllowedError(const ObservedDisplacements& observed) const;
  ReducedFit::ModelError ErrorAt(double nu) const;
  std::optional<Doubt> DoubtAtTheEstimate(
      const ObservedDisplacements& observed) const;
  std::optional<Doubt> DoubtElsewhere(
      const ObservedDisplacements& observed,
      const std::vector<ReducedFit::ResidualBracket>& brackets) const;

  std::function<void(int)> on_factorization_;
  ReducedModel model_;
  Bounds largest_range_;
  Bounds searched_;
  Bounds youngs_modulus_;
  bool is_regular_ = true;
  /// ComplianceNorm of the observed components at a pole; zero before.
  double compliance_norm_ = 0;
  double compliance_pole_ = 0;
  /// Fits the model as it was at `fitted_version_`.
  std::unique_ptr<ReducedFit> least_squares_;
  int fitted_version_ = 0;
  ReducedFit::Point best_ = {};
  bool has_converged_ = false;
  int num_poles_ = 0;
  int num_vectors_of_pole_ = 0;
};

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_REDUCED_MODEL_CERTIFIED_FIT_H_
