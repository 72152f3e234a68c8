#ifndef ELASTIMATE_ESTIMATORS_MISFIT_FINER_ELEMENTS_H_
#define ELASTIMATE_ESTIMATORS_MISFIT_FINER_ELEMENTS_H_

#include <Eigen/Core>
#include <memory>
#include <optional>

#include "elastimate/core/scene/scene.h"
#include "elastimate/estimators/interface/estimate.h"
#include "elastimate/estimators/interface/estimator.h"
#include "elastimate/estimators/misfit/displacement_misfit.h"
#include "elastimate/estimators/statistics/element_errors.h"

namespace elastimate {

/// A scene in finer elements (FinerScene).
class FinerElements {
 public:
  FinerElements(const Scene& scene, const EstimatorOptions& options);
  /// Null for a mesh of more than 30 000 simplices, or 120 000 in the plane,
  /// where each costs less.
  static std::unique_ptr<FinerElements> Of(const Scene& scene,
                                           const EstimatorOptions& options);

  /// What they change in the rows of the fit of the scene at these variables
  /// (DisplacementMisfit::ChangeTo); empty where there is none.
  std::optional<RowChange> Change(const Eigen::VectorXd& variables,
                                  DisplacementMisfit& misfit) {
    return misfit.ChangeTo(variables, misfit_);
  }

  /// Model - measurement of these elements at some variables, in the rows of
  /// the fit; empty where the stiffness is singular, and where resultants are
  /// weighed in the rows.
  std::optional<Eigen::VectorXd> Rows(const Eigen::VectorXd& variables);

  /// u of these elements at some variables, of their nodes, num_dofs x
  /// num_load_cases; empty where the stiffness is singular.
  std::optional<Eigen::MatrixXd> Displacement(const Eigen::VectorXd& variables);

  /// From the displacement of the fit, num_dofs x num_load_cases, that of the
  /// specimen, which has this share of the difference to these elements at some
  /// variables.
  Eigen::MatrixXd DisplacementOfSpecimen(const Eigen::VectorXd& variables,
                                         double share,
                                         const Eigen::MatrixXd& displacement);

  Work WorkDone() { return misfit_.Model().WorkDone(); }

 private:
  Scene scene_;
  DisplacementMisfit misfit_;
};

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_MISFIT_FINER_ELEMENTS_H_
