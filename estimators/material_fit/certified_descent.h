#ifndef ELASTIMATE_ESTIMATORS_MATERIAL_FIT_CERTIFIED_DESCENT_H_
#define ELASTIMATE_ESTIMATORS_MATERIAL_FIT_CERTIFIED_DESCENT_H_

#include <optional>
#include <string>

#include "elastimate/core/scene/scene.h"
#include "elastimate/estimators/interface/estimator.h"
#include "elastimate/estimators/misfit/displacement_misfit.h"
#include "elastimate/estimators/reduced_model/certified_fit.h"
#include "elastimate/estimators/statistics/bounded_variables.h"

namespace elastimate {

/// The global minimum of the misfit of one isotropic material: the minimum over
/// E is in closed form, and that over all of the range of nu is certified by a
/// reduced model (CertifiedFit).  It needs no start.
///
/// The model stays behind the misfit (DisplacementMisfit::SetSolution): where
/// it is accurate, the misfit and its derivatives cost O(num_nodes m) for m
/// basis vectors, and no factorisation.  A further measurement of the same
/// nodes costs that as well.
class CertifiedDescent {
 public:
  /// Whether there is a certificate: one isotropic material, supports that are
  /// given and the same in all load cases.
  static bool Takes(const Scene& scene);

  /// `misfit` is that of the scene, and outlives this object.  `scene` outlives
  /// it as well.  Cost: that of CertifiedFit.
  CertifiedDescent(const Scene& scene, const EstimatorOptions& options,
                   DisplacementMisfit& misfit);
  ~CertifiedDescent();
  CertifiedDescent(const CertifiedDescent&) = delete;
  CertifiedDescent& operator=(const CertifiedDescent&) = delete;

  /// The minimum for what the misfit observes now.  Empty where displacements
  /// oppose the loads; not done where the stiffness is singular, or where
  /// rounding leaves no certificate (End::kNotCertified).
  std::optional<BoundedMinimum> Minimize();

  /// Has the next minimum take other rows: CertifiedFit::ForgetRows.
  void ForgetRows() { fit_.ForgetRows(); }

  /// Gives back memory: CertifiedFit::KeepModel.
  void KeepModel() { fit_.KeepModel(); }

  const StiffnessSolver& Solver() const { return fit_.Model().Solver(); }
  const NodeGraph& Graph() const { return Solver().Graph(); }
  Work WorkDone() const { return fit_.Model().WorkDone(); }
  const std::string& SolverNotice() const { return fit_.Model().Notice(); }

 private:
  bool Solve(const Eigen::VectorXd& x, Eigen::MatrixXd* displacement,
             Eigen::MatrixXd* sensitivities) const;

  const Scene& scene_;
  DisplacementMisfit& misfit_;
  CertifiedFit fit_;
};

}  // namespace elastimate

#endif  // ELASTIMATE_ESTIMATORS_MATERIAL_FIT_CERTIFIED_DESCENT_H_
