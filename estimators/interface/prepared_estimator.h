#ifndef ELASTIMATE_ESTIMATORS_INTERFACE_PREPARED_ESTIMATOR_H_
#define ELASTIMATE_ESTIMATORS_INTERFACE_PREPARED_ESTIMATOR_H_

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "elastimate/core/scene/scene.h"
#include "elastimate/estimators/interface/estimate.h"

namespace elastimate {

class Estimator;
struct EstimatorOptions;

/// What an estimator keeps of a scene from one measurement to the next.
class Preparation {
 public:
  Preparation() = default;
  virtual ~Preparation() = default;
  Preparation(const Preparation&) = delete;
  Preparation& operator=(const Preparation&) = delete;

  /// The estimate from a valid measurement of the scene that it was prepared
  /// for: `scene` is that very object, with other displacements.
  virtual Estimate Run(const Scene& scene) = 0;
  /// Whether Run takes other load cases altogether: what it keeps is of the
  /// specimen alone, if it keeps anything.
  virtual bool TakesOtherLoadCases() const { return false; }
  /// Has the next Run start as the first one did.  Does nothing where no
  /// estimate starts from an earlier one.
  virtual void ForgetStart() {}
};

/// An estimator for a specimen that is measured again and again under the same
/// loads and supports: what does not depend on the measurement is done once.
///
///   const auto estimator = MakeEstimator("reduced-fe");
///   PreparedEstimator prepared = estimator->Prepare(scene, {});
///   for (const Eigen::MatrixXd& displacement : frames) {
///     const Estimate estimate = prepared.Run({displacement});
///   }
class PreparedEstimator {
 public:
  /// Does what Estimator::Prepare does, which says more.
  PreparedEstimator(const Estimator& estimator, const Scene& scene,
                    const EstimatorOptions& options);
  PreparedEstimator(const Estimator&&, const Scene&,
                    const EstimatorOptions&) = delete;
  ~PreparedEstimator();
  PreparedEstimator(PreparedEstimator&&) noexcept;
  PreparedEstimator& operator=(PreparedEstimator&&) noexcept;

  /// The estimate from one measured displacement for each load case,
  /// dimension x num_nodes each [length], or of the points of a load case that
  /// was prepared with some, not a number where it was not then; `work`, stages
  /// and seconds are those of this call.  Throws std::invalid_argument, and
  /// leaves this object as it was, when a shape is wrong, or for displacements
  /// that Estimator::Run would refuse.  Not to be called from two threads at
  /// once.
  [[nodiscard]] Estimate Run(const std::vector<Eigen::MatrixXd>& displacements);

  /// The estimate from load cases that may differ in all that there is of
  /// them: loads, and which points were measured.  Where only displacements
  /// differ from those before, this is Run; what of a preparation does not hold
  /// any more is done anew.  `iterative-fe` (and `auto`, of unknown motions)
  /// starts where the last usable estimate ended.  Throws std::invalid_argument
  /// as Estimator::Run does, and takes other load cases all the same.
  [[nodiscard]] Estimate RunLoadCases(const std::vector<LoadCase>& load_cases);
  /// Has the next estimate start as the first one did.  The rest of what is
  /// prepared stays.
  void ForgetStart();

 private:
  struct State;
  // The estimate of the scene as it is now.
  Estimate RunHere();

  std::unique_ptr<State> state_;
};

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_INTERFACE_PREPARED_ESTIMATOR_H_
